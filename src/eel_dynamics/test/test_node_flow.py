# SPDX-License-Identifier: Apache-2.0
"""Who waits for whom: subscribers slow, stuck or late, controllers that drive and die, others on /clock."""

import array
import math
import os
import signal
import sys
import time

import numpy as np
import pytest
from eel_common.ros import fastdds_profile
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import PoseStamped
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from swim_client import LIMIT, LOSSLESS, SAMPLES, nanoseconds

from eel_gaits import Law, Term, falling, straight
from eel_msgs.msg import CurvatureSamples

FLAT_OUT = ("--ros-args", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
CHEAP = (
    "accuracy:=draft",
    "estimate_error:=false",
    "scene.planar:=true",
    "scene.internal_wrench:=false",
    "stations:=5",
)
MANY = tuple(word for each in (*CHEAP, "rate:=1000") for word in ("-p", each))  # samples in little time

LISTENER = """
import sys, time
import rclpy
from eel_msgs.msg import Backbone
from rclpy.qos import HistoryPolicy, QoSProfile
rclpy.init()
node = rclpy.create_node("listener")
received = 0
def count(message):
    global received
    received += 1
    if received == 1:
        print("received one", flush=True)
node.create_subscription(Backbone, "backbone", count, QoSProfile(history=HistoryPolicy.KEEP_ALL))
print("listening", flush=True)
while True:
    rclpy.spin_once(node, timeout_sec=0.1)
"""

# Fast DDS forgets a participant that is silent for 20 s, and its subscriptions, unless it has announced a longer lease.
LONG_LEASE = """
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="long_lease" is_default_profile="true">
    <rtps><builtin><discovery_config><leaseDuration><sec>600</sec></leaseDuration></discovery_config></builtin></rtps>
  </participant>
</profiles>
"""


def seconds(message):
    return nanoseconds(message.clock if isinstance(message, Clock) else message.header.stamp) / 1e9


@pytest.mark.fault(
    "subscribers",
    "a subscriber that takes nothing until all histories are full, as fast as possible",
    "the run waits for it; it gets every sample",
)
def test_a_subscriber_that_is_slow_for_a_while_loses_nothing(start, client):
    """It takes nothing until the node waits for it: the run makes 12,000 samples, the histories of both sides hold
    5,000 each."""
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", *FLAT_OUT, "-p", "duration:=12", *MANY, "-p", "subscriber_timeout:=60")
    node.wait_for_output("waiting for a subscriber", LIMIT)
    swim.until(lambda: len(swim.received["head_pose"]) >= 12001, "12001 samples", 2 * LIMIT)
    stamps = [nanoseconds(message.header.stamp) for message in swim.received["head_pose"]]
    assert stamps == [k * 1_000_000 for k in range(12001)]
    assert node.wait(LIMIT) == 0 and "stuck" not in node.output()


@pytest.mark.fault(
    "subscribers",
    "50 subscribers of a topic, of which 10 want a quality of service that it does not have",
    "a warning names the policy; those 10 get nothing, nobody waits for them; the others get what they asked for",
)
def test_fifty_subscribers_of_all_qualities(start, client):
    swim = client(topics=())
    qualities = {
        "lossless": LOSSLESS,
        "reliable": QoSProfile(depth=1000),
        "best effort": QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT),
        "shallow": QoSProfile(depth=1),
        "latched": QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL),  # the samples are not
    }
    names = [f"{quality} {k}" for quality in qualities for k in range(10)]
    for name in names:
        swim.listen("head_pose", PoseStamped, qualities[name.rpartition(" ")[0]], name)
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", *FLAT_OUT[:-1], "wait_for_subscribers:=40", "-p", "duration:=2", "-p", "rate:=100")
    kept = [name for name in names if name.startswith(("lossless", "reliable"))]
    swim.until(lambda: all(len(swim.received[name]) >= 201 for name in kept), "201 samples in each of 20")
    for name in kept:
        assert [nanoseconds(message.header.stamp) for message in swim.received[name]] == [k * 10**7 for k in range(201)]
    for name in names:
        assert bool(swim.received[name]) != name.startswith("latched"), name
    assert node.wait(LIMIT) == 0 and "stuck" not in node.output()
    told = [line for line in node.output().splitlines() if "incompatible" in line and "head_pose" in line]
    assert told and all("DURABILITY" in line for line in told), node.output()


