# SPDX-License-Identifier: Apache-2.0
"""What sensors read is drawn where it is published, and a recording without them has no tab of theirs."""

from types import SimpleNamespace as NS

import made_up
import numpy as np
import pytest
from eel_common.topics import SENSORS
from eel_viz.recording.dispatcher import READERS, Dispatcher
from eel_viz.recording.reading import read
from eel_viz.recording.recording_file import FileDestination
from eel_viz.recording.recordings import Recordings
from eel_viz.settings import Settings

from eel_viz import entities

STAMPS = range(0, 500_000_000, 100_000_000)  # ns


def xyz(*values):
    return NS(**dict(zip("xyz", values, strict=True)))


def messages_at(stamp):
    """A message of each sensor."""
    header, time = NS(stamp=NS(sec=0, nanosec=stamp)), 1e-9 * stamp
    pose = NS(pose=NS(pose=NS(position=xyz(0.0, 0.0, -time))))
    return {
        "imu": NS(header=header, linear_acceleration=xyz(time, 0.0, 9.8), angular_velocity=xyz(0.0, time, 0.0)),
        "pressure": NS(header=header, fluid_pressure=1e5 + time),
        "depth": NS(header=header, **vars(pose)),
        "velocity": NS(header=header, twist=NS(twist=NS(linear=xyz(0.3, time, 0.0)))),
    }


def recorded(path, topics, faulty=False):
    settings, warned = Settings(recording=str(path)), []
    destination = FileDestination(settings, print, warned.append)
    recordings = Recordings([destination], "eel", warned.append)
    dispatcher = Dispatcher(recordings, namespace="", log_warning=warned.append)
    dispatcher.dispatch("body", NS(**made_up.body()))
    for stamp in STAMPS:
        for topic in topics:
            message = messages_at(stamp)[topic]
            if faulty:
                message.linear_acceleration.x = np.nan
            dispatcher.dispatch(topic, message)
    dispatcher.finish()
    tabs = [each.name for each in destination.blueprint().root_container.contents]
    recordings.close()
    return tabs, warned


def test_all_sensors_are_read():
    assert set(SENSORS) <= READERS.keys()


def test_readings_are_drawn_as_they_are(tmp_path):
    tabs, warned = recorded(tmp_path / "run.rrd", SENSORS)
    assert "sensors" in tabs and not warned
    time = 1e-9 * np.array(STAMPS)
    none = np.zeros(5)
    for entity, columns in (
        (entities.FORCE_READ, (time, none, none + 9.8)),
        (entities.TURNING_READ, (none, time, none)),
        (entities.PRESSURE_READ, (1e5 + time,)),
        (entities.DEPTH_READ, (time,)),
        (entities.VELOCITY_READ, (none + 0.3, time, none)),
    ):
        np.testing.assert_array_equal(read(tmp_path / "run.rrd", entity)["scalars"], np.transpose(columns))


@pytest.mark.parametrize("topics", [(), ("depth",)])
def test_the_tab_is_there_where_a_sensor_is(tmp_path, topics):
    tabs, _ = recorded(tmp_path / "run.rrd", topics)
    assert ("sensors" in tabs) == bool(topics)


def test_a_reading_that_is_no_number_is_left_out_with_a_line(tmp_path):
    _, warned = recorded(tmp_path / "run.rrd", ("imu",), faulty=True)
    assert [line for line in warned if line.startswith("imu: linear_acceleration ")] and len(warned) == 1
