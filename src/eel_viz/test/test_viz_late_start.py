# SPDX-License-Identifier: Apache-2.0
"""A visualiser that comes late: body and law are there at once, and so is the present."""

import time

import made_up
import numpy as np
import pytest
from eel_viz.recording.reading import read
from fake_swimmer import LATCHED, TOPICS, arrived, body_message, messages

from eel_msgs.msg import BodyGeometry, CurvatureLaw
from eel_viz import entities

BEGIN, STEP = 100 * 10**9, 2 * 10**7  # ns


@pytest.mark.fault("nodes", "a visualiser that starts late", "body, law and the present are there at once")
def test_who_comes_late_sees_the_present_at_once(start, network, tmp_path):
    for kind, topic, message in (
        (BodyGeometry, "body", body_message(21)),
        (CurvatureLaw, "curvature_law", CurvatureLaw(name="of long ago")),
    ):
        network.create_publisher(kind, topic, LATCHED).publish(message)
    publishers = {topic: network.create_publisher(kind, topic, 1000) for topic, kind in TOPICS.items()}
    swimmer, sent, arrival, node = made_up.Swimmer(21), 0, None, None
    deadline = time.monotonic() + 90
    while arrival is None or sent < arrival + 60:
        if sent == 20:
            node = start("visualiser", "--ros-args", "-p", "sink:=[save]", "-p", f"recording:={tmp_path / 'late.rrd'}")
        if arrival is None and min(publisher.get_subscription_count() for publisher in publishers.values()):
            arrival = sent
        for topic, message in messages(swimmer, BEGIN + sent * STEP).items():
            publishers[topic].publish(message)
        sent += 1
        time.sleep(0.02)
        assert time.monotonic() < deadline, node.output()
    arrived(*publishers.values())
    assert node.interrupt() == 0, node.output()
    stamps = read(tmp_path / "late.rrd", entities.BACKBONE).stamps
    assert BEGIN + 20 * STEP < stamps[0] <= BEGIN + (arrival + 10) * STEP  # not from the start, and soon
    assert len(np.unique(np.diff(stamps))) == 1  # without a gap from there on
    skin = read(tmp_path / "late.rrd", entities.SKIN)
    assert skin.stamps_of["vertex_positions"][0] <= stamps[0] + 10 * STEP
    assert read(tmp_path / "late.rrd", entities.BODY_NUMBERS, static=True)["mass"].item() == body_message(21).mass
    assert read(tmp_path / "late.rrd", entities.LOG)["text"][0][0] == "law 'of long ago' published"
    assert "no body has come" not in node.output()
