# SPDX-License-Identifier: Apache-2.0
"""Controllers over DDS: one that answers /odom starts the run by itself, in lockstep, and goes on after a reset."""

import math

import numpy as np
import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_srvs.srv import Trigger
from swim_client import LIMIT, LOSSLESS, nanoseconds

from eel_msgs.msg import CurvatureSamples

TICK = 20_000_000  # ns
LOCKSTEP = ("--ros-args", "-p", "real_time_factor:=0", "-p", "rate:=50", "-p", "subscriber_timeout:=60")


def instant(time, amplitude=1.0):
    """K3 = amplitude sin(2 pi t), all along the body, at `time` [ns], with two derivatives."""
    x, phase = [0.0, 1.0], 2.0 * math.pi * time / 1e9
    message = CurvatureSamples(x=x, pitch=[0.0] * 2, pitch_rate=[0.0] * 2, pitch_accel=[0.0] * 2)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(time, 1_000_000_000)
    message.yaw = [amplitude * math.sin(phase)] * 2
    message.yaw_rate = [amplitude * 2.0 * math.pi * math.cos(phase)] * 2
    message.yaw_accel = [-amplitude * (2.0 * math.pi) ** 2 * math.sin(phase)] * 2
    return message


class Controller:
    """Answers each sample on /odom with an instant one tick ahead."""

    def __init__(self, swim, quality=LOSSLESS, ahead=TICK):
        self.swim, self.answered, self.ahead = swim, 0, ahead
        self._publisher = swim.node.create_publisher(CurvatureSamples, "curvature_samples", quality)

    def answer(self):
        """Answers the samples that have come."""
        heard = self.swim.received["odom"]
        if self.swim.starts["odom"] and len(heard) == 1:  # repeated
            self.answered = 0
        for message in heard[self.answered :]:
            self._publisher.publish(instant(nanoseconds(message.header.stamp) + self.ahead))
        self.answered = len(heard)

    def until(self, condition, what):
        def answered():
            self.answer()
            return condition()

        self.swim.until(answered, what)


def test_controller_that_answers_odom_starts_a_run_and_is_in_step_with_it(start, client):
    swim = client(topics=("odom", "curvature"))
    node = start("dynamics", *LOCKSTEP, "-p", "duration:=2")
    node.wait_for_output("waiting for curvature_law or curvature_samples", LIMIT)
    controller = Controller(swim)
    controller.until(lambda: len(swim.received["curvature"]) == 101, "101 samples")
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output() and "run out" not in node.output(), node.output()
    for message in swim.received["curvature"][55:]:  # after the blend
        wanted = math.sin(2.0 * math.pi * nanoseconds(message.header.stamp) / 1e9)
        assert np.allclose(message.yaw, wanted, atol=1e-9)
    swim.until(lambda: swim.diagnosis()[2]["samples_published"] == "101", "the count of samples")


def begin_of_last_run(messages):
    """The index of the first message whose stamp is before that of the one before it, counted from the end; or 0."""
    stamps = [nanoseconds(message.header.stamp) for message in messages]
    return max((k for k in range(1, len(stamps)) if stamps[k] < stamps[k - 1]), default=0)


@pytest.mark.parametrize("factor", [0, 2])
@pytest.mark.fault("time", "ten resets while a controller drives", "the run goes on from its start each time")
def test_run_with_a_controller_goes_on_after_ten_resets(start, client, factor):
    """At a pace, the controller looks a few ticks ahead; on a busy machine some of its samples are late."""
    swim = client(topics=("odom",))
    node = start("dynamics", *LOCKSTEP, "-p", f"real_time_factor:={factor}")
    controller = Controller(swim, ahead=TICK if factor == 0 else 5 * TICK)
    reset = swim.node.create_client(Trigger, "dynamics/reset")
    swim.until(reset.service_is_ready, "the service")
    swim.acquaint(reset, Trigger.Request())
    before = node.output().count("reset to t = 0 s")
    heard, runs = swim.received["odom"], []
    for _ in range(11):
        controller.until(lambda: heard and nanoseconds(heard[-1].header.stamp) >= 20 * TICK, "20 ticks of a run")
        runs.append(heard[0].header.stamp.nanosec)
        answer = reset.call_async(Trigger.Request())
        controller.until(answer.done, "answer")
        assert answer.result().success or "still queued" in answer.result().message  # on a busy machine
        controller.until(lambda: begin_of_last_run(heard) > 0, "the next run")
        begin = begin_of_last_run(heard)
        del heard[:begin]
        controller.answered = max(0, controller.answered - begin)
    assert runs[1:] == [0] * 10 and node.output().count("reset to t = 0 s") - before == 11
    assert factor > 0 or "ERROR" not in node.output(), node.output()


@pytest.mark.fault("samples", "a best-effort publisher of samples", "received like a reliable one, each sample once")
def test_best_effort_samples_are_received(start, client):
    swim = client(topics=("odom",))
    quality = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
    node = start("dynamics", "--ros-args", "-p", "rate:=50", "-p", "real_time_factor:=0.1")  # 5 s for each answer
    controller = Controller(swim, quality, ahead=25 * TICK)
    swim.until(lambda: swim.node.count_subscribers("curvature_samples") == 2, "the node's second subscription")
    controller.until(
        lambda: swim.received["odom"] and nanoseconds(swim.received["odom"][-1].header.stamp) >= 15 * TICK, "15 ticks"
    )
    assert "ERROR" not in node.output() and "incompatible" not in node.output(), node.output()


@pytest.mark.fault("samples", "a first sample of stamp 0", "taken: the motion begins with it")
def test_first_sample_may_have_stamp_0(start, client):
    swim = client(topics=("curvature",))
    node = start("dynamics", *LOCKSTEP, "-p", "duration:=0.4")
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    for time in range(0, 25 * TICK, TICK):
        swim.samples.publish(instant(time))
    swim.until(lambda: len(swim.received["curvature"]) == 21, "the run")
    assert "ERROR" not in node.output() and np.all(np.abs(swim.received["curvature"][3].yaw) > 0.0), node.output()
