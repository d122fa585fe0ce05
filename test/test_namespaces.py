"""Two eels on one network: each node has the topics of its namespace; only /clock and /diagnostics are shared."""

import json
import subprocess
import sys

import pytest

LISTEN = """
import json, sys, time
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from rclpy.qos import QoSProfile, HistoryPolicy
rclpy.init()
node = rclpy.create_node("listener")
every = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
poses, statuses = {"/left": [], "/right": []}, []
for space in poses:
    node.create_subscription(PoseStamped, space + "/head_pose", poses[space].append, every)
node.create_subscription(DiagnosticArray, "/diagnostics", statuses.append, every)
print("ready", flush=True)
deadline = time.monotonic() + 90
while time.monotonic() < deadline:
    rclpy.spin_once(node, timeout_sec=0.1)
    names = {s.name for a in statuses for s in a.status}
    if all(len(p) == 301 for p in poses.values()) and all(any(space in name for name in names) for space in poses):
        break
clocks = node.get_publishers_info_by_topic("/clock")
print(json.dumps({
    "count": {k: len(v) for k, v in poses.items()},
    "end": {k: [v[-1].pose.position.x, v[-1].pose.position.y] for k, v in poses.items() if v},
    "names": sorted(names),
    "topics": sorted(n for n, _ in node.get_topic_names_and_types()),
}))
rclpy.shutdown()
"""


@pytest.mark.fault(
    "neighbours",
    "two eels in two namespaces",
    "each receives and publishes its own; only /clock and /diagnostics are shared",
)
def test_two_eels(start, fresh_domain, tmp_path):
    listener = start(sys.executable, "-c", LISTEN)
    listener.wait_for_output("ready")
    for space, gait in (("/left", "falling"), ("/right", "straight")):
        remap = ("--ros-args", "-r", f"__ns:={space}")
        start("gait_generator", *remap, "-p", f"gait:={gait}")
        start("dynamics", *remap, "-p", "duration:=3.0", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
    assert listener.wait(120.0) == 0, listener.output()
    received = json.loads([line for line in listener.output().splitlines() if line.startswith("{")][-1])
    assert received["count"] == {"/left": 301, "/right": 301}
    assert received["end"]["/left"] != received["end"]["/right"]
    assert {"/left/head_pose", "/right/head_pose", "/clock", "/diagnostics"} <= set(received["topics"])
    assert "/head_pose" not in received["topics"] and "/left/clock" not in received["topics"]


def test_a_name_of_its_own(start, fresh_domain):
    start("gait_generator", "--ros-args", "-r", "__node:=brain", "-r", "__ns:=/left").wait_for_output("left.brain")
    nodes = subprocess.run(
        [sys.executable, "-c", "import rclpy, time; rclpy.init(); n = rclpy.create_node('x')\n"
         "end = time.monotonic() + 60\n"
         "while ('brain', '/left') not in n.get_node_names_and_namespaces() and time.monotonic() < end: pass\n"
         "print(n.get_node_names_and_namespaces())"],
        capture_output=True, text=True, timeout=90,
    )  # fmt: skip
    assert "('brain', '/left')" in nodes.stdout, nodes.stdout + nodes.stderr
