# SPDX-License-Identifier: Apache-2.0
"""Two eels on one network: each node has the topics and frames of its namespace; /clock, /diagnostics, /tf and the
frame world are shared."""

import json
import subprocess
import sys

import pytest
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import Transform
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_gaits import falling

LISTEN = """
import json, sys, time
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage
rclpy.init()
node = rclpy.create_node("listener")
every = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
poses, statuses, transforms, roots = {"/left": {}, "/right": {}}, [], {}, {}
def keep(kept, name, message):  # by stamp: sample 0 is repeated
    kept[name, message.header.stamp.sec, message.header.stamp.nanosec] = message
for space in poses:
    node.create_subscription(PoseStamped, space + "/head_pose", lambda m, s=space: keep(poses[s], "", m), every)
def receive(message):
    for each in message.transforms:
        keep(transforms, each.child_frame_id, each)
node.create_subscription(TFMessage, "/tf", receive, every)
def receive_root(message):
    for each in message.transforms:
        roots[each.child_frame_id] = each
node.create_subscription(TFMessage, "/tf_static", receive_root, latched)
node.create_subscription(DiagnosticArray, "/diagnostics", statuses.append, every)
print("ready", flush=True)
deadline = time.monotonic() + 90
while time.monotonic() < deadline:
    rclpy.spin_once(node, timeout_sec=0.1)
    names = {s.name for a in statuses for s in a.status}
    complete = len(transforms) == 602 and len(roots) == 2 and all(len(p) == 301 for p in poses.values())
    if complete and all(any(space in name for name in names) for space in poses):
        break
print(json.dumps({
    "count": {k: len(v) for k, v in poses.items()},
    "end": {k: [v[max(v)].pose.position.x, v[max(v)].pose.position.y] for k, v in poses.items() if v},
    "names": sorted(names),
    "frames": {k: sorted({m.header.frame_id for m in v.values()}) for k, v in poses.items()},
    "transforms": {
        t.child_frame_id: [t.header.frame_id, t.transform.translation.x] for _, t in sorted(transforms.items())
    },
    "roots": {child: [t.header.frame_id, str(t.transform)] for child, t in roots.items()},
    "topics": sorted(n for n, _ in node.get_topic_names_and_types()),
}))
rclpy.shutdown()
"""


@pytest.mark.fault(
    "neighbours",
    "two eels in two namespaces",
    "each receives and publishes its own, in frames of its own below one frame world; one follows the other's /clock",
)
def test_two_eels(start, fresh_domain, tmp_path):
    listener = start(sys.executable, "-c", LISTEN)
    listener.wait_for_output("ready")
    follow, nodes = ("-p", "follow_clock:=true"), []
    for space, gait, clock in (("/right", "straight", follow), ("/left", "falling", ())):
        remap = ("--ros-args", "-r", f"__ns:={space}")
        pace = ("-p", "duration:=3.0", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
        nodes.append(start("dynamics", *remap, *pace, *clock))
        nodes[-1].wait_for_output("waiting for")
        if space == "/left":  # it goes on without a look at who follows: so it begins once its clock is followed
            nodes[0].wait_for_output("waiting for /clock, which stands at t = 0 s")
        start("gait_generator", *remap, "-p", f"gait:={gait}")
    assert listener.wait(120.0) == 0, listener.output()
    received = json.loads([line for line in listener.output().splitlines() if line.startswith("{")][-1])
    assert received["count"] == {"/left": 301, "/right": 301}
    assert received["end"]["/left"] != received["end"]["/right"]
    assert received["frames"] == {"/left": ["left/odom"], "/right": ["right/odom"]}
    assert received["transforms"] == {
        f"{space}/base_link": [f"{space}/odom", received["end"][f"/{space}"][0]] for space in ("left", "right")
    }
    still = str(Transform())
    assert received["roots"] == {f"{space}/odom": ["world", still] for space in ("left", "right")}
    for node in nodes:
        assert node.wait(LIMIT) == 0 and "/clock is published" not in node.output(), node.output()
        assert "finished at t = 3 s" in node.output()
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


@pytest.mark.fault(
    "neighbours",
    "two dynamics nodes with the same topics",
    "the later one publishes nothing; both say ERROR, with the other's name, host, process and start",
)
@pytest.mark.soak
def test_two_dynamics_nodes_with_the_same_topics(start, fresh_domain):
    swim = SwimClient(domain=fresh_domain, topics=("head_pose",), clock=True)
    swim.laws.publish(law_to_message(falling()))

    def statuses(name):
        return [each for array in swim.received["/diagnostics"] for each in array.status if each.name == name]

    def status(name):
        """(level, message, values) of the newest status of the node `name`; level 0 while there is none."""
        newest = statuses(name)[-1:]
        return next(((s.level[0], s.message, {v.key: v.value for v in s.values}) for s in newest), (0, "", {}))

    def published(name):
        """The number of samples that the node had published by each of its statuses."""
        return [{v.key: v.value for v in each.values}["samples_published"] for each in statuses(name)]

    first = start("dynamics", "--ros-args", "-r", "__node:=first")
    swim.until_time(0.1)
    second = start("dynamics", "--ros-args", "-r", "__node:=second")
    swim.until(lambda: status("/first")[0] == status("/second")[0] == 2, "an ERROR of both")
    texts = {name: status(name)[1] for name in ("/first", "/second")}
    assert "publishes /head_pose already: this node waits" in texts["/second"], texts
    for name, node, other in (("/first", first, "/second"), ("/second", second, "/first")):
        values = status(other)[2]
        told = f"{other} (host {values['host']}, process {values['process']}, started {values['started']})"
        assert told in texts[name] and node.output().count(told) == 1, node.output()
    looks = len(published("/second")) + 2  # they come once a second: by then a sample on its way has been published
    swim.until(lambda: len(published("/second")) >= looks, "two more statuses of the second node")
    stands, looks = published("/second")[-1], len(published("/second"))
    before = len(swim.received["head_pose"])
    swim.until(lambda: len(swim.received["head_pose"]) > before + 50, "samples of the first node")
    stamps = [nanoseconds(message.header.stamp) for message in swim.received["head_pose"][before:]]
    assert stamps == sorted(set(stamps)), "two swims on one topic"
    clocks = {nanoseconds(message.clock) for message in swim.received["/clock"][-20:]}
    assert min(clocks) > 0, "the node that waits ticks /clock"
    swim.until(lambda: len(published("/second")) > looks, "another status of the second node")
    assert published("/second")[-1] == stands
    swim.close()
