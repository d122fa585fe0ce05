# SPDX-License-Identifier: Apache-2.0
"""Water that moves, over DDS: the parameter flow, the topics current and flow_at_head."""

import numpy as np
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import Vector3Stamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from swim_client import LIMIT, nanoseconds

from eel_dynamics import Scene, Shear, Simulation
from eel_gaits import straight
from eel_msgs.msg import FlowVectors

FAST = ("--ros-args", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
LAYER = Shear(velocity=(0.2, 0.0, 0.0), width=1.0, centre=(0.0, 0.3, 0.0))
CURRENT = (0.0, 0.1, 0.0)
SENSOR = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


def vector(message):
    return [getattr(message.vector, axis) for axis in "xyz"]


def seconds(message):
    return nanoseconds(message.header.stamp) / 1e9


class Sensor:
    """Publishes a current at simulation time, from the node's clock."""

    def __init__(self, swim, frame="odom"):
        self.swim, self.frame = swim, frame
        self._publisher = swim.node.create_publisher(Vector3Stamped, "current", SENSOR)

    def matched(self):
        return self._publisher.get_subscription_count() > 0

    def send(self, velocity, time=0.0):
        message = Vector3Stamped()
        message.header.frame_id = self.frame
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * 1e9), 1_000_000_000)
        message.vector.x, message.vector.y, message.vector.z = map(float, velocity)
        self._publisher.publish(message)


def test_a_swimmer_in_the_flow_of_a_parameter_swims_as_in_the_library(start, client):
    swim = client(topics=("head_pose",))
    swim.listen("flow_at_head", Vector3Stamped)
    swim.listen("flow_vectors", FlowVectors)
    text = "shear velocity=0.2,0,0 width=1.0 centre=0,0.3,0"
    node = start("dynamics", *FAST, "-p", f"flow:={text}", "-p", "scene.current:=[0.0, 0.1, 0.0]", "-p", "duration:=1")
    swim.until(lambda: all(map(swim.received.get, ("head_pose", "flow_at_head", "flow_vectors"))), "sample 0 of each")
    swim.laws.publish(law_to_message(straight()))
    assert node.wait(LIMIT) == 0  # its subscribers have everything then
    topics = "head_pose", "flow_at_head", "flow_vectors"
    swim.until(lambda: all(len(swim.received[topic]) >= 101 for topic in topics), "101 samples of each topic")
    poses, water = swim.received["head_pose"], {seconds(m): vector(m) for m in swim.received["flow_at_head"]}
    for pose in poses[1:]:
        place = [getattr(pose.pose.position, axis) for axis in "xyz"]
        assert np.allclose(water[seconds(pose)], LAYER.sample(place).velocity + np.array(CURRENT), atol=1e-12)
    for message in swim.received["flow_vectors"][-3:]:
        points, velocity = (np.array(part).reshape(-1, 3) for part in (message.position, message.velocity))
        assert np.allclose(velocity, LAYER.sample(points).velocity + np.array(CURRENT)) and np.ptp(points[:, 2]) == 0.0
    library = Simulation(law=straight(), flow=LAYER, scene=Scene(current=CURRENT))
    library.advance(1.0)
    assert np.allclose(place, library.head.position, atol=1e-5)


def test_a_scene_s_file_gives_the_node_its_flow(start, client, tmp_path):
    path = tmp_path / "swim.yaml"
    path.write_text(
        "/**: {ros__parameters: {flow: {kind: Shear, velocity: [0.2, 0.0, 0.0], width: 1.0, centre: [0.0, 0.3, 0.0]}}}"
    )
    swim = client(topics=("head_pose",))
    start("dynamics", "--ros-args", "--params-file", str(path))
    assert swim.get("flow") == [
        "shear velocity=0.2,0.0,0.0 across=0.0,1.0,0.0 centre=0.0,0.3,0.0 width=1.0 profile=tanh"
    ]


def test_a_flow_that_does_not_fit_is_refused_at_the_start_and_later(start, start_in_turn, client):
    cannot_be = "maelstrom", "shear width=0", "nowhere.nc"
    for status, said in start_in_turn(
        "eel_dynamics.ros.node", [["--ros-args", "-p", f"flow:={text}"] for text in cannot_be]
    ):
        assert status == 2 and said.startswith("dynamics: ") and said.count("\n") == 1, said
    swim = client(topics=())
    start("dynamics", "--ros-args")
    for text in cannot_be:
        (result,) = swim.set(flow=text)
        assert not result.successful and ("flow" in result.reason or "width" in result.reason)
    (result,) = swim.set(flow="shear width=2.0")
    assert result.successful and swim.get("flow") == ["shear width=2.0"]
    assert swim.reset().success


