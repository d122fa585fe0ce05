# SPDX-License-Identifier: Apache-2.0
"""A controller in lockstep, whatever it sends: each run after a reset is the first one again, to the last bit."""

import contextlib
import hashlib
import itertools
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from eel_common.ros.testing.service_call import answer_of
from eel_gaits.ros.messages import law_to_message, samples_to_message, stamp_of
from geometry_msgs.msg import Vector3Stamped, WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from swim_client import LIMIT, LOSSLESS, nanoseconds

from eel_gaits import straight
from eel_msgs.msg import CurvatureSamples
from eel_msgs.srv import Step

PERIOD, SAMPLES, RESETS = 0.02, 15, 5
RUNS, LOAD = 5, 20  # of the soak test, with four resets each
TABLE = Path(__file__).parents[3] / "out" / "lockstep.txt"
TOPICS = "head_pose", "odom", "energy"
X = np.linspace(0.0, 1.0, 5)
FAST = ("--ros-args", "-p", "real_time_factor:=0", "-p", f"rate:={1.0 / PERIOD}", "-p", "subscriber_timeout:=60")
RUDDER = "left station=0.5 area=0.001 aspect_ratio=2.5 dihedral=1.2 angle=commanded time_constant=0.1"


def bend(time):
    """A swing that begins from rest, by sample [1]."""
    return min(1.0, 2.0 * time) ** 2 * math.sin(8.0 * time)


def curvature(time):
    """Up to two samples ahead, as a controller sends it that answers."""
    times = [time + k * PERIOD for k in ((0, 1, 2) if time == 0.0 else (2,))]
    for each in times:
        rows = np.zeros((6, len(X)))
        rows[3] = 0.3 * bend(each)
        yield samples_to_message(each, X, rows)


def angles(*names):
    """Of joints or fins, at the time of the sample that is answered."""

    def answer(time):
        message = JointState(name=names, position=[0.2 * bend(time - 0.05 * k) for k in range(len(names))])
        message.header.stamp = stamp_of(time)
        yield message

    return answer


def current(time):
    message = Vector3Stamped()
    message.header.stamp, message.vector.y = stamp_of(time), 0.1 * bend(time)
    yield message


def wrenches(time):
    for frame, size in (("base_link", 0.1), ("thruster", 0.3)):
        message = WrenchStamped()
        message.header.stamp, message.header.frame_id = stamp_of(time), frame
        message.wrench.force.y = size * bend(time)
        yield message


def joints(*names):
    return "joint_commands", JointState, LOSSLESS, angles(*names)


ROBOT, FINS = "robot:=eight_servos", f"fins:={RUDDER}"
SAMPLED = "curvature_samples", CurvatureSamples, LOSSLESS, curvature
FIN, WATER = ("fin_command", JointState, LOSSLESS, angles("left")), ("current", Vector3Stamped, LOSSLESS, current)
CASES = {  # parameters, and what is sent: in what type, how, and which messages answer a sample
    "a law": ((), []),
    "samples": ((), [SAMPLED]),
    "samples after a law": (("wait_for_subscribers:=2",), [SAMPLED]),
    "joints": ((ROBOT,), [joints("joint_1", "joint_5")]),
    "joints of two publishers": ((ROBOT,), [joints("joint_1"), joints("joint_5")]),
    "joints, fins and current": ((ROBOT, FINS), [joints("joint_1", "joint_5"), FIN, WATER]),
    "fins with a law": ((FINS,), [FIN]),
    "wrenches with a law": (
        ("wrench_frames:=[thruster 0.5]",),
        [("external_wrench", WrenchStamped, LOSSLESS, wrenches)],
    ),
    "current with a law": ((), [(*WATER[:2], qos_profile_sensor_data, current)]),
}


def runs_of(swim):
    """The messages of each topic, run by run, by sample."""
    found = []
    for topic in TOPICS:
        runs, last = [[]], 0
        for message in swim.received[topic]:
            stamp = nanoseconds(message.header.stamp)
            if stamp < last:
                runs.append([])
            runs[-1].append(message)
            last = stamp
        found.append(runs)
    return found


@pytest.mark.fault(
    "time",
    "resets in the midst of a run in lockstep with samples, commands of joints or fins, currents, or wrenches",
    "no run goes on before its first message; each is the first one again, to the last bit",
)
@pytest.mark.parametrize("case", CASES)
def test_each_run_after_a_reset_is_the_first_one_again(start, client, case):
    digests, said = digests_of(start, client, case, RESETS)
    assert len(digests) == RESETS + 1 and len(set(digests)) == 1, (digests, said[-2000:])
    assert "ERROR" not in said and " s of wall time" not in said, said[-2000:]


