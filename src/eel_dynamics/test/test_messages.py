# SPDX-License-Identifier: Apache-2.0
"""Snapshots as messages: REP-103 axes where a message is in a ROS frame, section axes where it is not."""

import struct
from types import SimpleNamespace

import numpy as np
import pytest
from eel_common.ros.loop.serialised_message import MARKED_TIME, SerialisedMessage
from eel_common.topics import ENERGY_FIELDS
from eel_dynamics.accuracy.error_estimate import HeadErrors
from eel_dynamics.ros.inputs.law_messages import samples_from_message
from eel_dynamics.ros.messages import SampleMessages, body_message, diagnostic_array
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.simulation_from_parameters import simulation_from_parameters
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_gaits.gaits.settings import Settings
from eel_gaits.ros.messages import ROWS
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message, serialize_message

from eel_dynamics import Body, Fin, Robot, Scene, Simulation, simulate
from eel_gaits import Law, falling, straight
from eel_msgs.msg import CurvatureSamples

ERRORS = HeadErrors(relative=1e-5, position=2e-5, orientation=3e-5, velocity=4e-5, angular_velocity=5e-5)
SECTION_AXES = np.diag([-1.0, -1.0, 1.0])  # of a section turned as base_link


def matrix(quaternion):
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def xyz(vector):
    return np.array([vector.x, vector.y, vector.z])


def xyzw(quaternion):
    return np.array([quaternion.x, quaternion.y, quaternion.z, quaternion.w])


def filled(sample, name, snapshot):
    """The message of a topic as a subscriber gets it."""
    return deserialize_message(sample.fill(name, snapshot), sample.kinds[name])


def with_errors(simulation, errors):
    """What `SampleMessages` reads of a simulation whose errors are estimated."""
    water = simulation.water_at
    return SimpleNamespace(
        x=simulation.x, scene=simulation.scene, head_errors=errors, water_at=water, flow=None, robot=None, fins=()
    )


@pytest.fixture(scope="module")
def swum():
    """A snapshot in the middle of a turn in three dimensions, and the messages filled from it."""
    simulation = Simulation(stations=17, position=(0.3, -0.2, 0.1), orientation=(0.1, 0.2, 0.3, np.sqrt(0.86)))
    simulation.adopt(falling())
    simulation.advance(2.3)
    snapshot = simulation.observe()
    sample = SampleMessages(simulation, DynamicsParameters())
    assert np.isnan(filled(sample, "swim_state", snapshot).estimated_error)
    sample = SampleMessages(with_errors(simulation, ERRORS), DynamicsParameters())
    sample.set_time(2_300_000_000)
    return snapshot, {name: filled(sample, name, snapshot) for name in sample.kinds}


def test_headers(swum):
    _, messages = swum
    for name, message in messages.items():
        if name == "/tf":
            continue
        assert (message.header.stamp.sec, message.header.stamp.nanosec) == (2, 300_000_000)
        own_axes = {"curvature", "internal_wrench", "hydrodynamic_load"}
        frame = "section" if name in own_axes else "base_link" if name == "head_twist" else "odom"
        assert message.header.frame_id == frame, name
    assert messages["odom"].child_frame_id == "base_link"


def test_pose_is_that_of_the_library(swum):
    snapshot, messages = swum
    for pose in (messages["head_pose"].pose, messages["odom"].pose.pose):
        assert np.array_equal(xyz(pose.position), snapshot.position)
        assert np.array_equal(xyzw(pose.orientation), snapshot.orientation)


def test_twist_is_in_the_head_frame(swum):
    snapshot, messages = swum
    for twist in (messages["head_twist"].twist, messages["odom"].twist.twist):
        assert np.array_equal(xyz(twist.angular), snapshot.twist[:3])
        assert np.array_equal(xyz(twist.linear), snapshot.twist[3:])


def test_backbone_starts_at_the_head_and_runs_along_minus_x_of_its_sections(swum):
    snapshot, messages = swum
    points = np.reshape(messages["backbone"].position, (-1, 3))
    turns = np.reshape(messages["backbone"].orientation, (-1, 4))
    pose = messages["head_pose"].pose
    assert np.allclose(points[0], xyz(pose.position), rtol=0, atol=1e-15)
    assert np.allclose(matrix(turns[0]), matrix(xyzw(pose.orientation)), rtol=0, atol=1e-15)
    assert np.array_equal(points, snapshot.backbone)
    middle = len(points) // 2  # the chord through a section's neighbours is along its tangent, up to curvature squared
    chord = points[middle + 1] - points[middle - 1]
    ahead = matrix(turns[middle]) @ [1.0, 0.0, 0.0]
    assert np.dot(chord, ahead) / np.linalg.norm(chord) < -0.99


