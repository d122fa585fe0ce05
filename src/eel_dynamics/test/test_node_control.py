# SPDX-License-Identifier: Apache-2.0
"""Control of a run over DDS: pause, reset, pace, parameters, what stops a simulation, and /clock meanwhile."""

import time

import numpy as np
import pytest
from eel_gaits.ros.messages import law_to_message
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger
from swim_client import LIMIT, is_finite, nanoseconds

from eel_gaits import Law, Term, falling


def seconds(message):
    return nanoseconds(message.clock if isinstance(message, Clock) else message.header.stamp) / 1e9


@pytest.mark.fault(
    "time",
    "waiting for a law, and a pause",
    "/clock ticks on at the time that stands, sample 0 is repeated; afterwards the run does not hurry",
)
def test_clock_ticks_while_waiting_and_while_paused(start, client):
    swim = client(topics=("head_pose", "odom"), clock=True)
    start("dynamics", "--ros-args")
    swim.until(lambda: swim.received["/clock"] and swim.starts["odom"], "clock and sample 0")
    ticks, starts = len(swim.received["/clock"]), swim.starts["odom"]
    swim.until(lambda: swim.starts["odom"] > starts + 10, "sample 0, repeated")
    assert {seconds(message) for message in swim.received["/clock"]} == {0.0} and swim.newest("odom") == 0
    assert len(swim.received["/clock"]) - ticks > 11, "the clock ticks more often than sample 0 is repeated"
    swim.laws.publish(law_to_message(falling()))
    swim.until_time(0.3)
    stands = swim.stop_the_clock("head_pose")
    swim.until(lambda: seconds(swim.received["/clock"][-1]) == stands, "the clock's standing")
    ticks = len(swim.received["/clock"])
    swim.until(lambda: len(swim.received["/clock"]) > ticks + 5, "clock while paused")
    assert seconds(swim.received["head_pose"][-1]) == stands
    assert {seconds(message) for message in swim.received["/clock"][ticks:]} == {stands}
    resumed = time.monotonic()
    assert swim.pause(False).success
    swim.until_time(stands + 0.3)
    assert time.monotonic() - resumed > 0.25  # it does not hurry after the time that it stood
    stamps = [nanoseconds(message.header.stamp) for message in swim.received["head_pose"]]
    assert stamps == sorted(set(stamps))
    assert np.all(np.diff([seconds(message) for message in swim.received["/clock"]]) >= 0.0)


