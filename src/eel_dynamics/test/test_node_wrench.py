# SPDX-License-Identifier: Apache-2.0
"""Wrenches from outside over DDS: the topic external_wrench, the parameters wrenches and wrench_frames."""

import math

import numpy as np
import pytest
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.model.wrenches.text import wrenches_from_text
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import WrenchStamped
from rclpy.duration import Duration
from swim_client import LIMIT, LOSSLESS, nanoseconds
from tf2_msgs.msg import TFMessage

from eel_dynamics import ExternalWrench, Simulation
from eel_gaits import straight

FRAMES = ("-p", "wrench_frames:=[thruster 0.51, tether 1.0]")
FAST = ("--ros-args", "-p", "real_time_factor:=0", "-p", "rate:=50", "-p", "estimate_error:=false")
SHORT = ("-p", "duration:=0.8", "-p", "subscriber_timeout:=0.3")  # once the last wrench has come
TOW = "section station=0 force=0.2,0,0 + world station=1 force=0,0,0.1;0,0,0.3 time=0.2,0.3"


def wrench(time, frame="", force=(0.0, 0.0, 0.0), torque=(0.0, 0.0, 0.0)):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * 1e9), 1_000_000_000)
    for vector, row in ((message.wrench.force, force), (message.wrench.torque, torque)):
        vector.x, vector.y, vector.z = map(float, row)
    return message


def publisher(swim):
    made = swim.node.create_publisher(WrenchStamped, "external_wrench", LOSSLESS)
    swim.until(made.get_subscription_count, "the node's subscription")
    return made


def by_stamp(messages):
    return {nanoseconds(message.header.stamp): message for message in messages}


@pytest.mark.parametrize("robot", [None, "eight_servos"])
def test_wrenches_act_at_their_stamps_as_in_the_library(start, client, robot):
    """Between two samples; each holds until the next one for its frame. The frames are where the sections are."""
    more = () if robot is None else ("-p", f"robot:={robot}")
    swim = client(topics=("head_pose", "energy", "internal_wrench"))
    swim.listen("/tf", TFMessage)
    node = start("dynamics", *FAST, *FRAMES, *SHORT, "-p", f"wrenches:={TOW}", *more)
    sender = publisher(swim)
    push, pull = ((0.1, 0.3, 0.2), (0.0, 0.01, 0.02)), ((-0.2, 0.0, 0.1), (0.0, 0.0, 0.0))
    sent = (
        (0.11, "thruster", 0.51, push),
        (0.25, "tether", 1.0, pull),
        (0.25, "", 0.0, push),
        (0.5, "thruster", 0.51, ()),
    )
    for time, frame, _, given in sent:
        sender.publish(wrench(time, frame, *given))
    assert sender.wait_for_all_acked(Duration(seconds=LIMIT))
    swim.laws.publish(law_to_message(straight()))
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output(), node.output()
    swim.until_time(0.8, "head_pose", "energy", "internal_wrench")
    declared = [ExternalWrench(station) for station in (0.51, 1.0)]
    wrenches, places = [*wrenches_from_text(TOW), *declared], [0.51, 1.0]  # the frames are seen as sensors are
    library = Simulation(law=straight(), robot=robot_of(robot or ""), sensors=places, wrenches=wrenches)
    received = [by_stamp(swim.received[topic]) for topic in ("head_pose", "energy", "internal_wrench")]
    waiting = [*sent]
    for stamp in sorted(received[0]):
        while waiting and round(waiting[0][0] * 1e9) < stamp:
            time, _, station, given = waiting.pop(0)
            library.advance(time)
            library.apply_wrench(station, *given)
        library.advance(stamp / 1e9)
        pose, energy, inner = (each[stamp] for each in received)
        seen = library.observe()
        close = {"abs": 1e-11 if robot else 0.0}  # a robot's step ends once for two wrenches of one time
        assert [getattr(pose.pose.position, axis) for axis in "xyz"] == pytest.approx(seen.position, **close)
        assert energy.external_power == pytest.approx(seen.energy.external_power, **close)
        assert energy.external_work == pytest.approx(seen.energy.external_work, **close)
        assert inner.force_1 == pytest.approx(seen.force[:, 0], abs=10.0 * close["abs"])
    assert not waiting and abs(energy.external_work) > 1e-3
    frames = {each.child_frame_id: each.transform for each in swim.received["/tf"][-1].transforms}
    assert frames.keys() == {"base_link", "thruster", "tether"}
    there = frames["tether"].translation
    assert [there.x, there.y, there.z] == pytest.approx(seen.backbone[-1], abs=1e-12)
    dense = Simulation(law=straight(), stations=[0.51])
    dense.advance(0.8)
    alone = dense.observe()
    place, turn = frames["thruster"].translation, frames["thruster"].rotation
    assert [place.x, place.y, place.z] == pytest.approx(seen.sensor_position[0], abs=1e-12)
    assert [turn.x, turn.y, turn.z, turn.w] == pytest.approx(seen.sensor_orientation[0], abs=1e-12)
    if robot is None:  # the shape is imposed: where the section lies from the head, whatever pushes
        apart = np.linalg.norm(np.array([place.x, place.y, place.z]) - seen.position)
        assert apart == pytest.approx(np.linalg.norm(alone.backbone[0] - alone.position), abs=1e-6)
        relative = abs(np.dot([turn.x, turn.y, turn.z, turn.w], seen.orientation))
        assert relative == pytest.approx(abs(np.dot(alone.section_orientation[0], alone.orientation)), abs=1e-9)


