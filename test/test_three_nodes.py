# SPDX-License-Identifier: Apache-2.0
"""The suite as a user runs it: three processes over DDS, every topic recorded twice, compared with the library's run.

Messages and Rerun's scalars are double precision: equal but for the order of additions. Rerun's geometry is single
precision: 1e-6.
"""

from pathlib import Path

import numpy as np
import pytest
from run_of_three_nodes import DURATION, RATE, SAMPLES, STATIONS, stamps, swim

ROUND_OFF = 1e-11  # of the greatest value
SINGLE = 1e-6
SAMPLED = ("head_pose", "head_twist", "odom", "backbone", "curvature", "internal_wrench", "hydrodynamic_load", "energy")
SAMPLE_TIMES = np.array([round(k * 1e9 / RATE) for k in range(SAMPLES)])


@pytest.fixture(scope="module")
def results(start_for_module, tmp_path_factory):
    return swim(start_for_module, tmp_path_factory.mktemp("three_nodes"))


@pytest.fixture(scope="module")
def library():
    """The same run by the library."""
    from eel_dynamics import simulate
    from eel_gaits import falling

    options = {"sample_period": 1.0 / RATE, "stations": STATIONS, "load": True}
    return simulate(falling(), duration=DURATION, estimate=False, **options)  # settings of a run that stays as it is


def assert_same(values, expected, tolerance=ROUND_OFF):
    np.testing.assert_allclose(values, expected, rtol=0, atol=tolerance * max(np.abs(expected).max(), 1e-300))


def field(messages, name):
    return np.array([getattr(message, name) for message in messages])


def triple(vectors):
    return np.array([[v.x, v.y, v.z] for v in vectors])


def quadruple(quaternions):
    return np.array([[q.x, q.y, q.z, q.w] for q in quaternions])


@pytest.mark.parametrize("topic", SAMPLED)
def test_every_sample_is_in_the_bag(results, topic):
    np.testing.assert_array_equal(stamps(results.messages("/" + topic)), SAMPLE_TIMES)


def test_the_other_topics_are_in_the_bag(results):
    counts = results.topics()
    assert counts["/clock"] > SAMPLES / 2  # a recorder may match /clock after the first samples
    for topic in ("/body", "/curvature_law", "/diagnostics"):
        assert counts[topic] >= 1, topic


def test_pose_and_twist(results, library):
    poses = [message.pose for message in results.messages("/head_pose")]
    assert_same(triple([pose.position for pose in poses]), library.position)
    assert_same(quadruple([pose.orientation for pose in poses]), library.orientation)
    twists = [message.twist for message in results.messages("/head_twist")]
    assert_same(triple([twist.angular for twist in twists]), library.twist[:, :3])
    assert_same(triple([twist.linear for twist in twists]), library.twist[:, 3:])


def test_odometry_is_pose_and_twist(results):
    poses, twists, odometry = (results.messages(topic) for topic in ("/head_pose", "/head_twist", "/odom"))
    assert {(m.header.frame_id, m.child_frame_id) for m in odometry} == {("odom", "base_link")}
    for select, of_pose in ((triple, "position"), (quadruple, "orientation")):
        together, alone = (
            [getattr(p, of_pose) for p in group] for group in ([m.pose.pose for m in odometry], [m.pose for m in poses])
        )
        np.testing.assert_array_equal(select(together), select(alone))
    for of_twist in ("linear", "angular"):
        together, alone = (
            [getattr(t, of_twist) for t in group]
            for group in ([m.twist.twist for m in odometry], [m.twist for m in twists])
        )
        np.testing.assert_array_equal(triple(together), triple(alone))
    assert {m.header.frame_id for m in twists} == {"base_link"}


def test_shape(results, library):
    backbone, curvature = results.messages("/backbone"), results.messages("/curvature")
    assert_same(field(backbone, "position").reshape(SAMPLES, STATIONS, 3), library.backbone)
    assert_same(field(backbone, "orientation").reshape(SAMPLES, STATIONS, 4), library.section_orientation)
    for axis, name in ((1, "pitch"), (2, "yaw")):
        assert_same(field(curvature, name), library.curvature[:, :, axis])
        assert_same(field(curvature, f"{name}_rate"), library.curvature_rate[:, :, axis])


def test_internal_wrench(results, library):
    wrench = results.messages("/internal_wrench")
    assert_same(field(wrench, "x")[0], library.x)
    torque = np.stack([field(wrench, f"torque_{axis}") for axis in (1, 2, 3)], axis=-1)
    force = np.stack([field(wrench, f"force_{axis}") for axis in (1, 2, 3)], axis=-1)
    assert_same(torque, library.torque, 1e-10)
    assert_same(force, library.force, 1e-10)