@pytest.mark.fault(
    "time", "a reset in mid-run", "the same law from its own t = 0: the second run repeats the first, bit by bit"
)
def test_reset_begins_again_with_the_same_law(start, client):
    swim = client(topics=("head_pose",))
    message = law_to_message(falling())
    swim.laws.publish(message)
    start("dynamics", "--ros-args", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")  # nothing is lost
    swim.until_time(2.0)
    answer = swim.reset()
    assert answer.success and answer.message == "reset at t = 0 s"

    received, again = swim.received["head_pose"], 1

    def second_has_begun():
        """Whether the sample `again` is its first one, which may come thousands of samples after the answer."""
        nonlocal again
        while again < len(received) and seconds(received[again]) > seconds(received[again - 1]):
            again += 1
        return again < len(received)

    swim.until(second_has_begun, "the second run")
    swim.until(lambda: seconds(received[-1]) > 2.0, "as much of the second run")
    first = {seconds(m): m.pose for m in received[:again]}
    second = {seconds(m): m.pose for m in received[again:]}
    assert min(first) == min(second) == 0.0
    common = [t for t in first if t in second]
    assert len(common) > 200 and max(common) > 2.0
    for t in common:
        assert first[t] == second[t], t


@pytest.mark.fault("time", "300 resets at once", "all answered, in order; a pause behind them too")
def test_many_resets_are_answered_in_order(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    start("dynamics", "--ros-args")
    swim.until_time(0.2)
    deep = QoSProfile(depth=1000)
    reset = swim.node.create_client(Trigger, "dynamics/reset", qos_profile=deep)
    pause = swim.node.create_client(SetBool, "dynamics/pause", qos_profile=deep)
    swim.until(lambda: reset.service_is_ready() and pause.service_is_ready(), "the services")
    swim.acquaint(reset, Trigger.Request())
    swim.acquaint(pause, SetBool.Request(data=False))
    answered = []
    asked = [reset.call_async(Trigger.Request()) for _ in range(300)]
    for number, answer in enumerate(asked):
        answer.add_done_callback(lambda done, number=number: answered.append((number, done.result().success)))
    last = pause.call_async(SetBool.Request(data=True))
    swim.until(lambda: len(answered) == 300 and last.done(), "all answers")
    assert answered == [(number, True) for number in range(300)] and last.result().success


def test_pace_follows_the_real_time_factor(start, client):
    """Slower than real time, so that a slow machine keeps the pace too; what the node itself measures of it."""
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    start("dynamics", "--ros-args", "-p", "real_time_factor:=0.5", "-p", "wait_for_subscribers:=1")

    def keeps(factor):
        return float(swim.diagnosis()[2]["real_time_factor"]) == pytest.approx(factor, rel=0.1)

    swim.until(lambda: keeps(0.5), "pace of 0.5 s a second")
    (result,) = swim.set(real_time_factor=0.25)
    assert result.successful and swim.get("real_time_factor") == [0.25]
    swim.until(lambda: keeps(0.25), "pace of 0.25 s a second")


def test_parameters_at_run_time(start, client):
    swim = client(topics=())
    start("dynamics", "--ros-args", "-p", "rate:=50", "-p", "accuracy:=0.001", "-p", "scene.density:=900")
    assert swim.get("rate", "accuracy", "scene.density", "scene.friction") == [50.0, 0.001, 900.0, "printed"]
    for name, value, words in (
        ("real_time_factor", 0.0, ("real_time_factor", "> 0", "got 0")),
        ("real_time_factor", -1.0, ("real_time_factor", "-1")),
        ("subscriber_timeout", "long", ("subscriber_timeout must be a number", "'long'")),
        ("rate", -10.0, ("rate must be > 0 Hz, got -10",)),
        ("duration", 10.0, ("read-only", "duration")),
    ):
        (result,) = swim.set(**{name: value})
        assert not result.successful and all(word in result.reason for word in words), result.reason
    assert all(result.successful for result in swim.set(subscriber_timeout=2, publish_tf=False))
    assert swim.get("subscriber_timeout", "publish_tf", "real_time_factor") == [2.0, False, 1.0]
    (result,) = swim.set(**{"scene.planar": True})
    assert result.successful and result.reason == "acts at the next reset"


def test_parameters_are_described(start, client):
    swim = client(topics=())
    start("dynamics")
    names = "rate", "real_time_factor", "scene.friction", "scene.metacentric_height"
    rate, factor, friction, height = swim.describe(*names)
    assert (
        not rate.read_only
        and "[Hz]; a change acts at the next reset" in rate.description
        and rate.floating_point_range[0].to_value == 1e4
    )
    assert not factor.read_only and factor.floating_point_range[0].from_value == 0.0
    assert friction.additional_constraints == "one of printed, laminar, blended, taylor, none" and friction.description
    assert "[m]" in height.description and not height.floating_point_range  # top-heavy bodies too


@pytest.mark.fault(
    "laws",
    "a law that no body can swim (a thousand rad/m)",
    "the simulation stops at its last good state with one error; nothing NaN is published; reset starts it again",
)
def test_law_that_cannot_be_swum_stops_once_and_reset_starts_again(start, client):
    swim = client(topics=("head_pose", "internal_wrench", "energy"), clock=True)
    monster = Law(Term(amplitude=(1e3,), period=1.0), name="monster")  # wound up 160 times
    swim.laws.publish(law_to_message(monster))
    node = start("dynamics", "--ros-args", "-p", "most_evaluations:=5000", "-p", "estimate_error:=false")
    node.wait_for_output("stopped at t =", LIMIT)
    swim.until(lambda: swim.diagnosis()[0] == 2, "error in the diagnostics")
    swim.until_time(float(swim.diagnosis()[2]["time"]) - 1e-6)  # what was sent before may still be on its way
    samples, ticks = len(swim.received["head_pose"]), len(swim.received["/clock"])
    swim.until(lambda: len(swim.received["/clock"]) > ticks + 20, "clock after the stop")
    assert len(swim.received["head_pose"]) == samples
    for topic in ("head_pose", "internal_wrench", "energy"):
        assert all(is_finite(message) for message in swim.received[topic])
    assert (
        node.output().count("simulation stopped at t =") == 1
        and "Traceback" not in node.output()
        and node.status is None
    )
    swim.laws.publish(law_to_message(falling()))
    swim.until(lambda: "law 'falling' adopted" in node.output(), "the next law")
    assert swim.reset().success
    swim.until_time(0.5)
    swim.until(swim.is_well, "good diagnostics")


@pytest.mark.fault("laws", "a law that winds the body up beyond all bounds", "refused; the next law is taken")
def test_law_that_cannot_be_begun_is_refused(start, client):
    swim = client(topics=("head_pose",), clock=True)
    swim.laws.publish(law_to_message(Law(Term(amplitude=(1e29,), wavelength=1.0, period=1e-3), name="beyond")))
    node = start("dynamics", "--ros-args")
    node.wait_for_output("law 'beyond' refused: law 'beyond' bends the body into", LIMIT)
    swim.laws.publish(law_to_message(falling()))
    swim.until_time(0.3)
    assert all(is_finite(message) for message in swim.received["head_pose"])


@pytest.mark.fault(
    "load",
    "a pace that the machine cannot keep",
    "WARN with the lost time, once while it lasts; accuracy is kept, not the pace; a tenth above it regains the time",
)
def test_late_run_says_so_once_and_once_more_when_it_is_over(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "real_time_factor:=100000")
    swim.until(
        lambda: swim.received["/diagnostics"] and float(swim.diagnosis()[2]["late"]) > 0.0, "late in the diagnostics"
    )
    first = swim.diagnosis()[1]
    swim.until(lambda: "late by" in swim.diagnosis()[1] and swim.diagnosis()[1] != first, "a later figure")
    assert node.output().count("late by") == 1 and swim.diagnosis()[0] == 1
    assert swim.reset().success
    node.wait_for_output("no longer late at t = ", LIMIT)
