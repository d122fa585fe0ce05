# SPDX-License-Identifier: Apache-2.0
"""Publishes the made-up swimmer on the real topics, as fast as subscribers take it, and leaves; a process of its own.

Usage: fake_swimmer.py DURATION RATE STATIONS SUBSCRIBERS [RUNS]; prints one line with what it published.
"""

import sys
import time

import made_up
import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from eel_common.topics import OWN, SAMPLED, SENSORS
from eel_viz.bags.definitions import message_class
from eel_viz.recording.dispatcher import READERS
from geometry_msgs.msg import Vector3
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from eel_msgs.msg import BodyGeometry, CurvatureLaw

TOPICS = {topic: message_class(OWN[topic]) for topic in READERS if topic in SAMPLED and topic not in SENSORS}
EVERY = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1, reliability=ReliabilityPolicy.RELIABLE)
LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def messages(swimmer: made_up.Swimmer, nanoseconds: int) -> dict:
    """One sample, by topic."""
    t = nanoseconds * 1e-9
    stamp = Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
    out = {topic: kind() for topic, kind in TOPICS.items()}
    for message in out.values():
        message.header.stamp, message.header.frame_id = stamp, "odom"
    head = swimmer.head(t)
    for pose in (out["head_pose"].pose, out["odom"].pose.pose):
        pose.position.x, pose.position.y, pose.position.z = map(float, head["position"])
        o = pose.orientation
        o.x, o.y, o.z, o.w = map(float, head["orientation"])
    for twist in (out["head_twist"].twist, out["odom"].twist.twist):
        twist.linear.x, twist.linear.y, twist.linear.z = map(float, head["linear"])
        twist.angular.x, twist.angular.y, twist.angular.z = map(float, head["angular"])
    backbone = swimmer.backbone(t)
    out["backbone"].x = swimmer.x.tolist()
    out["backbone"].position = backbone["position"].ravel().tolist()
    out["backbone"].orientation = backbone["orientation"].ravel().tolist()
    for topic, values in (
        ("curvature", swimmer.curvature(t)),
        ("internal_wrench", swimmer.wrench(t)),
        ("hydrodynamic_load", swimmer.load(t)),
    ):
        for name, array in values.items():
            vector = name in ("tail_force", "nose_force", "wake_momentum_rate")
            setattr(out[topic], name, Vector3(x=array[0], y=array[1], z=array[2]) if vector else array.tolist())
    out["flow_vectors"].position = backbone["position"].ravel().tolist()
    out["flow_vectors"].velocity = swimmer.water(t).ravel().tolist()
    for name, value in swimmer.energy(t).items():
        setattr(out["energy"], name, float(value))
    return out


def body_message(stations: int) -> BodyGeometry:
    fields = made_up.body(stations)
    return BodyGeometry(
        **{name: value if isinstance(value, float) else value.tolist() for name, value in fields.items()}
    )


def arrived(*publishers) -> None:
    """Waits until their subscribers have all that was published; a node that is then told to end takes it in first."""
    for publisher in publishers:
        assert publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=90)), publisher.topic_name


def found(*publishers) -> None:
    """Waits until each has a subscriber."""
    limit = time.monotonic() + 90
    while min(publisher.get_subscription_count() for publisher in publishers) < 1:
        assert time.monotonic() < limit, "nobody listens"
        time.sleep(0.02)


def diagnostics(nanoseconds: int) -> DiagnosticArray:
    status = DiagnosticStatus(level=b"\0", name="/dynamics", message="running", hardware_id="simulation")
    status.values = [KeyValue(key="law", value="falling"), KeyValue(key="real_time_factor", value="0")]
    message = DiagnosticArray(status=[status])
    message.header.stamp = Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
    return message


def main() -> None:
    duration, rate = float(sys.argv[1]), float(sys.argv[2])
    stations, wanted = int(sys.argv[3]), int(sys.argv[4])
    runs = int(sys.argv[5]) if len(sys.argv) > 5 else 1
    rclpy.init()
    node = rclpy.create_node("dynamics")
    publishers = {topic: node.create_publisher(kind, topic, EVERY) for topic, kind in TOPICS.items()}
    latched = [(node.create_publisher(BodyGeometry, "body", LATCHED), body_message(stations))]
    latched.append((node.create_publisher(CurvatureLaw, "curvature_law", LATCHED), CurvatureLaw(name="falling")))
    status = node.create_publisher(DiagnosticArray, "/diagnostics", EVERY)
    for publisher, message in latched:
        publisher.publish(message)
    swimmer = made_up.Swimmer(stations)
    count = round(duration * rate) + 1
    samples = [messages(swimmer, round(k * 1e9 / rate)) for k in range(count)]
    limit = time.monotonic() + 90
    while min(publisher.get_subscription_count() for publisher in [*publishers.values(), status]) < wanted:
        assert time.monotonic() < limit, "no subscribers came"
        time.sleep(0.02)
    start = time.monotonic()
    for _ in range(runs):
        for k, sample in enumerate(samples):
            if k % round(rate) == 0:
                status.publish(diagnostics(round(k * 1e9 / rate)))
            for topic, message in sample.items():
                while True:
                    try:
                        publishers[topic].publish(message)
                        break
                    except rclpy._rclpy_pybind11.RCLError:
                        assert time.monotonic() < start + 120, f"{topic} is stuck"
                        time.sleep(0.002)
    for publisher in publishers.values():
        publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=90))
    print(f"published {count} samples {runs} times in {time.monotonic() - start:.2f} s", flush=True)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
