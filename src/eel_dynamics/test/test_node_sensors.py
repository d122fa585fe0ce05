# SPDX-License-Identifier: Apache-2.0
"""Sensors of the node over DDS: readings as in the library, rates, latency, covariances, frames, what does not fit."""

import numpy as np
import pytest
from eel_dynamics.model.robot.joint_signs import message_signs
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.ros.messages import SampleMessages
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.sensors import SensorMessages
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from rclpy.serialization import deserialize_message
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import FluidPressure, Imu, JointState
from swim_client import LATCHED, LIMIT, LOSSLESS, nanoseconds
from tf2_msgs.msg import TFMessage

from eel_dynamics import Encoders, Scene, Simulation, simulate
from eel_dynamics import Imu as ImuSettings
from eel_gaits import backward, falling
from eel_msgs.msg import MotorStates

FAST = ("--ros-args", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
IMU = {
    "rate": 50.0,
    "seed": 3,
    "orientation": True,
    "accelerometer_noise": 0.02,
    "accelerometer_bias": (0.1, 0.0, -0.1),
    "gyroscope_noise": 0.001,
    "gyroscope_walk": 0.01,
    "orientation_noise": 0.005,
}
SAME = 1e-11  # round-off of the same sums in another order, on 10 m/s^2


def given(prefix, settings):
    """The settings of a kind of sensor as arguments of the node."""
    texts = {k: str(list(v)) if isinstance(v, tuple) else str(v).lower() for k, v in settings.items()}
    return [word for name, text in texts.items() for word in ("-p", f"{prefix}.{name}:={text}")]


def xyz(vector):
    return [vector.x, vector.y, vector.z]


def swum(start, swim, law, *arguments, last):
    """Runs the node to its end, under `law`; all messages of `last` have come."""
    node = start("dynamics", *FAST, *arguments)
    swim.until(lambda: swim.received["head_pose"], "sample 0")
    swim.laws.publish(law_to_message(law))
    assert node.wait(LIMIT) == 0
    topic, count = last
    swim.until(lambda: len(swim.received[topic]) >= count, f"{count} messages of {topic}")


def by_stamp(messages):
    """The last message of each stamp [ns]: sample 0 is repeated while the run stands at its start."""
    return {nanoseconds(message.header.stamp): message for message in messages}


def test_the_node_s_sensors_read_what_the_library_s_do(start, client):
    swim = client(topics=("head_pose",))
    kinds = {"imu_1": Imu, "imu_2": Imu, "pressure": FluidPressure, "depth": PoseWithCovarianceStamped}
    for topic, kind in (kinds | {"velocity": TwistWithCovarianceStamped}).items():
        swim.listen(topic, kind)
    pressure = {"rate": 20.0, "noise": 50.0, "stations": (0.25,), "seed": 4}
    velocity = {"rate": 10.0, "through_water": True, "noise": 0.01, "stations": (1.0,)}
    words = (
        *given("imu", IMU | {"stations": (0.6, 0.0)}),
        *given("pressure", pressure),
        *given("velocity", velocity),
    )
    where = ("-p", "scene.current:=[0.1, 0.05, 0.0]", "-p", "initial_position:=[0.0, 0.0, -2.0]", "-p", "duration:=1")
    swum(start, swim, falling(), *words, *where, last=("imu_2", 51))
    scene = Scene(current=(0.1, 0.05, 0.0))
    run = simulate(falling(), 1.0, scene=scene, position=(0, 0, -2), sample_period=0.01, estimate=False)
    for topic, station in (("imu_1", 0.6), ("imu_2", 0.0)):
        read, found = run.imu(station, **IMU), by_stamp(swim.received[topic])
        assert [*found] == [round(1e9 * t) for t in read.time]
        for row, message in enumerate(found.values()):
            assert xyz(message.linear_acceleration) == pytest.approx(read.specific_force[row], abs=SAME)
            assert xyz(message.angular_velocity) == pytest.approx(read.angular_velocity[row], abs=SAME)
            turn = message.orientation
            assert [*xyz(turn), turn.w] == pytest.approx(read.orientation[row], abs=SAME)
        assert message.header.frame_id == f"{topic}_link"
        assert message.linear_acceleration_covariance == pytest.approx(np.diag([0.02**2] * 3).ravel())
        assert message.angular_velocity_covariance == pytest.approx(np.diag([0.001**2] * 3).ravel())
        assert message.orientation_covariance == pytest.approx(np.diag([0.005**2] * 3).ravel())
    read, found = (
        run.pressure(0.25, **{k: v for k, v in pressure.items() if k != "stations"}),
        by_stamp(swim.received["pressure"]),
    )
    assert [each.fluid_pressure for each in found.values()] == pytest.approx(read.pressure, abs=1e-6)  # of 1e5
    assert {each.variance for each in found.values()} == {2500.0}
    depths = by_stamp(swim.received["depth"])
    assert [each.pose.pose.position.z for each in depths.values()] == pytest.approx(-read.depth, abs=1e-10)
    last = next(reversed(depths.values()))
    assert last.header.frame_id == "odom" and last.pose.covariance[14] == pytest.approx((50.0 / 9806.65) ** 2)
    assert last.pose.covariance[0] == 1e6 and last.pose.covariance[35] == 1e6
    read = run.velocity(1.0, rate=10.0, through_water=True, noise=0.01)
    found = by_stamp(swim.received["velocity"])
    assert len(found) == 11
    for row, message in enumerate(found.values()):
        assert xyz(message.twist.twist.linear) == pytest.approx(read.velocity[row], abs=SAME)
    assert message.twist.covariance[7] == pytest.approx(1e-4) and message.twist.covariance[35] == 1e6


def test_encoders_take_the_place_of_the_true_joints(start, client):
    swim, settings = client(topics=("head_pose",)), {"rate": 25.0, "resolution": 0.02, "rate_noise": 0.1}
    swim.listen("joint_states", JointState)
    swim.listen("motor_states", MotorStates)
    words = (*given("encoders", settings), "-p", "robot:=eight_servos", "-p", "duration:=0.4")
    swum(start, swim, backward(), *words, last=("motor_states", 11))
    run = simulate(backward(), 0.4, robot=robot_of("eight_servos"), sample_period=0.01, estimate=False)
    read, found = run.encoders(**settings), by_stamp(swim.received["joint_states"])
    assert [*found] == [round(1e9 * t) for t in read.time]
    for row, message in enumerate(found.values()):
        true = run.joint_rate[4 * row]
        assert message.position == pytest.approx(-read.angle[row], abs=1e-9)  # joints in yaw
        assert message.velocity == pytest.approx(read.rate[row] - true - true, abs=1e-6)  # noise has the topic's sign
    assert np.isnan(swim.received["motor_states"][-1].current).all()  # the ready robot has no torque constant


def test_a_late_message_has_the_stamp_of_its_reading(start, client):
    """20 Hz for 1 s, 0.055 s late: the reading at 0.95 s is due after the end."""
    swim = client(topics=("head_pose",))
    swim.listen("imu", Imu)
    words = ("-p", "imu.rate:=20", "-p", "imu.latency:=0.055", "-p", "duration:=1")
    swum(start, swim, falling(), *words, last=("imu", 19))
    assert [*by_stamp(swim.received["imu"])] == [50_000_000 * k for k in range(19)]
    read = simulate(falling(), 1.0, sample_period=0.01, estimate=False).imu(rate=20.0)
    assert xyz(swim.received["imu"][-1].linear_acceleration) == pytest.approx(read.specific_force[18], abs=SAME)
    assert swim.received["imu"][-1].orientation_covariance[0] == -1.0


def test_frames_of_sensors_are_still_where_the_body_is_rigid(start, client):
    swim = client(topics=("head_pose", "backbone"), namespace="eel1")
    swim.listen("/tf", TFMessage, LOSSLESS)
    swim.listen("/tf_static", TFMessage, LATCHED)
    words = ("-p", "imu.rate:=10", "-p", "imu.stations:=[0.0, 0.5]", "-p", "stations:=3", "-p", "duration:=1")
    names = ("-r", "__ns:=/eel1")
    swum(start, swim, falling(), *words, *names, "-p", "publish_tf:=false", last=("backbone", 101))
    still = {t.child_frame_id: t for each in swim.received["/tf_static"] for t in each.transforms}
    assert still.keys() == {"eel1/imu_1_link"} and still["eel1/imu_1_link"].header.frame_id == "eel1/base_link"
    moving = [t for each in swim.received["/tf"] for t in each.transforms]
    assert {(t.header.frame_id, t.child_frame_id) for t in moving} == {("eel1/base_link", "eel1/imu_2_link")}
    run = simulate(falling(), 1.0, stations=3, sample_period=0.01, estimate=False)
    head, section = Rotation.from_quat(run.orientation[-1]), Rotation.from_quat(run.section_orientation[-1, 1])
    last = moving[-1].transform
    assert xyz(last.translation) == pytest.approx(head.inv().apply(run.backbone[-1, 1] - run.position[-1]), abs=1e-9)
    turn = Rotation.from_quat([*xyz(last.rotation), last.rotation.w])
    assert (turn.inv() * head.inv() * section).magnitude() < 1e-9


def test_a_sensor_that_does_not_fit_is_refused_at_the_start_and_later(start, start_in_turn, client):
    cannot_be = {
        "imu.stations:=[1.5]": "imu stations must lie within 0 to 1 m, got 1.5 m",
        "imu.rate:=200.0": "imu rate must be at most the 100 Hz of the run, got 200 Hz",
        "imu.latency:=-0.1": "imu.latency must be >= 0 s, got -0.1",
        "imu.accelerometer_noise:=.nan": "imu.accelerometer_noise must be finite, got nan",
        "encoders.rate:=10.0": "encoders need a robot with joints",
    }
    on = ("-p", "imu.rate:=10.0")
    starts = [["--ros-args", *on, "-p", text] for text in cannot_be]
    for (status, said), expected in zip(
        start_in_turn("eel_dynamics.ros.node", starts), cannot_be.values(), strict=True
    ):
        assert status == 2 and said == f"dynamics: {expected}\n", said
    swim = client(topics=("head_pose",))
    start("dynamics", "--ros-args", *on)
    for text, expected in cannot_be.items():
        name, _, value = text.partition(":=")
        (result,) = swim.set(**{name: [1.5] if value == "[1.5]" else float(value.lstrip("."))})
        assert not result.successful and result.reason == expected
    swim.until(lambda: swim.received["head_pose"], "a sample: the node is up")


def sent(messages, simulation, samples):
    """(sample, topic, message's bytes) of what is due, of samples at 100 Hz."""
    found = []
    for k in samples:
        simulation.advance(k / 100)
        due = messages.due(simulation.observe(), k * 10_000_000)
        found += [(k, topic, bytes(message)) for topic, message in due]
    return found


def messages_of(settings, swimmer):
    parameters = DynamicsParameters()
    return SensorMessages(settings, swimmer, parameters, SampleMessages(swimmer, parameters))


def test_while_a_run_stands_at_its_start_readings_are_not_late():
    """Who commands by sensors alone starts the run by an answer to the first."""
    swimmer = Simulation(law=falling(), sensors=[0.0])
    messages = messages_of((ImuSettings(rate=50.0, latency=0.02),), swimmer)
    found = sent(messages, swimmer, [0, 0, *range(1, 8)])
    assert [(k, topic) for k, topic, _ in found] == [(0, "imu"), (0, "imu"), (4, "imu"), (6, "imu")]
    assert found[0] == found[1]


def test_a_reset_gives_the_same_readings_again():
    swimmer = Simulation(law=falling(), sensors=[0.0])
    walking = ImuSettings(rate=100.0, latency=0.03, gyroscope_noise=0.1, gyroscope_walk=0.1, seed=3)
    messages = messages_of((walking,), swimmer)
    first = sent(messages, swimmer, range(8))
    swimmer.reset()
    assert sent(messages, swimmer, range(8)) == first and len({each[2] for each in first}) == len(first) == 5


def test_the_bias_of_an_encoder_has_the_sign_of_its_topic():
    robot = robot_of("sixteen_servos")
    swimmer = Simulation(law=backward(), robot=robot)
    messages = messages_of((Encoders(rate=100.0, angle_bias=0.05),), swimmer)
    swimmer.advance(0.2)
    now = swimmer.observe()
    found = dict(messages.due(now, 200_000_000))
    position = deserialize_message(bytes(found["joint_states"]), JointState).position
    assert position == pytest.approx(message_signs(robot) * now.joints["joint_angle"] + 0.05, abs=1e-12)