def test_profiles_keep_section_axes(swum):
    snapshot, messages = swum
    curvature, wrench, load = messages["curvature"], messages["internal_wrench"], messages["hydrodynamic_load"]
    for message in (curvature, wrench, load, messages["backbone"]):
        assert np.array_equal(message.x, snapshot.x)
    assert np.array_equal(curvature.pitch, snapshot.curvature[:, 1]) and np.array_equal(
        curvature.yaw, snapshot.curvature[:, 2]
    )
    assert np.array_equal(curvature.pitch_rate, snapshot.curvature_rate[:, 1])
    assert np.array_equal(curvature.yaw_rate, snapshot.curvature_rate[:, 2])
    for axis in range(3):
        assert np.array_equal(getattr(wrench, f"torque_{axis + 1}"), snapshot.torque[:, axis])
        assert np.array_equal(getattr(wrench, f"force_{axis + 1}"), snapshot.force[:, axis])
        assert np.array_equal(getattr(load, f"force_{axis + 1}"), snapshot.fluid_force[:, axis])
        assert np.array_equal(getattr(load, f"resistive_{axis + 1}"), snapshot.resistive_force[:, axis])
    assert np.array_equal(xyz(load.tail_force), snapshot.tail_force)
    assert np.array_equal(xyz(load.nose_force), snapshot.nose_force)
    assert np.array_equal(xyz(load.wake_momentum_rate), snapshot.wake_momentum_rate)
    assert np.any(curvature.yaw) and np.any(wrench.torque_3) and np.any(load.force_2)


def test_swim_state_repeats_the_other_topics_as_scalars(swum):
    snapshot, messages = swum
    state, pose, wrench = messages["swim_state"], messages["head_pose"].pose, messages["internal_wrench"]
    assert state.speed == pytest.approx(np.linalg.norm(xyz(messages["head_twist"].twist.linear)))
    assert state.depth == -pose.position.z
    ahead = matrix(xyzw(pose.orientation)) @ [1.0, 0.0, 0.0]
    assert np.allclose((np.cos(state.heading), np.sin(state.heading)), ahead[:2] / np.linalg.norm(ahead[:2]))
    assert state.greatest_torque == max(np.abs(getattr(wrench, f"torque_{axis}")).max() for axis in (1, 2, 3)) > 0.0
    assert state.actuator_work == snapshot.actuator_work and state.estimated_error == ERRORS.relative


def test_the_covariance_of_odom_is_the_square_of_the_estimated_errors_on_its_diagonal(swum):
    """In the order of geometry_msgs: x, y, z, and the rotations about them."""
    _, messages = swum
    for covariance, errors in (
        (messages["odom"].pose.covariance, (ERRORS.position, ERRORS.orientation)),
        (messages["odom"].twist.covariance, (ERRORS.velocity, ERRORS.angular_velocity)),
    ):
        assert np.array_equal(covariance.reshape(6, 6), np.diag(np.repeat(np.square(errors), 3)))


@pytest.mark.parametrize("unknown", [None, ERRORS._replace(position=np.inf)], ids=["off", "not known"])
def test_the_covariance_of_odom_begins_with_minus_1_where_the_errors_are_not_known(unknown):
    simulation = Simulation(law=falling())
    swimmer = with_errors(simulation, None)
    sample = SampleMessages(swimmer, DynamicsParameters())
    firsts = []
    for swimmer.head_errors in (ERRORS, unknown, ERRORS):
        odom = filled(sample, "odom", simulation.observe())
        firsts.append((odom.pose.covariance[0], odom.twist.covariance[0]))
        assert not np.any(np.tril(odom.pose.covariance.reshape(6, 6), -1))
    assert firsts == [(ERRORS.position**2, ERRORS.velocity**2), (-1.0, -1.0), (ERRORS.position**2, ERRORS.velocity**2)]


