# SPDX-License-Identifier: Apache-2.0
"""Laws as the node receives them: taken once, checked, adopted."""

from types import SimpleNamespace

import pytest
from builtin_interfaces.msg import Time
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.testing.log import Log
from eel_dynamics.ros.inputs.awaited import Awaited
from eel_dynamics.ros.law_subscription import LawSubscription
from eel_dynamics.ros.loop.law_adopter import LawAdopter
from eel_gaits.ros.messages import law_to_message
from rclpy.serialization import serialize_message

from eel_dynamics import Robot, Scene, Simulation
from eel_gaits import Law, Term, falling, straight


class FakeRun:
    """A run loop that is asked to adopt laws at once."""

    def __init__(self, time=0.0):
        self.time, self.laws, self.requests = time, [], self

    def put(self, action, *arguments, newest):
        action(*arguments)

    def take_law(self, law, origin):
        self.laws.append((law, origin))


def adopter_of(simulation, log):
    report = Report(log)
    return LawAdopter(simulation, Awaited(report), report)


def message(name="wave", sec=0, nanosec=0, period=1.0):
    """A serialised law."""
    law = law_to_message(Law(Term(amplitude=(1.0,), period=1.0), name=name), stamp=Time(sec=sec, nanosec=nanosec))
    law.terms[0].period = period
    return serialize_message(law)


def feed(run, log):
    node = SimpleNamespace(create_subscription=lambda *arguments, **options: None)
    return LawSubscription(node, run, Report(log))


def info(number):
    return {"source_timestamp": 1000 + number, "publication_sequence_number": number}


def test_a_law_delivered_twice_is_adopted_once():
    run = FakeRun()
    law_feed = feed(run, Log())
    for number, name in ((1, "a"), (2, "b"), (1, "a"), (2, "b"), (3, "a")):
        law_feed.receive_law(message(name), info(number))
    assert [law.name for law, _ in run.laws] == ["a", "b", "a"]


def test_origin_is_the_stamp():
    run = FakeRun()
    feed(run, Log()).receive_law(message(sec=3, nanosec=500_000_000), info(1))
    assert run.laws[0][1] == 3.5


@pytest.mark.parametrize(
    ("stamp", "words"),
    [
        ({"sec": -1}, ("header.stamp", "-1")),
        ({"nanosec": 2_000_000_000}, ("header.stamp", "2000000000")),
        ({"sec": 1_700_000_000}, ("1700000000", "wall time", "use_sim_time")),
        ({"sec": 3611}, ("3611",)),
    ],
)
def test_bad_stamp_is_refused(stamp, words):
    run, log = FakeRun(time=10.0), Log()
    feed(run, log).receive_law(message(**stamp), info(1))
    assert not run.laws
    ((level, text),) = log.lines
    assert level == "error" and all(word in text for word in words), text


def test_stamp_up_to_an_hour_ahead_is_taken():
    run = FakeRun(time=10.0)
    feed(run, Log()).receive_law(message(sec=3609), info(1))
    assert run.laws[0][1] == 3609.0


def test_bad_law_is_one_error_that_names_the_field():
    run, log = FakeRun(), Log()
    feed(run, log).receive_law(message("jump", period=-1.0), info(1))
    assert not run.laws
    assert log.lines == [("error", "law 'jump' refused: terms[0].period must be >= 0 s, got -1.0")]


@pytest.mark.fault(
    "samples",
    "a law that arrives while samples drive the body",
    "the law is adopted; one warning names the samples lost",
)
@pytest.mark.parametrize("last", [0.0, 0.5])
def test_a_law_that_replaces_samples_says_which_it_drops(last):
    simulation, log = Simulation(scene=Scene(planar=True)), Log()
    adopter = adopter_of(simulation, log)
    rows = {name: [0.0, 0.0] for name in ("pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel")}
    adopter.try_law(falling(pitch_bend=0.0), 0.0)
    for time in (0.1, 0.2, last) if last else ():
        adopter.add_samples({"time": time, "x": [0.0, 1.0], **rows})
    adopter.try_law(Law(name="next"), 0.0)
    warnings = [text for level, text in log.lines if level == "warning"]
    assert warnings == ["curvature samples up to t = 0.5 s are dropped: law 'next' is newer"][: bool(last)]
    assert log.lines[-1 - bool(last)] == ("info", "law 'next' adopted at t = 0 s")


def test_motors_that_are_too_slow_for_a_law_are_a_warning():
    robot, log = Robot.named("eight_servos"), Log()
    adopter = adopter_of(Simulation(scene=Scene(planar=True), robot=robot.changed(speed_limit=0.5)), log)
    adopter.try_law(straight(), 0.0)
    (warning,) = (text for level, text in log.lines if level == "warning")
    assert warning.startswith("8 of 8 motors are too slow for the law: the one of joint_8 is asked for 2.39 rad/s")