def test_a_current_is_followed_held_when_it_stops_and_told(start, client):
    """Neutral, without law-driven motion: the straight body is carried with the water."""
    swim = client(topics=("head_pose", "head_twist"))
    swim.listen("flow_at_head", Vector3Stamped)
    swim.laws.publish(law_to_message(straight(amplitude_0=0.0, amplitude_1=0.0, amplitude_2=0.0)))
    node = start("dynamics", "--ros-args", "-p", "default_transition:=0.3")
    sensor = Sensor(swim)
    swim.until(sensor.matched, "subscription")
    swim.until_time(0.05)
    sent = []

    def send():
        now = seconds(swim.received["head_pose"][-1])
        if not sent or now - sent[-1] >= 0.1:
            sensor.send((0.2, 0.1 * now, 0.0), now)
            sent.append(now)
        return now > 2.0

    swim.until(send, "two seconds")
    node.wait_for_output("no current since t", LIMIT)
    node.wait_for_output("is held", LIMIT)
    stopped = seconds(swim.received["head_pose"][-1])
    swim.until_time(stopped + 0.3, "head_pose", "head_twist", "flow_at_head")
    water = np.array([[seconds(m), *vector(m)] for m in swim.received["flow_at_head"]])
    assert np.allclose(water[-1, 1:], [0.2, 0.1 * sent[-1], 0.0], atol=1e-12)
    water = water[np.r_[True, np.diff(water[:, 0]) > 0.0]]  # sample 0 is repeated
    rates = np.diff(water[:, 1:], axis=0) / np.diff(water[:, :1], axis=0)
    assert np.abs(rates).max() < 1.5 * 0.2 / 0.1  # no jump: what is left at the second sample is caught up by a cubic
    followed = water[(water[:, 0] > 1.0) & (water[:, 0] < sent[-1])]
    behind = np.diff(sent).max() + 0.4  # s; 0.1 s are meant to lie between two samples, a busy machine sends them later
    assert np.abs(followed[:, 2] - 0.1 * followed[:, 0]).max() < 0.1 * behind
    twist = swim.received["head_twist"][-1].twist.linear
    assert np.allclose([twist.x, twist.y, twist.z], water[-1, 1:], atol=0.01)

    def back():
        sensor.send((0.0, 0.0, 0.0), seconds(swim.received["head_pose"][-1]))  # best-effort: one may be lost
        return "current is back" in node.output()

    swim.until(back, "the current's return")


def test_a_current_in_another_frame_or_with_nan_is_left_out(start, client):
    swim = client(topics=("head_pose",))
    swim.listen("flow_at_head", Vector3Stamped)
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", "--ros-args")
    wrong, sensor = Sensor(swim, "base_link"), Sensor(swim, "")
    swim.until(lambda: wrong.matched() and sensor.matched(), "subscriptions")

    def told(text, publisher, velocity):
        publisher.send(velocity)  # best-effort: one may be lost while the two find each other
        return text in node.output()

    swim.until(lambda: told("header.frame_id must be odom, got 'base_link'", wrong, (1.0, 0.0, 0.0)), "refusal")
    swim.until(lambda: told("current velocity must be finite", sensor, (np.nan, 0.0, 0.0)), "refusal")
    now = seconds(swim.latest("head_pose"))
    swim.until_time(now + 0.2, "flow_at_head")
    assert vector(swim.received["flow_at_head"][-1]) == [0.0, 0.0, 0.0]


def test_a_node_whose_swimmer_leaves_a_grid_says_where_and_serves_a_reset(start, client, tmp_path):
    from scipy.io import netcdf_file

    with netcdf_file(tmp_path / "tank.nc", "w") as file:
        for name in "xy":
            file.createDimension(name, 3)
            file.createVariable(name, "d", (name,))[:] = [-1.5, -0.5, 0.2]
        for name in "uv":
            file.createVariable(name, "d", ("x", "y"))[:] = 0.5 * (name == "u")
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", "--ros-args", "-p", f"flow:={tmp_path}/tank.nc")
    node.wait_for_output("the swimmer has left the grid of the flow at (0.2", LIMIT)
    assert swim.reset().success