def test_joint_states_are_the_actuators_of_the_library():
    law, duration = falling(), 2.0
    run = simulate(law, duration=duration, sample_period=duration, accuracy="standard", estimate=False)
    simulation = Simulation(accuracy="standard")
    simulation.adopt(law)
    simulation.advance(duration)
    snapshot = simulation.observe()
    sample = SampleMessages(simulation, DynamicsParameters(yaw_joints=5, pitch_joints=3))
    message = filled(sample, "joint_states", snapshot)
    assert message.name == [*(f"yaw_{k}" for k in range(1, 6)), *(f"pitch_{k}" for k in range(1, 4))]
    yaw, pitch = run.actuators(5).yaw, run.actuators(3).pitch
    for field, name in (("position", "angle"), ("velocity", "speed"), ("effort", "torque")):
        expected = np.concatenate((getattr(yaw, name)[-1], -getattr(pitch, name)[-1]))  # about +z and +y
        assert np.allclose(getattr(message, field), expected, rtol=1e-6, atol=1e-9) and np.any(expected), field
    without = SampleMessages(Simulation(scene=Scene(internal_wrench=False)), DynamicsParameters(yaw_joints=1))
    assert not filled(without, "joint_states", snapshot).effort
    assert "joint_states" not in SampleMessages(simulation, DynamicsParameters()).kinds


def test_parts_of_a_robot_are_told_alike_by_node_and_library():
    robot = Robot.named("eight_servos").changed(torque_limit=0.3)
    fins = Fin.pair(0.2, 1e-3, 2.5, dihedral=0.2, angle=([0.0, 1.0], [0.0, 0.3]))
    for parts, topic, fields in (
        ({"robot": robot}, "motor_states", ("torque", "limit", "power")),
        ({"robot": robot}, "joint_states", ("position", "velocity", "effort")),
        ({"fins": fins}, "fin_states", ("position",)),
    ):
        scene = Scene(planar="robot" in parts)
        simulation = Simulation(accuracy="draft", scene=scene, law=straight(), **parts)
        simulation.advance(0.8)
        told = filled(SampleMessages(simulation, DynamicsParameters()), topic, simulation.observe())
        run = simulate(straight(), 0.8, accuracy="draft", scene=scene, sample_period=0.8, estimate=False, **parts)
        messages = dict(messages_of_run(run))
        for field in fields:
            assert np.allclose(getattr(told, field), getattr(messages[topic], field), rtol=1e-9, atol=1e-12), field
        assert list(told.name) == list(messages[topic].name) and len(told.name) == len(getattr(told, fields[0]))
        body = body_message(simulation, "section")
        for kind, names in (
            ("fins", ("name", "station", "side", "area", "span", "dihedral")),
            ("joints", ("name", "station", "axis", "sense")),
        ):
            for one, other in zip(getattr(body, kind), getattr(messages["body"], kind), strict=True):
                assert [getattr(one, name) for name in names] == [getattr(other, name) for name in names]
        assert (len(body.fins), len(body.joints)) == ((0, 8) if "robot" in parts else (2, 0))
        if topic == "fin_states":
            load = filled(SampleMessages(simulation, DynamicsParameters()), "hydrodynamic_load", simulation.observe())
            assert load.fin_name == told.name and len(load.fin_force) == 6 and any(load.fin_force)
        if topic == "motor_states":
            assert np.max(told.limit) == 0.3 and np.isclose(np.abs(told.torque), told.limit, rtol=1e-9).any()


def test_energy_has_every_field(swum):
    snapshot, messages = swum
    names = [name for name in messages["energy"].get_fields_and_field_types() if name != "header"]
    assert tuple(names) == ENERGY_FIELDS
    for name in names:
        assert getattr(messages["energy"], name) == getattr(snapshot.energy, name)


def test_messages_pass_through_the_wire_unchanged(swum):
    _, messages = swum
    for message in messages.values():
        assert deserialize_message(serialize_message(message), type(message)) == message


def test_refilling_replaces_all_that_was_there(swum):
    snapshot, messages = swum
    simulation = Simulation(stations=17)
    simulation.adopt(falling())
    sample = SampleMessages(with_errors(simulation, ERRORS), DynamicsParameters())
    for name in sample.kinds:
        sample.fill(name, simulation.observe())
    sample.set_time(2_300_000_000)
    for name in sample.kinds:
        assert filled(sample, name, snapshot) == messages[name], name