@pytest.mark.fault(
    "load",
    "five runs in lockstep of four resets each, of any input, also from two processes, at a load of 20 (`make soak`)",
    "all are the same to the last bit",
)
@pytest.mark.soak
@pytest.mark.timeout(2 * 3600)
def test_five_runs_and_their_resets_are_one_at_a_load_of_twenty(start, client):
    """Prints a table, and writes it to out/lockstep.txt."""
    lines, parted = [f"{'input':28s} {'runs':>4s} {'resets':>6s} {'digests':>7s}  sha256 of {', '.join(TOPICS)}"], []
    with busy(LOAD):
        for case in (*CASES, TWO_PROCESSES):
            digests = [each for _ in range(RUNS) for each in digests_of(start, client, case, RUNS - 1)[0]]
            parted += [case] if len(set(digests)) > 1 else []
            lines.append(f"{case:28s} {RUNS:4d} {RUNS - 1:6d} {len(set(digests)):7d}  {digests[0][:16]}")
            assert len(digests) == RUNS**2
            print(lines[-1], flush=True)
        lines.append(f"load average {os.getloadavg()[0]:.0f} on {os.cpu_count()} cores")
    TABLE.parent.mkdir(exist_ok=True)
    TABLE.write_text("\n".join(lines) + "\n")
    print(TABLE.read_text())
    assert not parted


@contextlib.contextmanager
def busy(load):
    """As many busy processes as bring the machine to a `load`, with what else it does."""
    line = [sys.executable, "-c", "while True: pass"]
    others = [subprocess.Popen(line) for _ in range(max(0, load - round(os.getloadavg()[0])))]
    try:
        yield
    finally:
        for each in others:
            each.kill()
            each.wait()


def digests_of(start, client, case, resets):
    """A digest of each run, from the first to that after so many `resets`; and what the node said.

    A reset comes while the controller answers, so that what it sent before comes after it.
    """
    parameters, sent = CASES.get(case, (OF_TWO_PROCESSES, []))
    swim = client(topics=TOPICS)
    node = start("dynamics", *FAST, *(word for each in parameters for word in ("-p", each)))
    publishers = [(swim.node.create_publisher(kind, topic, quality), answer) for topic, kind, quality, answer in sent]
    others = [start(sys.executable, __file__, name) for name in (SHARED if case == TWO_PROCESSES else ())]
    for publisher, _ in publishers:
        swim.until(publisher.get_subscription_count, "the node's subscription")
    reset = swim._service(Trigger, "dynamics/reset")
    swim.acquaint(reset, Trigger.Request())
    seen = answers = 0

    def answered():
        """Answer what has come; the number of answers."""
        nonlocal seen, answers
        odoms = swim.received["odom"]
        arrived = odoms[seen:] or odoms[-1:] * (len(odoms) > 0 and nanoseconds(odoms[-1].header.stamp) == 0)
        for message, (publisher, answer) in itertools.product(arrived, publishers):
            for each in answer(1e-9 * nanoseconds(message.header.stamp)):
                publisher.publish(each)
        seen, answers = len(odoms), answers + len(arrived)
        return answers

    if case.endswith("with a law"):
        swim.until(lambda: answered() > 3, "answers before the law")
        swim.until(lambda: all(each.wait_for_all_acked(Duration(seconds=LIMIT)) for each, _ in publishers), "receipts")
    steps = case == "a law"  # nobody answers: the run would not wait
    if steps:
        assert swim.pause(True).success
    if "law" in case:
        swim.laws.publish(law_to_message(straight()))
    if case == "samples after a law":  # the run waits for another subscriber until they are there
        node.wait_for_output("law 'straight' adopted")
        for message in curvature(0.0):
            publishers[0][0].publish(message)
        assert publishers[0][0].wait_for_all_acked(Duration(seconds=LIMIT))
        swim.listen("odom", Odometry, name="gate")
    for run in range(resets + 1):
        if steps:
            assert swim._call_until_done(Step, "dynamics/step", samples=SAMPLES).success
        swim.until(
            lambda run=run: answered() and all(len(each) > run and len(each[-1]) > SAMPLES for each in runs_of(swim)),
            f"run {run}",
        )
        if run < resets:
            answer = answer_of(reset, Trigger.Request())
            swim.until(lambda answer=answer: answered() and answer(), "an answer to the call")
            assert answer().success
    digests = [
        hashlib.sha256("".join(repr(each[1 : SAMPLES + 1]) for each in run).encode()).hexdigest()
        for run in zip(*runs_of(swim), strict=True)
    ]
    assert node.interrupt() == 0
    for other in others:
        other.interrupt()
    swim.close()
    return digests, node.output()


TWO_PROCESSES, SHARED = "joints of two processes", ("joint_1", "joint_5")
OF_TWO_PROCESSES = ROBOT, "wait_for:=[joint_commands/joint_1, joint_commands/joint_5]", "wait_for_subscribers:=3"


def answer_for_a_joint(name):
    """A process: answers each sample of odom with a command for the joint `name`."""
    import rclpy

    rclpy.init()
    node = rclpy.create_node(f"controller_of_{name}")
    commands = node.create_publisher(JointState, "joint_commands", LOSSLESS)

    def answer(odometry):
        for message in angles(name)(1e-9 * nanoseconds(odometry.header.stamp)):
            commands.publish(message)

    node.create_subscription(Odometry, "odom", answer, LOSSLESS)
    with contextlib.suppress(KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    answer_for_a_joint(sys.argv[1])