@pytest.mark.fault(
    "subscribers",
    "a subscriber that takes nothing until the run is over",
    "the node stays for it, half a minute or `subscriber_timeout`; it gets every sample",
)
def test_a_run_that_is_over_waits_for_who_is_behind(start, client):
    """8,001 samples: what the subscriber's history cannot hold (5,000) is in the node's."""
    swim, watcher = client(topics=("head_pose",)), client(topics=())
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", *FLAT_OUT, "-p", "duration:=8", *MANY)
    watcher.until(lambda: watcher.diagnosis()[2]["samples_published"] == "8001", "the end of the run")
    assert node.status is None and not swim.received["head_pose"]
    swim.until(lambda: len(swim.received["head_pose"]) >= 8001, "8001 samples")
    assert node.wait(LIMIT) == 0 and "received everything" not in node.output()


@pytest.mark.fault(
    "subscribers",
    "a subscriber stopped by SIGSTOP, as fast as possible",
    "waited for `subscriber_timeout`, once, or until Fast DDS forgets it, 20 s after its last sign; then WARN, and all "
    "others that keep up get every sample",
)
@pytest.mark.soak
def test_a_stuck_subscriber_delays_a_run_once_and_costs_the_others_nothing(start, client, tmp_path):
    """One that is itself 5000 samples behind when another is given up loses what it had no room for. The node's history
    and what is on the way hold some 8,000 samples."""
    profile = tmp_path / "long_lease.xml"
    profile.write_text(LONG_LEASE)
    stuck = start("env", f"{fastdds_profile.VARIABLE}={profile}", sys.executable, "-c", LISTENER)
    stuck.wait_for_output("listening")
    swim = client(topics=("backbone", "head_pose"))
    pace = ("-p", "duration:=13", *MANY, "-p", "subscriber_timeout:=10")
    node = start("dynamics", *FLAT_OUT[:-1], "wait_for_subscribers:=2", *pace)
    stuck.wait_for_output("received one", LIMIT)  # sample 0, which is repeated until there is a law
    os.kill(stuck.process.pid, signal.SIGSTOP)
    swim.laws.publish(law_to_message(straight()))
    try:
        # were it waited for again and again, the thousands of samples that it misses would take hours
        swim.until(lambda: len(swim.received["head_pose"]) >= 13001, "all samples of the other topic", 2 * LIMIT)
        assert "has been stuck for 10 s" in node.output() and node.output().count("has been stuck") == 1, node.output()
        swim.until(lambda: len(swim.received["backbone"]) >= 13001, "all samples of the same topic")
        assert node.wait(LIMIT) == 0
        warned = lambda: any(swim.diagnosis(message)[0] == 1 for message in swim.received["/diagnostics"])  # noqa: E731
        swim.until(warned, "warning in the diagnostics")
    finally:
        os.kill(stuck.process.pid, signal.SIGCONT)


