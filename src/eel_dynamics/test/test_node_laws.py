# SPDX-License-Identifier: Apache-2.0
"""Laws over DDS: blended without a jump, good ones taken from anybody, bad ones refused with one clear error."""

import math
import re
import time

import numpy as np
import pytest
from eel_gaits.ros.messages import law_to_message
from rclpy.qos import QoSProfile
from swim_client import LIMIT, is_finite, nanoseconds

from eel_gaits import Law, Term, falling
from eel_msgs.msg import CurvatureLaw

GENTLE = ("--ros-args", "-p", "rate:=200", "-p", "real_time_factor:=0.5", "-p", "wait_for_subscribers:=1")


def bend(amount, name="bend", transition=0.0):
    return Law(Term(axis="yaw", amplitude=(amount,), phase=math.pi / 2), name=name, transition=transition)


def wave(amplitude, period, name, transition):
    term = Term(axis="yaw", amplitude=(amplitude, 1.0), wavelength=1.0, period=period)
    lift = Term(axis="pitch", amplitude=(0.5 * amplitude,), phase=math.pi / 2)
    return Law(term, lift, name=name, transition=transition)


@pytest.mark.fault(
    "laws",
    "a law that changes in the middle of a blend, three times",
    "the curvature, its rate and its acceleration never jump",
)
def test_laws_in_mid_blend_never_make_the_curvature_jump(start, client):
    """Three laws, each sent before the blend of the last is over. The published curvature, its rate and the second
    difference of it are what one smooth function gives: no jump in K, dK/dt or d2K/dt2."""
    swim = client(topics=("curvature",))
    swim.laws.publish(law_to_message(wave(1.0, 1.0, "first", 0.0)))
    node = start("dynamics", *GENTLE)
    swim.until_time(0.5, "curvature")
    for amplitude, period, name in ((3.0, 0.7, "second"), (-2.0, 1.3, "third"), (4.0, 0.9, "fourth")):
        swim.laws.publish(law_to_message(wave(amplitude, period, name, 0.6)))
        swim.until(lambda name=name: f"law '{name}' adopted" in node.output(), f"the {name} law")
        swim.until_time(nanoseconds(swim.latest("curvature").header.stamp) / 1e9 + 0.12, "curvature")
    end = nanoseconds(swim.latest("curvature").header.stamp) / 1e9 + 0.7
    swim.until_time(end, "curvature")

    messages = swim.received["curvature"]
    step = 1.0 / 200
    stamps = np.array([nanoseconds(message.header.stamp) for message in messages])
    pair = np.diff(stamps) == round(1e9 * step)  # at real time, a listener on a busy machine may miss some samples
    triple = pair[1:] & pair[:-1]
    assert triple.sum() > 100 and np.all(np.diff(stamps) > 0)
    for value, rate in (("yaw", "yaw_rate"), ("pitch", "pitch_rate")):
        K = np.array([getattr(message, value) for message in messages])
        rates = np.array([getattr(message, rate) for message in messages])
        greatest = np.abs(np.diff(rates, axis=0)[pair]).max() / step  # acceleration
        assert np.ptp(K[:, 25]) > 1.0  # something did happen
        # K is the integral of its published rate (trapezoidal rule) ...
        change = np.diff(K, axis=0) - 0.5 * step * (rates[1:] + rates[:-1])
        assert np.abs(change[pair]).max() < 1e-3 * greatest * step
        # ... and the rate has a continuous derivative: its second difference stays far below a jump of the acceleration
        jump = np.abs(np.diff(rates, 2, axis=0)[triple]).max() / step
        assert jump < 0.2 * greatest, (jump, greatest)
    last = messages[-1]
    own = wave(4.0, 0.9, "fourth", 0.6).curvature(stamps[-1] / 1e9, np.array(last.x))[0]
    assert np.allclose(last.yaw, own[:, 2], atol=1e-9) and np.allclose(last.pitch, own[:, 1], atol=1e-9)


def test_stamp_is_where_the_laws_own_time_begins(start, client):
    swim = client(topics=("curvature",))
    message = law_to_message(falling())
    message.header.stamp.nanosec = 500_000_000
    swim.laws.publish(message)
    start("dynamics", "--ros-args")
    swim.until_time(1.5, "curvature")
    for received in swim.received["curvature"][::10]:
        t = nanoseconds(received.header.stamp) / 1e9
        assert np.allclose(received.yaw, falling().curvature(t - 0.5, np.array(received.x))[0][:, 2], atol=1e-9)