@pytest.mark.fault(
    "samples",
    "wrenches for another frame, not finite, of wall time, far ahead, or older than the one in force",
    "left out with one line that names the field; the last one holds",
)
def test_wrenches_that_do_not_fit_are_refused_and_the_node_goes_on(start, client):
    swim = client(topics=("head_pose", "energy"))
    node = start("dynamics", "--ros-args", *FRAMES)
    swim.laws.publish(law_to_message(straight()))
    sender = publisher(swim)
    swim.until_time(0.2)
    sender.publish(wrench(0.0, "base_link", (0.5, 0.0, 0.0)))
    swim.until(lambda: swim.received["energy"][-1].external_work != 0.0, "the work of the tow")
    told = "external wrench refused: "
    for message, said in (
        (wrench(0.0, "neck"), f"{told}header.frame_id must be one of base_link, thruster, tether, got 'neck'"),
        (wrench(0.0, "thruster", (0.0, math.nan, 0.0)), f"{told}wrench.force must be finite, got [0.0, nan, 0.0]"),
        (wrench(0.0, "tether", torque=(math.inf, 0, 0)), f"{told}wrench.torque must be finite, got [inf, 0.0, 0.0]"),
        (wrench(1e6, "tether"), f"{told}header.stamp must be simulation time"),
        (wrench(100.0, "tether"), f"{told}header.stamp must be at most 5 s ahead of the simulation"),
        (wrench(0.0, "", (1e35, 0.0, 0.0)), f"{told}external wrench force must be 0 to 1e+30 in size"),
    ):
        for _ in range(3):
            sender.publish(message)
        swim.until(lambda said=said: said in node.output(), said)
    late = swim.received["energy"][-1]
    time = nanoseconds(late.header.stamp) * 1e-9
    sender.publish(wrench(time + 0.3, "", (0.7, 0.0, 0.0)))
    swim.until_time(time + 0.6, "energy")
    sender.publish(wrench(time + 0.2, "", (9.0, 0.0, 0.0)))
    node.wait_for_output("is older than that of t = ", LIMIT)
    swim.until(lambda: swim.diagnosis()[2].get("commanded_wrenches") == "1", "the frame in the diagnostics")
    assert swim.reset().success
    begun = len(swim.received["energy"])
    swim.until(lambda: len(swim.received["energy"]) > begun + 20, "a second run")
    assert all(each.external_work == 0.0 for each in swim.received["energy"][begun + 5 :])
    assert node.output().count("got 'neck'") == 1
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()


def test_a_run_in_lockstep_waits_for_the_wrenches_that_it_is_told_to(start, client):
    """Each sample is answered with the wrench of a spring at the tail, which acts from that sample on."""
    swim = client(topics=("backbone", "energy"))
    node = start(
        "dynamics", *FAST, *FRAMES, "-p", "duration:=0.5", "-p", "wait_for:=[external_wrench/tether]",
        "-p", "subscriber_timeout:=60",
    )  # fmt: skip
    sender, answered, given = publisher(swim), set(), {}
    swim.laws.publish(law_to_message(straight()))

    def done():
        shapes = by_stamp(swim.received["backbone"])
        for stamp in sorted(shapes.keys() - answered):
            answered.add(stamp)
            given[stamp] = -3.0 * (shapes[stamp].position[-3] + 1.0)
            sender.publish(wrench(stamp * 1e-9, "tether", (given[stamp], 0.0, 0.0)))
        return len(shapes) == 26 and len(by_stamp(swim.received["energy"])) == 26

    swim.until(done, "26 samples")
    assert "waiting for curvature_law or curvature_samples" in node.output()
    assert node.wait(LIMIT) == 0 and "WARN" not in node.output() and "ERROR" not in node.output(), node.output()
    library = Simulation(law=straight(), sensors=[0.51, 1.0], wrenches=[ExternalWrench(0.51), ExternalWrench(1.0)])
    energies = by_stamp(swim.received["energy"])
    for stamp in sorted(energies):
        library.advance(stamp / 1e9)
        assert energies[stamp].external_work == library.observe().energy.external_work
        library.apply_wrench(1.0, (given[stamp], 0.0, 0.0))
    assert library.observe().energy.external_work < -1e-6


@pytest.mark.fault("parameters", "wrenches or frames of wrenches that do not fit", "status 2, with one line")
def test_frames_that_do_not_fit_end_the_start(start_in_turn):
    cannot_be = {
        "wrench_frames:=[thruster]": "wrench_frames must each be NAME X, with X in m from the head, got 'thruster'",
        "wrench_frames:=[thruster front]": "wrench_frames thruster must be finite, got nan",
        "wrench_frames:=[thruster 1.5]": "external wrench station must lie on the body, 0 to 1 m, got 1.5 m",
        "wrench_frames:=[thruster -0.5]": "wrench_frames thruster must be >= 0 m, got -0.5",
        "wrench_frames:=[a 0.5, a 0.6]": "wrench_frames must have names of their own, got 'a' again",
        "wrench_frames:=[odom 0.5]": "wrench_frames must have names of their own, got 'odom' again",
        "wrench_frames:=[imu_link 0.5]": "wrench_frames must have names of their own, got 'imu_link' again",
        "wrench_frames:=[link_2 0.5]": "wrench_frames must have names of their own, got 'link_2' again",
        "wrenches:=head station=0": "external wrench must be one of section, world, got 'head'",
        "wrenches:=section force=1,0,0": "external wrench station must be given",
        "wait_for:=[external_wrench/neck]": "wait_for external_wrench/ must be one of base_link, got 'neck'",
    }
    lines = [["--ros-args", "-p", given] for given in cannot_be]
    for told, (status, said) in zip(cannot_be.values(), start_in_turn("eel_dynamics.ros.node", lines), strict=True):
        assert status == 2 and said.count("\n") == 1 and told in said, said