@pytest.mark.fault("subscribers", "a subscriber stopped by SIGSTOP, at real time", "no effect on the run")
def test_at_real_time_nobody_is_waited_for(start, client):
    stuck = start(sys.executable, "-c", LISTENER)
    stuck.wait_for_output("listening")
    swim = client(topics=("backbone",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", "rate:=500")
    swim.until_time(0.5, "backbone")
    os.kill(stuck.process.pid, signal.SIGSTOP)
    try:
        swim.until_time(seconds(swim.received["backbone"][-1]) + 4.0, "backbone")  # more than its history
        assert "stuck" not in node.output() and "waiting for a subscriber" not in node.output()
    finally:
        os.kill(stuck.process.pid, signal.SIGCONT)


@pytest.mark.fault(
    "subscribers", "a subscriber that comes late, with wait_for_subscribers", "the first sample waits for it"
)
def test_first_sample_waits_for_the_subscribers_asked_for(start, client):
    first = client(topics=tuple(SAMPLES), clock=True)
    first.laws.publish(law_to_message(falling()))
    node = start("dynamics", *FLAT_OUT[:-1], "wait_for_subscribers:=2", "-p", "duration:=1")
    node.wait_for_output("2 subscribers", LIMIT)
    node.wait_for_output("law 'falling' adopted", LIMIT)
    first.until(lambda: len(first.received["/clock"]) > 20, "clock while the node waits")
    assert {seconds(message) for message in first.received["/clock"]} == {0.0} and not first.received["head_pose"]
    second = client(topics=tuple(SAMPLES))
    for each in (first, second):
        each.until(
            lambda each=each: all(len(each.received[topic]) >= 101 for topic in SAMPLES), "101 samples of each topic"
        )
    assert node.wait(LIMIT) == 0


# controllers


ROWS = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"


def instant(t, amplitude=1.0, period=1.0):
    """K3 = amplitude (1 + X) sin(2 pi t / period) at time t, with two derivatives."""
    x, w = np.linspace(0.0, 1.0, 11), 2.0 * math.pi / period
    message = CurvatureSamples(x=x.tolist())
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(t * 1e9), 1_000_000_000)
    for name in ("pitch", "pitch_rate", "pitch_accel"):
        setattr(message, name, [0.0] * 11)
    message.yaw = (amplitude * math.sin(w * t) * (1.0 + x)).tolist()
    message.yaw_rate = (amplitude * w * math.cos(w * t) * (1.0 + x)).tolist()
    message.yaw_accel = (-amplitude * w * w * math.sin(w * t) * (1.0 + x)).tolist()
    return message


def test_controller_without_a_law_drives_flat_out(start, client):
    """A controller that answers each sample with an instant ahead: the simulation waits for it."""
    swim = client(topics=("curvature",))
    patient = ("-p", "subscriber_timeout:=60")
    node = start("dynamics", *FLAT_OUT, "-p", "rate:=50", "-p", "default_transition:=0.1", *patient)
    node.wait_for_output("waiting for curvature_law", LIMIT)
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    for k in (1, 2, 3):
        swim.samples.publish(instant(0.02 * k))
    sent = 3
    deadline = time.monotonic() + LIMIT
    while not (swim.received["curvature"] and seconds(swim.received["curvature"][-1]) >= 2.0):
        assert time.monotonic() < deadline, node.output()
        swim.executor.spin_once(timeout_sec=0.02)
        while swim.received["curvature"] and sent < 50 * seconds(swim.received["curvature"][-1]) + 3:
            sent += 1
            swim.samples.publish(instant(0.02 * sent))
    assert [nanoseconds(m.header.stamp) for m in swim.received["curvature"]] == [
        20_000_000 * k for k in range(len(swim.received["curvature"]))
    ]
    for message in swim.received["curvature"][10:]:  # after the blend
        expected = math.sin(2 * math.pi * seconds(message)) * (1.0 + np.array(message.x))
        assert np.allclose(message.yaw, expected, rtol=0, atol=1e-4)
    assert "run out" not in node.output()


@pytest.mark.fault(
    "samples",
    "a controller that dies in mid-stroke",
    "the shape comes to rest smoothly, one error; it goes on when samples return",
)
@pytest.mark.parametrize("factor", ["1", "0"])
def test_dying_controller_brings_the_shape_to_rest_and_may_come_back(start, client, factor):
    swim = client(topics=("curvature",))
    swim.laws.publish(law_to_message(Law(name="still")))
    options = (
        "-p",
        f"real_time_factor:={factor}",
        "-p",
        "rate:=100",
        "-p",
        "default_transition:=0.3",
        "-p",
        "subscriber_timeout:=1",
    )
    node = start(
        "dynamics",
        "--ros-args",
        *options,
        "-p",
        "wait_for_subscribers:=1",
        *(("-p", "duration:=1e6") if factor == "0" else ()),  # never reached
    )
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    swim.until(lambda: swim.received["curvature"], "a first sample")

    def drive():
        """Half a second of samples, sent while the run stands; their end."""
        times = swim.stop_the_clock("curvature") + 0.05 * np.arange(1, 11)
        swim.deliver([instant(t) for t in times])
        return times[-1]

    end = drive()
    swim.pause(False)
    swim.until_time(end + 1.0, "curvature")
    moved = [m for m in swim.received["curvature"] if seconds(m) <= end]
    after = [m for m in swim.received["curvature"] if seconds(m) >= end]
    assert max(np.abs(m.yaw).max() for m in moved) > 0.5
    assert np.allclose(swim.received["curvature"][-1].yaw_rate, 0.0, atol=1e-12)  # at rest
    steps = np.abs(np.diff([m.yaw_rate for m in after], axis=0))
    steps = steps[np.diff([seconds(m) for m in after]) < 0.011].max()  # a listener that is late may miss a sample
    assert steps < 0.05 * max(np.abs(m.yaw_rate).max() for m in moved) + 2.0  # comes to rest without a jump
    assert node.output().count("have run out") == 1
    swim.until(
        lambda: swim.diagnosis()[0] == 2 and "have run out" in swim.diagnosis()[1], "lost control in diagnostics"
    )
    end = drive()
    swim.pause(False)
    swim.until_time(end, "curvature")
    node.wait_for_output("are back", LIMIT)
    swim.until_time(end + 1.0, "curvature")
    assert node.output().count("have run out") == 2


@pytest.mark.fault("samples", "samples out of order", "put in order; the motion is the same")
@pytest.mark.fault(
    "samples", "a sample repeated, or a second one for the same instant", "refused: the first one counts"
)
@pytest.mark.fault(
    "samples", "samples missing, or too sparse for the motion", "bridged by one quintic: what was sent is met, no jump"
)
@pytest.mark.fault(
    "samples", "samples that jump from one instant to the next", "met one after the other, fast but smoothly"
)
def test_irregular_samples_make_one_smooth_motion(start, client):
    """Sent while the run stands before its first sample: shuffled, some twice, some missing for 0.3 s, at the end every
    0.4 s alone (of a motion of period 1 s), in the middle a jump of 1 rad/m within 20 ms. As fast as possible, so no
    sample of the motion is missed."""
    swim = client(topics=("curvature",))
    briefly = ("-p", "subscriber_timeout:=1")
    node = start("dynamics", *FLAT_OUT, "-p", "rate:=500", "-p", "default_transition:=0.1", *briefly)
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    assert swim.pause(True).success
    swim.laws.publish(law_to_message(Law(name="still")))
    node.wait_for_output("paused at t = 0 s", LIMIT)
    begin = 0.2
    steps = [0.02 * k for k in range(51) if not 15 < k < 30] + [1.4, 1.8, 2.2]
    jump = 0.7
    sent = {begin + step: instant(begin + step) for step in steps}
    for time_of, message in sent.items():
        if time_of >= begin + jump - 1e-6:
            message.yaw = [value + 1.0 for value in message.yaw]
    order = np.random.default_rng(1).permutation(sorted(sent))
    messages = []
    for count, time_of in enumerate(order):
        messages.append(sent[time_of])
        if count % 10 == 0:  # a second one, that wants something else
            other = instant(time_of)
            other.yaw = [9.0] * 11
            messages.append(other)
    swim.deliver(messages)
    swim.pause(False)
    end = begin + steps[-1]
    swim.until_time(end + 0.3, "curvature")
    assert "twice" in node.output() and node.output().count("have run out") == 1, node.output()

    received = {round(seconds(m) / 0.002): m for m in swim.received["curvature"]}
    for time_of, message in sent.items():
        if time_of > begin + 0.15:  # after the blend from rest
            got = received[round(time_of / 0.002)]
            expected = np.array(message.yaw)[0] + (np.array(message.yaw)[-1] - message.yaw[0]) * np.array(got.x)
            assert np.allclose(got.yaw, expected, rtol=0, atol=1e-9), time_of
    K = np.array([message.yaw[25] for message in swim.received["curvature"]])
    rates = np.array([message.yaw_rate[25] for message in swim.received["curvature"]])
    stamps = np.array([seconds(message) for message in swim.received["curvature"]])
    assert np.allclose(np.diff(stamps), 0.002, rtol=0, atol=1e-8), "samples were lost"
    acceleration = np.gradient(rates, 0.002)
    greatest = np.abs(acceleration).max()  # that of the jump, whatever it is: finite, and K and its rate go along
    assert np.abs(np.diff(K) - 0.001 * (rates[1:] + rates[:-1])).max() < 0.1 * greatest * 0.002**2 + 1e-12
    away = (stamps < begin + jump - 0.05) | (stamps > begin + jump + 0.05)
    assert np.abs(K[away]).max() < 4.5  # bridged without overshoot: 1.5 is the motion's own amplitude there, plus 1


@pytest.mark.fault(
    "samples",
    "a sample that comes too late",
    "refused with one warning that says how to join a run; the shape stays as it is",
)
@pytest.mark.fault(
    "samples", "a sample with NaN, or with arrays that do not fit", "refused with one error that names the array"
)
def test_bad_samples_are_refused(start, client):
    swim = client(topics=("curvature",))
    swim.laws.publish(law_to_message(Law(name="still")))
    node = start("dynamics", "--ros-args")
    swim.until_time(0.2, "curvature")
    short, late, odd = instant(0.0), instant(0.0), instant(0.0)
    short.yaw = [1.0]
    odd.pitch = [math.nan] * 11
    for message, level, words in (
        (short, "ERROR", ("yaw", "11", "1")),
        (late, "WARN", ("header.stamp", "ahead", "got 0 s", "joins a running simulation begins 1/rate or more after")),
        (odd, "ERROR", ("pitch", "nan")),
    ):

        def said(message=message, level=level, words=words):
            """Whether it is logged; the sample is sent again and again, as refusals are logged once a second."""
            if message is not late:
                message.header.stamp.sec = swim.latest("curvature").header.stamp.sec + 2
            swim.samples.publish(message)
            lines = [line for line in node.output().splitlines() if f"[{level}]" in line]
            return any("samples" in line and all(word in line for word in words) for line in lines)

        swim.until(said, f"{level} {words}")
    assert not np.any(swim.latest("curvature").yaw) and node.status is None


@pytest.mark.fault(
    "samples",
    "a sample of 20,000 points, or of a million",
    "refused: at most 1601 points",
)
@pytest.mark.fault(
    "samples",
    "630 samples of 1601 points while the run is paused",
    "samples of at most 1,000,000 points are kept, the others refused with the number",
)
def test_samples_of_too_many_points_and_too_many_of_them_are_refused(start, client):
    swim = client(topics=("curvature",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args")
    swim.until_time(0.2, "curvature")
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    for points in (20_000, 1_000_000):
        said = f"curvature samples refused: x must have at most 1601 points, got {points}"
        message, row = instant(1.0), array.array("d", bytes(8 * points))
        for name in ("x", *ROWS):
            setattr(message, name, row)
        swim.spin(1.1)  # errors of one kind are said once a second
        swim.samples.publish(message)
        swim.until(lambda said=said: said in node.output(), said)
    before = len(node.output())
    x = np.linspace(0.0, 1.0, 1601)
    rows = {name: array.array("d", bytes(8 * 1601)) for name in ROWS}
    begin = swim.stop_the_clock("curvature") + 0.1
    swim.deliver([CurvatureSamples(header=instant(begin + 2.0 * k).header, x=x.tolist(), **rows) for k in range(600)])
    assert "refused" not in node.output()[before:]
    swim.spin(1.1)
    begin += 1200.0
    swim.deliver([CurvatureSamples(header=instant(begin + 2.0 * k).header, x=x.tolist(), **rows) for k in range(30)])
    limit = "ahead of the simulation must be at most 10000, of 1000000 points, got 625 of 1000625"
    swim.until(lambda: limit in node.output(), "limit")
    assert swim.reset().success and swim.pause(False).success
    swim.until_time(0.5, "curvature")
    swim.until(swim.is_well, "good diagnostics")


@pytest.mark.fault(
    "samples",
    "a sample far ahead of all others, from a controller that heard another robot's odom",
    "refused, if it lies more than 5 s after the last one; the body comes to rest when the controller stops",
)
def test_a_stray_sample_far_ahead_does_not_keep_the_body_from_coming_to_rest(start, client):
    swim = client(topics=("curvature",))
    node = start("dynamics")
    swim.until(lambda: swim.samples.get_subscription_count() == 1, "the node's subscription")
    assert swim.pause(True).success
    swim.deliver([instant(0.02 * k) for k in range(50)])
    for ahead in (3000.0, 100.0):
        swim.spin(1.1)  # errors of one kind are said once a second
        swim.samples.publish(instant(ahead))
        said = f"at most 5 s after the last sample or the simulation (0.98 s), got {ahead:g} s"
        swim.until(lambda said=said: said in node.output(), said)
    assert swim.pause(False).success
    swim.until(lambda: "curvature samples have run out" in node.output(), "rest")
    swim.until_time(3.0, "curvature")
    assert not np.any(swim.latest("curvature").yaw_rate)
    assert np.abs([message.yaw for message in swim.received["curvature"]]).max() < 4.0


# /clock


@pytest.mark.fault(
    "neighbours",
    "another publisher of /clock",
    "WARN; this node leaves /clock to it, and takes it up again when it has gone",
)
def test_second_publisher_of_clock_is_left_alone(start, client):
    swim = client(topics=("head_pose",))
    other = swim.node.create_publisher(Clock, "/clock", LOSSLESS)
    node = start("dynamics", "--ros-args")
    node.wait_for_output("/clock is published by", LIMIT)
    swim.until(lambda: swim.node.count_publishers("/clock") == 1, "the node's leaving /clock to the other")
    swim.until(
        lambda: swim.diagnosis()[0] == 1 and "/clock is published by /swim_client" in swim.diagnosis()[1], "warning"
    )
    swim.node.destroy_publisher(other)
    publishers = lambda: [info.node_name for info in swim.node.get_publishers_info_by_topic("/clock")]  # noqa: E731
    swim.until(lambda: publishers() == ["dynamics"], "its return")


@pytest.mark.fault("neighbours", "a second dynamics node on the network", "the first keeps /clock")
def test_of_two_nodes_the_first_keeps_the_clock(start, client):
    swim = client(topics=(), clock=True)
    first = start("dynamics", "--ros-args", "-r", "__ns:=/first")
    first.wait_for_output("waiting for curvature_law", LIMIT)
    swim.until(lambda: len(swim.received["/clock"]) > 100, "clock of the first")
    second = start("dynamics", "--ros-args", "-r", "__ns:=/second")
    second.wait_for_output("/clock is published by", LIMIT)

    def publishers():
        return {info.node_namespace for info in swim.node.get_publishers_info_by_topic("/clock")}

    swim.until(lambda: publishers() == {"/first"}, "the second's leaving /clock to the first")
    ticks = len(swim.received["/clock"])
    swim.until(lambda: publishers() != {"/first"} or len(swim.received["/clock"]) > ticks + 60, "clock of the first")
    assert publishers() == {"/first"}


def test_clock_can_be_off(start, client):
    swim = client(topics=("head_pose",), clock=True)
    swim.laws.publish(law_to_message(Law(Term(amplitude=(1.0,), period=1.0))))
    start("dynamics", "--ros-args", "-p", "clock:=false")
    swim.until_time(0.5)
    assert not swim.received["/clock"] and swim.node.count_publishers("/clock") == 0
    assert swim.set(clock=True)[0].successful
    swim.until(lambda: swim.received["/clock"], "clock")