def test_what_the_scene_leaves_out_is_not_offered():
    kinds = SampleMessages(Simulation(scene=Scene(internal_wrench=False, ledger=False)), DynamicsParameters()).kinds
    assert "internal_wrench" not in kinds and "energy" not in kinds and "curvature" in kinds


def test_start_is_given_in_ros_frames_and_published_back():
    """What goes in comes out; swimming forward is along +x."""
    orientation = (0.1, -0.2, 0.3, np.sqrt(0.86))
    values = DynamicsParameters(
        initial_position=(1.0, 2.0, 3.0),
        initial_orientation=orientation,
        initial_linear_velocity=(0.4, 0.1, -0.2),
        initial_angular_velocity=(0.3, -0.5, 0.7),
    )
    simulation = simulation_from_parameters(values, Scene(current=(0.5, 0.25, 0.0)))
    assert simulation.scene.current == (0.5, 0.25, 0.0)
    snapshot = simulation.observe()
    assert snapshot.twist[3] == pytest.approx(0.4)
    sample = SampleMessages(simulation, DynamicsParameters())
    pose = filled(sample, "head_pose", snapshot).pose
    twist = filled(sample, "head_twist", snapshot).twist
    assert np.allclose(xyz(pose.position), (1.0, 2.0, 3.0), rtol=0, atol=1e-15)
    assert np.allclose(xyzw(pose.orientation), orientation, rtol=0, atol=1e-15)
    assert np.allclose(xyz(twist.linear), (0.4, 0.1, -0.2), rtol=0, atol=1e-12)
    assert np.allclose(xyz(twist.angular), (0.3, -0.5, 0.7), rtol=0, atol=1e-12)


def test_body_has_its_outline_and_mass():
    body = Body.boyer2010()
    message = body_message(Simulation(body=body, stations=11), "section")
    x = np.array(message.x)
    assert x[0] == 0.0 and x[-1] == body.length and np.all(np.diff(x) > 0.0)
    assert set(np.linspace(0.0, 1.0, 11)) <= set(x)
    assert message.mass == pytest.approx(1.944, abs=5e-4) and message.length == 1.0
    assert np.array_equal(message.half_width, body.half_width(x)) and np.array_equal(
        message.half_height, body.half_height(x)
    )
    assert body_message(Simulation(body=body, scene=Scene(density=500.0)), "section").mass == pytest.approx(
        0.5 * message.mass
    )


def test_samples_keep_their_names():
    message = CurvatureSamples(x=[0.0, 1.0], pitch=[1.0, 2.0], pitch_rate=[3.0, 4.0], pitch_accel=[5.0, 6.0])
    message.yaw, message.yaw_rate, message.yaw_accel = [7.0, 8.0], [9.0, 10.0], [11.0, 12.0]
    message.header.stamp.sec, message.header.stamp.nanosec = 3, 250_000_000
    for frame in ("", "section", *("s" * length for length in range(9))):
        message.header.frame_id = frame
        data = serialize_message(message)
        values = samples_from_message(data, 0.0)
        assert values["time"] == 3.25
        for name in ("x", "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"):
            assert list(values[name]) == list(getattr(message, name))


def test_samples_that_end_early_are_no_samples():
    message = CurvatureSamples(x=[0.0, 1.0], **{name: [1.0, 2.0] for name in ROWS})
    data = serialize_message(message)
    for end in range(2, len(data)):
        with pytest.raises(EOFError, match="ends before its fields"):
            samples_from_message(data[:end], 0.0)
    for encoding in (b"", b"\x00", b"\x00\x07"):
        with pytest.raises(ValueError, match="encoded in CDR, got encoding"):
            samples_from_message(encoding + data[2:] if len(encoding) == 2 else encoding, 0.0)
    message.pitch = []
    assert len(samples_from_message(serialize_message(message), 0.0)["pitch"]) == 0


def test_samples_of_a_machine_with_the_other_byte_order():
    numbers = [b"\x00\x00\x00\x00" + struct.pack(">iII", 3, 250_000_000, 0)]
    numbers += [struct.pack(">I4x2d" if k else ">I2d", 2, k, k + 1) for k in range(7)]
    values = samples_from_message(b"".join(numbers), 0.0)
    assert values["time"] == 3.25 and list(values["x"]) == [0.0, 1.0] and list(values["yaw_accel"]) == [6.0, 7.0]


