# SPDX-License-Identifier: Apache-2.0
"""A run that follows the /clock of another node: the loop without ROS, and the node."""

import threading
import time

import pytest
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.loop.followed_clock import FollowedClock
from eel_common.ros.testing.log import Log
from eel_gaits.ros.messages import law_to_message
from fake_publishers import fake_publishers, run_loop
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from swim_client import LIMIT, nanoseconds

from eel_dynamics import Simulation
from eel_gaits import falling

FOLLOW = ("--ros-args", "-p", "follow_clock:=true")


class FollowingRun:
    """A run in a thread of its own, with what it has published: `stamps` [ns]."""

    def __init__(self, **parameters):
        self.stamps, self.log = [], Log()
        self._published = threading.Condition()
        simulation, publishers = Simulation(accuracy=1e-2, law=falling()), fake_publishers(self._keep)
        self.run = run_loop(simulation, publishers, Report(self.log), follow_clock=True, rate=100.0, **parameters)
        self.thread = threading.Thread(target=self.run.run)
        self.thread.start()

    def _keep(self, snapshot, stamp):
        with self._published:
            self.stamps.append(stamp)
            self._published.notify()

    def show(self, seconds):
        """Show this time on /clock."""
        self.run.requests.put(self.run.pace.show, seconds, time.monotonic())

    def wait_for(self, stamp):
        """Until the sample of `stamp` [ns] has been published."""
        with self._published:
            assert self._published.wait_for(lambda: self.stamps and self.stamps[-1] == stamp, LIMIT)

    def look(self):
        """Let the loop look twice for what is to be done."""
        for _ in range(2):
            assert self.run.requests.put(lambda: None).done.wait(LIMIT)

    def stop(self):
        self.run.requests.stop()
        self.thread.join(LIMIT)


@pytest.mark.parametrize("factor", [0.0, 1.0, 1e-3])
def test_each_sample_comes_once_the_clock_shows_its_time_whatever_the_factor(factor):
    swim = FollowingRun(real_time_factor=factor, duration=0.2)
    try:
        swim.look()
        assert not any(swim.stamps), "only sample 0 before the first time on /clock"
        for shown, newest in ((0.0, 0), (0.055, 50_000_000), (0.06, 60_000_000)):
            swim.show(shown)
            swim.wait_for(newest)
            swim.look()
            assert swim.stamps[-1] == newest
        swim.show(7.0)
        swim.thread.join(LIMIT)
        assert [stamp for stamp in swim.stamps if stamp] == [10_000_000 * k for k in range(1, 21)]
        assert ("info", "waiting for /clock") in swim.log.lines and ("info", "finished at t = 0.2 s") in swim.log.lines
    finally:
        swim.stop()


def test_a_run_stands_where_the_clock_goes_back_until_it_is_reset_too():
    swim = FollowingRun(real_time_factor=0.0)
    try:
        swim.show(0.5)
        swim.wait_for(500_000_000)
        swim.show(0.1)
        swim.look()
        assert swim.stamps[-1] == 500_000_000
        assert swim.run.standing == "waiting for /clock, which went back to t = 0.1 s: reset starts this run again too"
        assert swim.run.requests.put(swim.run.reset, urgent=True).done.wait(LIMIT)
        swim.wait_for(100_000_000)
        swim.show(0.6)
        swim.wait_for(600_000_000)
        assert swim.stamps[-51:] == [10_000_000 * k for k in range(10, 61)]
    finally:
        swim.stop()


def test_how_far_it_is_behind_is_late():
    clock = FollowedClock(0.01, 1.0)
    clock.show(2.0, 0.0)
    assert clock.lost(50) == pytest.approx(1.5) and clock.give_up_delay(50, 0.0) == pytest.approx(1.5)
    assert clock.give_up_delay(198, 0.0) == 0.0 and clock.lost(200) == pytest.approx(0.0, abs=1e-8)


def test_a_clock_that_stands_is_an_obstacle_with_its_time():
    clock = FollowedClock(0.01, 1.0)
    clock.show(2.0, 0.0)  # long ago
    clock.show(2.0, 1e9)  # it ticks at a time that stands
    assert clock.held_by(200) == "" and clock.held_by(201) == "waiting for /clock, which stands at t = 2 s"


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
@pytest.mark.fault(
    "time", "a dynamics node that is to follow the /clock of another node", "it publishes no sample before its time"
)
def test_a_node_follows_the_clock_of_another_node(start, client, reliability):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    clock = swim.node.create_publisher(Clock, "/clock", QoSProfile(depth=10, reliability=reliability))
    node = start("dynamics", *FOLLOW, "-p", "real_time_factor:=0", "-p", "duration:=0.4")
    node.wait_for_output("waiting for /clock", LIMIT)

    def stamp():
        return nanoseconds(swim.received["head_pose"][-1].header.stamp) if swim.received["head_pose"] else -1

    for shown in (0, 100_000_000, 105_000_000, 250_000_000):
        message, newest = Clock(), 10_000_000 * (shown // 10_000_000)
        message.clock.nanosec = shown

        def come(message=message, newest=newest):
            clock.publish(message)
            return stamp() == newest

        swim.until(come, f"the sample of {newest} ns")
        assert swim.get("rate") == [100.0] and stamp() == newest, "it has had time for one more"
    assert swim.set(clock=True)[0].successful and swim.set(use_sim_time=True)[0].successful, "it makes none anyway"
    assert not swim.set(follow_clock=False)[0].successful
    assert swim.node.count_publishers("/clock") == 1 and "WARN" not in node.output(), node.output()
    message.clock.sec = 1
    swim.until(lambda: clock.publish(message) or stamp() == 400_000_000, "the last sample")
    assert node.wait(LIMIT) == 0 and "finished at t = 0.4 s" in node.output(), node.output()


@pytest.mark.fault(
    "time", "use_sim_time at the dynamics node that makes /clock", "one line that says how to follow another; status 2"
)
def test_use_sim_time_is_refused_where_the_node_makes_the_clock(start_in_turn, start, client):
    (status, said), *_ = start_in_turn("eel_dynamics.ros.node", [["--ros-args", "-p", "use_sim_time:=true"]])
    assert status == 2 and said.count("\n") == 1, said
    assert said.startswith("dynamics: use_sim_time must be false in the node that makes /clock, got true; with follow_")
    swim = client(topics=())
    start("dynamics")
    (refused,) = swim.set(use_sim_time=True)
    assert not refused.successful and "use_sim_time must be false" in refused.reason
    assert all(swim.set(**each)[0].successful for each in ({"clock": False}, {"use_sim_time": True}))
    (refused,) = swim.set(clock=True)
    assert not refused.successful and "use_sim_time must be false" in refused.reason