def test_energy(results, library):
    ledgers = results.messages("/energy")
    for name in ("kinetic_body", "kinetic_fluid", "actuator_power", "wake_power", "nose_power", "drag_power"):
        assert_same(field(ledgers, name), getattr(library.energy, name), 1e-10)
    scale = np.abs(library.energy.kinetic_fluid).max()
    np.testing.assert_allclose(field(ledgers, "residual"), library.energy.residual, rtol=0, atol=1e-10 * scale)


def test_nothing_is_nan(results):
    for topic in SAMPLED:
        for message in results.messages("/" + topic):
            for name in message.__dataclass_fields__:
                value = getattr(message, name)
                if isinstance(value, np.ndarray | float):
                    assert np.all(np.isfinite(value)), f"{topic}.{name}"


def test_rerun_has_every_scalar(results, library):
    from eel_viz import entities

    expected = {
        entities.POSITION: library.position,
        entities.ORIENTATION: library.orientation,
        entities.LINEAR: library.twist[:, 3:],
        entities.ANGULAR: library.twist[:, :3],
        entities.SPEED: np.linalg.norm(library.twist[:, 3:], axis=1, keepdims=True),
        entities.KINETIC: np.stack([library.energy.kinetic_body, library.energy.kinetic_fluid], axis=1),
        entities.POWER: np.stack(
            [getattr(library.energy, f"{name}_power") for name in ("actuator", "wake", "nose", "drag")], axis=1
        ),
    }
    for path, values in expected.items():
        times, rows = results.column(path, "scalars")
        np.testing.assert_array_equal(times, SAMPLE_TIMES, err_msg=path)
        assert_same(np.array(rows), values, 1e-10)


def test_rerun_has_every_profile_as_the_messages_do(results):
    from eel_viz import entities

    topics = {
        entities.WRENCH_NUMBERS: (
            "/internal_wrench",
            ("torque_1", "torque_2", "torque_3", "force_1", "force_2", "force_3"),
        ),
        entities.CURVATURE_NUMBERS: ("/curvature", ("pitch", "pitch_rate", "yaw", "yaw_rate")),
        entities.LOAD_NUMBERS: (
            "/hydrodynamic_load",
            ("force_1", "force_2", "force_3", "resistive_1", "resistive_2", "resistive_3"),
        ),
    }
    for path, (topic, names) in topics.items():
        messages = results.messages(topic)
        for name in names:
            times, rows = results.column(path, name)
            np.testing.assert_array_equal(times, SAMPLE_TIMES, err_msg=path)
            np.testing.assert_array_equal(np.array(rows), field(messages, name), err_msg=f"{path} {name}")


def test_rerun_draws_every_backbone(results, library):
    from eel_viz import entities

    times, rows = results.column(entities.BACKBONE, "strips")
    np.testing.assert_array_equal(times, SAMPLE_TIMES)
    assert_same(np.array(rows).reshape(SAMPLES, STATIONS, 3), library.backbone, SINGLE)


def test_rerun_recording_carries_its_blueprint(results):
    from rerun.chunk import RrdReader

    reader = RrdReader(str(results.recording))
    assert len(list(reader.recordings())) == 1
    assert len(list(reader.blueprints())) >= 1


def test_the_bag_replayed_without_ros_is_the_recording_of_the_live_visualiser(results, tmp_path):
    """Every entity, every component, every time, bit by bit; but for texts, whose order among topics is chance."""
    from compared import contents, differences
    from eel_viz.bags.replay import main

    assert main([str(results.bag), "-o", str(tmp_path / "replayed.rrd")]) == 0
    assert differences(results.recording, tmp_path / "replayed.rrd") == []
    assert len(contents(tmp_path / "replayed.rrd")) > 150


@pytest.mark.timeout(300)
def test_the_bag_played_to_a_live_visualiser_is_shown_as_the_run_was(results, start, fresh_domain, tmp_path):
    from compared import differences

    node = start(
        "visualiser", "--ros-args", "-p", "sink:=[save]", "-p", f"recording:={tmp_path / 'played.rrd'}",
        "-p", "stop_with_publisher:=true",
    )  # fmt: skip
    player = start("python", str(Path(__file__).with_name("bag_player.py")), str(results.bag), "201")  # 2 s of each
    assert player.wait(150.0) == 0, player.output()
    assert node.wait(90.0) == 0, node.output()
    assert differences(results.recording, tmp_path / "played.rrd", until=2 * 10**9) == []