@pytest.mark.fault("laws", "the same law published over and over", "adopted once, its blend does not begin anew")
def test_a_volatile_publisher_is_received_and_repeating_changes_nothing(start, client):
    """As `ros2 topic pub -r 20` does it: default quality of service, the same law over and over."""
    swim = client(topics=("curvature",))
    publisher = swim.node.create_publisher(CurvatureLaw, "curvature_law", QoSProfile(depth=10))
    node = start("dynamics", "--ros-args")
    node.wait_for_output("waiting for curvature_law", LIMIT)
    message = law_to_message(bend(1.5, transition=0.3))

    def said_until(seconds):
        deadline = time.monotonic() + LIMIT
        while not (
            swim.received["curvature"] and nanoseconds(swim.received["curvature"][-1].header.stamp) > seconds * 1e9
        ):
            assert time.monotonic() < deadline
            publisher.publish(message)
            swim.spin(0.05)

    said_until(0.5)
    message = law_to_message(bend(-1.0, name="other", transition=0.3))
    said_until(swim.newest("curvature") / 1e9 + 0.1)
    node.wait_for_output("law 'other' adopted", LIMIT)
    said_until(float(re.findall(r"law 'other' adopted at t = (\S+) s", node.output())[0]) + 0.5)
    assert np.allclose(swim.latest("curvature").yaw, -1.0)  # repeating did not begin the blend anew
    assert node.output().count("adopted") == 2, node.output()
    assert "incompatible" not in node.output()


def edited(**changes):
    """A good law's message with fields of its first term, or of itself, changed."""
    message = law_to_message(Law(Term(amplitude=(1.0,), wavelength=1.0, period=1.0), name="bad"))
    for name, value in changes.items():
        setattr(message if hasattr(message, name) else message.terms[0], name, value)
    return message


BAD = {
    "not finite": (edited(amplitude=[math.nan]), ("terms[0].amplitude", "nan")),
    "infinite": (edited(wavelength=math.inf), ("terms[0].wavelength", "inf")),
    "negative period": (edited(period=-1.0), ("terms[0].period", "-1")),
    "unknown axis": (edited(axis=7), ("terms[0].axis", "7")),
    "arrays that do not fit": (edited(knots=[0.0, 0.5, 1.0]), ("terms[0].amplitude", "knot", "3")),
    "negative transition": (edited(transition=-2.0), ("transition", "-2")),
    "too many terms": (edited(terms=edited().terms * 1001), ("terms", "1001")),
    "far too many terms": (edited(terms=edited().terms * 100_000), ("terms", "100000")),
    "far too many values": (edited(amplitude=[1.0] * 1_000_000), ("terms", "524288 bytes", "80000")),
}


@pytest.mark.fault(
    "laws", "a law with NaN or infinity", "refused with one error that names the field; the law in force stays"
)
@pytest.mark.fault(
    "laws",
    "arrays that do not fit each other, a negative period or transition, an unknown axis",
    "refused with one error that names the field",
)
@pytest.mark.fault("laws", "1,001 terms, 100,000 terms, a million coefficients", "refused: at most 1,000 of each")
@pytest.mark.fault("laws", "a negative stamp", "refused")
@pytest.mark.fault("laws", "a stamp of wall time", "refused, with the hint to use_sim_time")
def test_bad_laws_leave_the_good_one_in_force(start, client):
    swim = client(topics=("curvature", "head_pose", "internal_wrench", "energy"))
    swim.laws.publish(law_to_message(bend(0.5, name="good")))
    node = start("dynamics", "--ros-args")
    swim.until_time(0.2)
    wall_time = law_to_message(bend(9.0, name="bad"))
    wall_time.header.stamp.sec = int(time.time())
    negative = law_to_message(bend(9.0, name="bad"))
    negative.header.stamp.sec = -3
    laws = {
        **BAD,
        "wall time": (wall_time, ("header.stamp", str(wall_time.header.stamp.sec), "use_sim_time")),
        "negative stamp": (negative, ("header.stamp", "-3")),
    }
    for what, (message, _) in laws.items():
        before = node.output().count("[ERROR]")
        swim.laws.publish(message)
        swim.until(lambda before=before: node.output().count("[ERROR]") > before, f"error for {what}")
    swim.until_time(nanoseconds(swim.latest("head_pose").header.stamp) / 1e9 + 1.2)
    errors = [line for line in node.output().splitlines() if "[ERROR]" in line]
    assert len(errors) == len(laws), node.output()
    for line, (what, (_, words)) in zip(errors, laws.items(), strict=True):
        assert all(word in line for word in (*words, "'bad'", "refused")), (what, line)
    assert all(np.allclose(message.yaw, 0.5) for message in swim.received["curvature"])
    for topic in ("head_pose", "internal_wrench", "energy"):
        assert all(is_finite(message) for message in swim.received[topic])
    assert node.status is None
    swim.laws.publish(law_to_message(bend(0.7, name="next", transition=0.1)))
    swim.until(lambda: np.allclose(swim.received["curvature"][-1].yaw, 0.7), "the next good law")


