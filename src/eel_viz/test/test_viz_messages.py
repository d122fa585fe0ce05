# SPDX-License-Identifier: Apache-2.0
"""Messages to arrays: what fits comes through unchanged, what does not is refused with the field's name."""

import math
from types import SimpleNamespace

import made_up
import numpy as np
import pytest
from builtin_interfaces.msg import Time
from eel_common.topics import ENERGY_FIELDS, LATER_ENERGY_FIELDS
from eel_viz.messages import CURVATURE_FIELDS, WRENCH_FIELDS, BadMessage
from fake_swimmer import body_message, messages
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Header

from eel_viz import message_readers as reading

STAMP = 1_230_000_000


@pytest.fixture
def sent():
    return {**messages(made_up.Swimmer(11), STAMP), "body": body_message(11)}


READERS = {
    "head_pose": lambda message: reading.read_pose(message.pose),
    "head_twist": lambda message: reading.read_twist(message.twist),
    "odom": lambda message: (reading.read_pose(message.pose.pose), reading.read_twist(message.twist.twist)),
    "backbone": reading.read_backbone,
    "curvature": reading.read_curvature,
    "internal_wrench": reading.read_wrench,
    "hydrodynamic_load": reading.read_load,
    "flow_vectors": reading.read_flow,
    "energy": reading.read_energy,
    "body": reading.read_body,
}


def test_stamp(sent):
    assert reading.stamp_of(sent["backbone"]) == STAMP


@pytest.mark.parametrize(("sec", "nanosec"), [(-1, 0), (0, 10**9)])
def test_a_stamp_that_is_none_is_refused(sec, nanosec):
    message = PoseStamped(header=Header(stamp=Time(sec=sec, nanosec=nanosec)))
    with pytest.raises(reading.BadMessage, match=r"header.stamp must be >= 0 s with nanosec < 1e9"):
        reading.stamp_of(message)


def test_arrays_come_through_unchanged(sent):
    swimmer = made_up.Swimmer(11)
    backbone = reading.read_backbone(sent["backbone"])
    expected = swimmer.backbone(STAMP * 1e-9)
    for name in ("x", "position", "orientation"):
        np.testing.assert_array_equal(getattr(backbone, name), expected[name])
    for topic, fields, names in (
        ("internal_wrench", swimmer.wrench(STAMP * 1e-9), WRENCH_FIELDS),
        ("curvature", swimmer.curvature(STAMP * 1e-9), CURVATURE_FIELDS),
    ):
        profiles = READERS[topic](sent[topic])
        assert tuple(profiles.values) == names
        for name in names:
            np.testing.assert_array_equal(profiles.values[name], fields[name])
    load = reading.read_load(sent["hydrodynamic_load"])
    np.testing.assert_array_equal(load.tail, swimmer.load(STAMP * 1e-9)["tail_force"])
    np.testing.assert_array_equal(load.wake, swimmer.load(STAMP * 1e-9)["wake_momentum_rate"])
    np.testing.assert_array_equal(load.fins, swimmer.load(STAMP * 1e-9)["fin_force"])
    energy = swimmer.energy(STAMP * 1e-9)
    assert reading.read_energy(sent["energy"]) == energy
    older = SimpleNamespace(**{name: energy[name] for name in ENERGY_FIELDS if name not in LATER_ENERGY_FIELDS})
    assert reading.read_energy(older) == energy | dict.fromkeys(LATER_ENERGY_FIELDS, 0.0)
    head = swimmer.head(STAMP * 1e-9)
    pose, twist = READERS["odom"](sent["odom"])
    np.testing.assert_array_equal(pose.position, head["position"])
    np.testing.assert_array_equal(pose.orientation, head["orientation"])
    np.testing.assert_array_equal(twist.angular, head["angular"])
    body = reading.read_body(sent["body"])
    np.testing.assert_array_equal(body.half_height, made_up.body(11)["half_height"])


def set_at(message, path, value):
    *parents, last = path.split(".")
    for name in parents:
        message = getattr(message, name)
    if isinstance(last, str) and last.endswith("]"):
        name, _, index = last[:-1].partition("[")
        getattr(message, name)[int(index)] = value
    else:
        setattr(message, last, value)


BAD = [
    ("head_pose", "pose.position.x", math.nan, "position"),
    ("head_pose", "pose.orientation.w", 2.0, "orientation"),
    ("head_pose", "pose.orientation.x", math.nan, "orientation"),
    ("head_twist", "twist.linear.y", math.inf, "linear"),
    ("head_twist", "twist.angular.z", math.nan, "angular"),
    ("odom", "pose.pose.position.z", math.nan, "position"),
    ("backbone", "position[4]", math.nan, "position"),
    ("backbone", "orientation[3]", 0.2, "orientation"),
    ("backbone", "orientation", [0.0] * 44, "orientation"),
    ("backbone", "position", [0.0] * 30, "position"),
    ("backbone", "orientation", [0.0] * 4, "orientation"),
    ("backbone", "x[1]", 0.0, "x"),
    ("backbone", "x", [], "x"),
    ("backbone", "x", [0.0], "x"),
    ("curvature", "yaw", [0.0] * 10, "yaw"),
    ("curvature", "pitch_rate[0]", math.nan, "pitch_rate"),
    ("internal_wrench", "torque_3[10]", math.inf, "torque_3"),
    ("internal_wrench", "force_1", [], "force_1"),
    ("internal_wrench", "x[10]", math.nan, "x"),
    ("hydrodynamic_load", "resistive_2[5]", math.nan, "resistive_2"),
    ("hydrodynamic_load", "tail_force.x", math.nan, "tail_force"),
    ("hydrodynamic_load", "wake_momentum_rate.y", math.nan, "wake_momentum_rate"),
    ("flow_vectors", "velocity[4]", math.nan, "velocity"),
    ("flow_vectors", "velocity", [0.0] * 3, "velocity"),
    ("flow_vectors", "position", [0.0] * 4, "position"),
    ("hydrodynamic_load", "fin_force[1]", math.nan, "fin_force"),
    ("energy", "residual", math.nan, "residual"),
    ("energy", "flow_work", math.inf, "flow_work"),
    ("body", "half_width[3]", -0.01, "half_width"),
    ("body", "half_height[3]", math.nan, "half_height"),
    ("body", "half_height", [0.1], "half_height"),
    ("body", "length", 0.0, "length"),
    ("body", "mass", math.nan, "mass"),
]


@pytest.mark.parametrize(
    ("topic", "path", "value", "field"), BAD, ids=[f"{bad[0]}.{bad[1]}={bad[2]}"[:50] for bad in BAD]
)
def test_what_does_not_fit_is_refused_by_name(sent, topic, path, value, field):
    set_at(sent[topic], path, value)
    with pytest.raises(BadMessage, match=field) as problem:
        READERS[topic](sent[topic])
    assert problem.value.field == field


def test_a_backbone_of_two_points_is_read(sent):
    message = messages(made_up.Swimmer(2), STAMP)["backbone"]
    assert reading.read_backbone(message).position.shape == (2, 3)


def test_diagnostics_with_levels_as_bytes_or_numbers():
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

    values = [KeyValue(key="law", value="x"), KeyValue(key="", value="for which a recording has no place")]
    status = DiagnosticStatus(level=b"\2", name="/dynamics", message="stopped", values=values)
    (read,) = reading.read_diagnostics(DiagnosticArray(status=[status]))
    assert (read.name, read.level, read.message, read.values) == ("/dynamics", 2, "stopped", {"law": "x"})