def test_diagnostics_are_text():
    message = diagnostic_array(
        1.25, "/left/dynamics", 1, "late", {"law": "falling", "time": 1.25, "samples_published": 126}
    )
    status = message.status[0]
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1, 250_000_000)
    assert (status.level, status.name, status.message) == (b"\x01", "/left/dynamics", "late")
    assert {pair.key: pair.value for pair in status.values} == {
        "law": "falling",
        "time": "1.25",
        "samples_published": "126",
    }


def test_zero_is_never_minus_zero():
    simulation = Simulation(stations=5)
    simulation.adopt(Law(name="still"))
    sample = SampleMessages(simulation, DynamicsParameters())
    for name in ("head_pose", "head_twist", "odom"):
        assert "-0.0" not in repr(filled(sample, name, simulation.observe()))
    assert "-0.0" not in repr(list(filled(sample, "backbone", simulation.observe()).orientation))


def test_serialised_message_changes_as_its_fields_do():
    """Each number and the time at its own place, beside texts that move them off their multiples of eight."""
    message = Odometry(child_frame_id="a")
    message.header.frame_id = "world"
    wire = SerialisedMessage(message)
    values = np.random.default_rng(1).normal(size=(4, 4))
    pose, twist = message.pose.pose, message.twist.twist
    for target, names, path, row in (
        (pose.position, "xyz", "pose.pose.position", values[0, :3]),
        (pose.orientation, "xyzw", "pose.pose.orientation", values[1]),
        (twist.linear, "xyz", "twist.twist.linear", values[2, :3]),
        (twist.angular, "xyz", "twist.twist.angular", values[3, :3]),
    ):
        for name, value in zip(names, row, strict=True):
            setattr(target, name, value)
        wire.numbers[path][:] = row
    message.header.stamp.sec, message.header.stamp.nanosec = wire.stamps[0][:] = 7, 999_999_999
    assert deserialize_message(wire.data(), Odometry) == message


def test_a_message_whose_places_are_not_sure_is_refused():
    message = PoseStamped()
    message.header.frame_id = np.array(MARKED_TIME, dtype="<i4").tobytes().decode()  # looks like the time
    with pytest.raises(RuntimeError, match="PoseStamped is not serialised as it was expected"):
        SerialisedMessage(message)


def test_transforms_of_the_stations_turn_section_axes_into_the_world(swum):
    """What a listener to tf2 makes of a torque in section axes is the torque turned by the library."""
    snapshot, messages = swum
    assert [each.child_frame_id for each in messages["/tf"].transforms] == ["base_link"]
    x = snapshot.x
    parameters = DynamicsParameters(publish_tf_stations=True, section_frame="eel1/section", world_frame="eel1/odom")
    sample = SampleMessages(
        SimpleNamespace(x=x, scene=Scene(), head_errors=None, flow=None, robot=None, fins=()), parameters
    )
    sample.set_time(2_300_000_000)
    head, *stations = filled(sample, "/tf", snapshot).transforms
    assert head.child_frame_id == "base_link" and head.transform == messages["/tf"].transforms[0].transform
    assert [each.child_frame_id for each in stations] == [f"eel1/section_{k}" for k in range(len(x))]
    backbone = messages["backbone"]
    for k, each in enumerate(stations):
        assert (each.header.frame_id, each.header.stamp) == ("eel1/odom", messages["odom"].header.stamp)
        assert np.array_equal(xyz(each.transform.translation), backbone.position[3 * k : 3 * k + 3])
        turned = matrix(xyzw(each.transform.rotation)) @ snapshot.torque[k]
        expected = matrix(snapshot.section_orientation[k]) @ SECTION_AXES @ snapshot.torque[k]
        assert np.allclose(turned, expected, rtol=0, atol=1e-15)


def test_a_left_bend_of_the_gait_generator_swims_to_the_left():
    law = Settings(gait="turning", chosen={"left_bend": 0.5}).law()
    simulation = Simulation(accuracy="draft", stations=2)
    simulation.adopt(law)
    simulation.advance(4.0)
    sample = SampleMessages(simulation, DynamicsParameters())
    position = filled(sample, "head_pose", simulation.observe()).pose.position
    assert position.x > 0.5 and position.y > 0.2
