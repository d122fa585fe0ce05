# SPDX-License-Identifier: Apache-2.0
"""Far more than a machine can do: the run falls behind and says so, and leaves nothing out of the physics."""

import sys

import numpy as np
import pytest
from eel_gaits.ros.messages import law_to_message
from swim_client import LIMIT, nanoseconds

from eel_dynamics import Simulation
from eel_gaits import falling

RATE, STATIONS, SUBSCRIBERS = 10_000, 1_000, 10
CROWD = """
import sys
import rclpy
from rclpy.executors import SingleThreadedExecutor
from eel_msgs.msg import Backbone, Curvature, InternalWrench
rclpy.init()
executor = SingleThreadedExecutor()
for number in range(int(sys.argv[1])):
    node = rclpy.create_node(f"listener_{number}")
    for topic, kind in (("backbone", Backbone), ("curvature", Curvature), ("internal_wrench", InternalWrench)):
        node.create_subscription(kind, topic, lambda data: None, 10, raw=True)
    executor.add_node(node)
print("listening", flush=True)
executor.spin()
"""


@pytest.mark.fault(
    "load",
    "10,000 Hz, 1,000 stations, 10 subscribers, all on one core",
    "WARN with the delay and the real-time factor that is reached; every sample is computed, as the library does",
)
def test_overload_falls_behind_and_skips_no_physics(start, client):
    start("taskset", "-c", "0", sys.executable, "-c", CROWD, str(SUBSCRIBERS)).wait_for_output("listening", LIMIT)
    swim = client(topics=("head_pose", "internal_wrench"))
    swim.laws.publish(law_to_message(falling()))
    node = start(
        "taskset", "-c", "0", "dynamics", "--ros-args", "-p", f"rate:={RATE}", "-p", f"stations:={STATIONS}",
        "-p", f"wait_for_subscribers:={SUBSCRIBERS}",
    )  # fmt: skip
    swim.until(lambda: swim.received["head_pose"], "a first sample")
    swim.until(lambda: swim.diagnosis()[0] == 1 and "late by" in swim.diagnosis()[1], "a warning of the delay")

    def further_diagnosis():
        """The values of the second from now on, so of what has happened by now."""
        before = len(swim.received["/diagnostics"])
        swim.until(lambda: len(swim.received["/diagnostics"]) > before + 1, "two more diagnostics")
        return swim.diagnosis()[2]

    values = further_diagnosis()
    assert 0.0 < float(values["real_time_factor"]) < 0.9 and float(values["late"]) > 0.0
    while not swim.pause(True).success:
        pass
    values = further_diagnosis()
    assert int(values["samples_published"]) == round(float(values["time"]) * RATE) + 1
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()
    # A listener may miss samples, on each topic others; those that it has are where they belong, and right.
    simulation = Simulation(stations=STATIONS)
    simulation.adopt(falling())
    received = {
        topic: {nanoseconds(message.header.stamp): message for message in swim.received[topic]}
        for topic in ("head_pose", "internal_wrench")
    }
    chosen = set()
    for topic, messages in received.items():
        stamps = np.array([nanoseconds(message.header.stamp) for message in swim.received[topic]])
        k = np.round(stamps * 1e-9 * RATE).astype(int)
        assert len(stamps) and np.array_equal(stamps, np.round(k * 1e9 / RATE)) and np.all(np.diff(k) > 0), topic
        chosen.update(list(messages)[:: max(1, len(messages) // 20)])
    for stamp in sorted(chosen):
        simulation.advance(round(stamp * 1e-9 * RATE) / RATE)
        snapshot = simulation.observe()
        if stamp in received["head_pose"]:
            pose = received["head_pose"][stamp].pose.position
            assert np.allclose((pose.x, pose.y, pose.z), snapshot.position, rtol=0, atol=1e-12)
        if stamp in received["internal_wrench"]:
            torque = received["internal_wrench"][stamp].torque_3
            assert np.allclose(torque, snapshot.torque[:, 2], rtol=0, atol=1e-10)