@pytest.mark.fault("laws", "a law with pitch in a planar scene", "refused; the next law is taken")
def test_pitch_in_a_planar_scene_is_refused(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "scene.planar:=true")
    node.wait_for_output("pitch", LIMIT)
    assert "[ERROR]" in node.output() and node.status is None
    swim.laws.publish(law_to_message(bend(1.0)))
    swim.until_time(0.2)
    assert swim.latest("head_pose").pose.position.z == 0.0


@pytest.mark.fault(
    "laws", "two publishers of laws at once", "WARN in /diagnostics while it lasts; the later message wins"
)
def test_two_publishers_of_laws_are_a_warning_while_it_lasts(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(bend(0.5)))
    node = start("dynamics", "--ros-args")
    swim.until_time(0.2)
    second = swim.node.create_publisher(CurvatureLaw, "curvature_law", QoSProfile(depth=1))
    swim.until(  # among others, on a busy machine
        lambda: "2 publishers of curvature_law" in swim.diagnosis()[2]["warnings"], "warning"
    )
    assert swim.diagnosis()[0] == 1 and swim.diagnosis()[2]["publishers_of_laws"] == "2"
    swim.node.destroy_publisher(second)
    swim.until(swim.is_well, "end of the warning")
    assert node.output().count("2 publishers of curvature_law") == 1


@pytest.mark.parametrize("early", [True, False])
def test_the_law_may_come_before_or_after_the_node(start, client, early):
    swim = client(topics=("head_pose",))
    if early:
        swim.laws.publish(law_to_message(bend(0.5, name="only")))
    node = start("dynamics", "--ros-args")
    node.wait_for_output("adopted" if early else "waiting for curvature_law", LIMIT)
    swim.laws.publish(law_to_message(bend(0.5, name="only")))
    swim.until_time(0.1)
    assert node.output().count("waiting for curvature_law") <= 1 and node.output().count("'only' adopted") == 1


@pytest.mark.fault(
    "laws",
    "3,000 laws, one right after the other",
    "the run goes on and takes the last law before each sample; twenty log lines a second",
)
@pytest.mark.fault("laws", "a law without terms", "valid: the body straightens, over the law's transition")
def test_a_flood_of_laws_and_one_without_terms(start, client):
    swim = client(topics=("curvature",))
    swim.laws.publish(law_to_message(bend(0.5, name="first")))
    node = start("dynamics", "--ros-args", "-p", "rate:=50")
    swim.until_time(0.3, "curvature")
    began, before = time.monotonic(), nanoseconds(swim.latest("curvature").header.stamp)
    for k in range(1, 3001):
        swim.laws.publish(law_to_message(bend(math.sin(0.01 * k), name=f"law {k}", transition=0.2)))
        if k % 100 == 0:
            swim.turn()  # takes what the run publishes meanwhile
    swim.until_time(before / 1e9 + 1.0, "curvature")
    swim.laws.publish(law_to_message(bend(0.25, name="last", transition=0.1)))
    swim.until(lambda: np.allclose(swim.received["curvature"][-1].yaw, 0.25), "the last law")
    assert swim.diagnosis()[0] < 2 and node.output().count("adopted") < 22 * (time.monotonic() - began + 2.0)

    swim.laws.publish(law_to_message(Law(name="nothing", transition=0.5)))
    swim.until(lambda: not np.any(swim.received["curvature"][-1].yaw), "a straight body")
    K = np.array([message.yaw[25] for message in swim.received["curvature"]])
    rates = np.array([message.yaw_rate[25] for message in swim.received["curvature"]])
    stamps = np.array([nanoseconds(message.header.stamp) for message in swim.received["curvature"]])
    steps = np.diff(stamps) / 1e9
    assert np.all(steps > 0.0)
    slope = np.abs(rates).max()  # from one sample to the next K goes no further than its greatest rate allows
    assert np.all(np.abs(np.diff(K)) <= 2.0 * slope * steps + 1e-12)
