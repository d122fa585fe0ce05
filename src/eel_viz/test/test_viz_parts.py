# SPDX-License-Identifier: Apache-2.0
"""Fins, joints and motors are drawn as they are, and a body without them shows none."""

from dataclasses import replace
from types import SimpleNamespace as NS

import made_up
import numpy as np
import pytest
from eel_common.attitude import section_axes
from eel_viz.message_readers import read_body, read_joints, read_motors
from eel_viz.messages import Backbone, BadMessage, Fin, Joint, Motors
from eel_viz.recording.dispatcher import Dispatcher
from eel_viz.recording.reading import read
from eel_viz.recording.recording_file import FileDestination
from eel_viz.recording.recordings import Recordings
from eel_viz.robots.part_shapes import AROUND, AXLE, EDGE, AppendageBalls, FinPlates, JointRings
from eel_viz.ros.marker_messages import FinMarker, JointMarkers
from eel_viz.scene3d import colours
from eel_viz.settings import Settings
from made_up_recording import body
from std_msgs.msg import Header

from eel_viz import entities

AREA, SPAN, DIHEDRAL = 2e-3, 0.05, 0.3  # m^2, m, rad
FINS = tuple(
    Fin(name=name, station=0.2, side=side, area=AREA, span=SPAN, dihedral=DIHEDRAL)
    for name, side in (("left_200", -1), ("right_200", 1))
)
JOINTS = (Joint(name="a", station=0.3, axis=3), Joint(name="b", station=0.5, axis=2))
MOTORS = Motors(torque=np.array([-1.0, 0.5]), limit=np.array([1.0, 2.0]), power=np.array([2.0, -0.5]))
STAMPS = tuple(range(0, 1_000_000_000, 100_000_000))  # ns


@pytest.fixture
def backbone():
    return Backbone(**made_up.Swimmer(201).backbone(0.7))


def test_a_fin_has_its_area_its_span_its_dihedral_and_its_angle(backbone):
    plates = FinPlates(replace(body(), fins=FINS))
    at = int(np.searchsorted(backbone.x, 0.2 - 1e-9))
    axes = section_axes(backbone.orientation[at])
    angle = 0.25
    vertices, normals = plates.place(backbone, np.array([angle, angle]))
    assert plates.triangles.shape == (2 * (EDGE - 1), 3)
    fans = vertices.astype(float)[plates.triangles].reshape(2, EDGE - 1, 3, 3)
    for k, fin in enumerate(FINS):
        edge, root = vertices[k * (EDGE + 1) : (k + 1) * (EDGE + 1) - 1].astype(float), vertices[k * (EDGE + 1) + EDGE]
        crossed = np.cross(fans[k, :, 1] - fans[k, :, 0], fans[k, :, 2] - fans[k, :, 0])
        assert 0.5 * np.linalg.norm(crossed, axis=1).sum() == pytest.approx(AREA, rel=0.02)  # of the polygon
        tip = (edge[EDGE // 2] - root) @ axes
        rising = np.sin(DIHEDRAL)
        np.testing.assert_allclose(tip, SPAN * np.array([0.0, fin.side * np.cos(DIHEDRAL), rising]), atol=1e-6)
        half_width = np.interp(0.2, body().x, body().half_width)
        np.testing.assert_allclose((root - backbone.position[at]) @ axes, [0.0, fin.side * half_width, 0.0], atol=1e-6)
        leading = (edge[-1] - root) @ axes
        assert leading[0] < 0.0 < leading[2]  # ahead, and risen
        assert np.arctan2(leading[2] / np.cos(DIHEDRAL), -leading[0]) == pytest.approx(angle, abs=1e-5)
        assert abs(normals[k * (EDGE + 1)].astype(float) @ (edge[3] - root)) < 1e-6


def test_a_ring_lies_about_the_body_and_its_axle_along_the_axis(backbone):
    rings = JointRings(replace(body(), joints=JOINTS)).place(backbone)
    for strip, joint in zip(rings, JOINTS, strict=True):
        at = int(np.searchsorted(backbone.x, joint.station - 1e-9))
        local = (strip - backbone.position[at]) @ section_axes(backbone.orientation[at])
        np.testing.assert_allclose(local[:, 0], 0.0, atol=1e-9)
        half = [np.interp(joint.station, body().x, row) for row in (body().half_width, body().half_height)]
        size = np.hypot(*(local[:, 1:] / half).T)
        far = size > 0.5 * (AROUND + AXLE)
        np.testing.assert_allclose(size[~far], AROUND, rtol=1e-9)
        np.testing.assert_allclose(size[far], AXLE, rtol=1e-9)
        assert far.sum() == 3 and np.abs(local[far, 4 - joint.axis]).max() < 1e-9


def test_an_appendage_is_a_ball_as_wide_as_its_drag_area_at_its_place(backbone):
    given = np.array([[0.2, 0.03, -0.04, 2e-3], [0.5, 0.0, 0.06, 0.0]])
    balls = AppendageBalls(replace(body(), appendages=given))
    for place, (x, right, up, _) in zip(balls.place(backbone), given, strict=True):
        at = int(np.searchsorted(backbone.x, x - 1e-9))
        local = (place - backbone.position[at]) @ section_axes(backbone.orientation[at])
        np.testing.assert_allclose(local, [0.0, right, up], atol=1e-9)
    np.testing.assert_allclose(np.pi * balls.radii.astype(float) ** 2, given[:, 3], rtol=1e-6)


def test_loads_are_shares_of_the_limit_and_red_at_the_limit_alone():
    motors = Motors(
        torque=np.array([0.0, -0.5, 0.999, 2.0, 0.1, 3.0]),
        limit=np.array([1.0, 1.0, 1.0, 2.0, 0.0, np.inf]),
        power=np.zeros(6),
    )
    loads = motors.loads
    np.testing.assert_allclose(loads, [0.0, 0.5, 0.999, 1.0, 1.0, np.nan])
    assert colours.load_index(loads).tolist() == [0, 127, 254, 255, 255, 0]
    assert tuple(colours.LOADS[255]) == colours.ACTUATORS


def message_of_parts(fins=FINS, joints=JOINTS, **changes):
    as_objects = {
        name: [NS(**{field: getattr(each, field) for field in each.__slots__}) for each in parts]
        for name, parts in (("fins", fins), ("joints", joints))
    }
    return NS(**made_up.body(), **as_objects | changes)


def record(path, *, parts, motors=MOTORS, early=0):
    """The made-up swimmer with or without parts, through the dispatcher; what was said.

    early: how many samples come before the body; after three a law is adopted.
    """
    said = []
    destination = FileDestination(Settings(recording=str(path)), said.append, said.append)
    recordings = Recordings([destination], name="eel", log_warning=said.append)
    dispatcher = Dispatcher(recordings, namespace="", log_warning=said.append)
    swimmer = made_up.Swimmer(51)
    for k, stamp in enumerate(STAMPS):
        if k == early:
            dispatcher.poll()
            hung = {"appendages": [0.2, 0.03, -0.04, 2e-3]}
            dispatcher.dispatch("body", message_of_parts(**hung) if parts else NS(**made_up.body()))
        if k == 3:
            dispatcher.dispatch("curvature_law", NS(name="in between"))
        header = NS(stamp=NS(sec=0, nanosec=stamp))
        line = swimmer.backbone(1e-9 * stamp)
        line |= {name: line[name].ravel() for name in ("position", "orientation")}
        dispatcher.dispatch("backbone", NS(header=header, **line))
        if parts:
            states = {"name": [fin.name for fin in FINS], "position": [0.1, 1e-9 * stamp]}
            dispatcher.dispatch("fin_states", NS(header=header, **states, velocity=[], effort=[]))
            states = {"name": ["a", "b"], "position": [0.1, 0.2], "velocity": [1.0, 2.0], "effort": [-1.0, 0.5]}
            dispatcher.dispatch("joint_states", NS(header=header, **states))
            rows = {name: getattr(motors, name) for name in ("torque", "limit", "power")}
            dispatcher.dispatch("motor_states", NS(header=header, **rows))
    dispatcher.finish()
    recordings.close()
    return said


@pytest.mark.parametrize("early", [0, 5])
def test_parts_are_recorded_at_every_sample(tmp_path, early):
    """Also of samples that come before the body, as where the network repeats it."""
    path = tmp_path / "parts.rrd"
    said = record(path, parts=True, early=early)
    assert len(said) == 1 and "saving to" in said[0]
    assert read(path, entities.FINS)["vertex_positions"].shape == (10, 2 * (EDGE + 1), 3)
    assert read(path, entities.APPENDAGES)["positions"].shape == (10, 1, 3)
    rings = read(path, entities.JOINTS)
    assert rings.stamps.tolist() == list(STAMPS)
    red, half = (np.array(rings["colors"])[-1] >> 8).tolist()
    assert red == int.from_bytes(bytes(colours.ACTUATORS), "big") and half != red
    assert (np.array(rings["radii"])[:, 0] < np.array(rings["radii"])[:, 1]).all()  # pixels, which count below zero
    np.testing.assert_allclose(read(path, entities.FIN_ANGLES)["scalars"][:, 1], np.degrees(1e-9 * np.array(STAMPS)))
    np.testing.assert_array_equal(read(path, entities.HARDEST_MOTOR)["scalars"], [[1.0, 1.0]] * 10)
    np.testing.assert_array_equal(read(path, entities.SATURATED)["scalars"], [[1.0]] * 10)
    np.testing.assert_array_equal(read(path, entities.MOTOR_POWER)["scalars"], [[1.5]] * 10)
    np.testing.assert_allclose(read(path, entities.MOTOR_WORK)["scalars"][:, 0], 1.5e-9 * np.array(STAMPS))
    numbers = read(path, entities.JOINT_NUMBERS)
    assert numbers["name"][0].tolist() == ["a", "b"] and numbers["effort"][-1].tolist() == [-1.0, 0.5]
    assert read(path, entities.MOTOR_NUMBERS)["limit"][-1].tolist() == [1.0, 2.0]
    log = read(path, entities.LOG)
    assert "in between" in str(log["text"][-1]) and log.stamps_of["text"][-1] == STAMPS[2]
    words = read(path, entities.LOOK, static=True)["text"][-1]
    assert "fins" in str(words) and "joints" in str(words)


def test_the_tab_of_motors_and_the_plot_of_fins_are_there_for_bodies_that_have_some(tmp_path):
    destination = FileDestination(Settings(recording=str(tmp_path / "run.rrd")), print, print)

    def tabs():
        return {each.name: each for each in destination.blueprint().root_container.contents}

    def plots_of_motion():
        _, right = tabs()["motion"].contents
        return [view.name for view in right.contents]

    assert "robot" not in tabs() and len(plots_of_motion()) == 3
    destination.adopt_body(None, replace(body(), fins=FINS))
    assert "robot" not in tabs() and plots_of_motion()[-1] == "Angles of the fins [deg]"
    destination.adopt_body(None, replace(body(), joints=JOINTS))
    assert list(tabs()) == ["overview", "torques", "motion", "robot", "swimmer"] and len(plots_of_motion()) == 3


def test_a_body_without_parts_shows_none(tmp_path):
    from rerun.chunk import RrdReader

    path = tmp_path / "eel.rrd"
    record(path, parts=False)
    there = {str(chunk.entity_path) for chunk in RrdReader(str(path)).stream()}
    parts = {entities.FINS, entities.JOINTS, entities.FIN_ANGLES, entities.HARDEST_MOTOR, entities.MOTOR_POWER}
    assert entities.BACKBONE in there and not parts & there
    assert not any(each.startswith(entities.LOAD_MAP) for each in there)


def test_motors_without_limits_are_shown_by_their_torque(tmp_path):
    path = tmp_path / "parts.rrd"
    record(path, parts=True, motors=replace(MOTORS, limit=np.full(2, np.inf)))
    np.testing.assert_array_equal(read(path, entities.HARDEST_MOTOR)["scalars"], [[1.0]] * 10)
    labels = read(path, f"{entities.LOAD_MAP}/frame/labels").values["labels"][-1]
    assert labels[3:5] == ["1", "N m"]


def test_fins_are_markers_too(backbone):
    states = read_joints(NS(name=["right_200", "left_200"], position=[0.1, -0.2]))
    fins = FinMarker(replace(body(), fins=FINS))
    (marker,) = fins.markers(Header(), backbone, states)
    plates = FinPlates(replace(body(), fins=FINS))
    vertices, _ = plates.place(backbone, np.array([-0.2, 0.1]))
    points = np.array([(point.x, point.y, point.z) for point in marker.points])
    corners = vertices[plates.triangles]
    np.testing.assert_allclose(points.reshape(2, -1, 3, 3), [corners, corners[:, ::-1]], rtol=1e-6)
    assert not fins.markers(Header(), backbone, read_joints(NS(name=["left_200"], position=[0.1])))


def test_joints_are_markers_in_the_colours_of_their_loads(backbone):
    robot = replace(body(), joints=JOINTS)
    first, second = JointMarkers(robot).markers(Header(), backbone, MOTORS)
    ring = JointRings(robot).place(backbone)[1]
    np.testing.assert_allclose([(point.x, point.y, point.z) for point in second.points], ring, rtol=1e-9)
    assert (first.color.r, first.color.g, first.color.b) == tuple(np.array(colours.ACTUATORS) / 255.0)
    assert second.color.r != first.color.r and first.id != second.id
    assert not JointMarkers(robot).markers(Header(), backbone, replace(MOTORS, torque=np.zeros(3)))


BAD = [
    (lambda: read_body(message_of_parts(appendages=[0.1, 0.0])), "appendages", "4 numbers"),
    (lambda: read_body(message_of_parts(appendages=[0.1, 0.0, 0.0, -1.0])), "appendages", "negative"),
    (lambda: read_body(message_of_parts(fins=[replace(FINS[0], station=1.5)])), "fins", "station"),
    (lambda: read_body(message_of_parts(fins=[replace(FINS[0], area=-1.0)])), "fins", "area"),
    (lambda: read_body(message_of_parts(fins=[replace(FINS[0], dihedral=np.nan)])), "fins", "dihedral"),
    (lambda: read_body(message_of_parts(fins=[replace(FINS[0], side=0)])), "fins", "side"),
    (lambda: read_body(message_of_parts(joints=[replace(JOINTS[0], axis=1)])), "joints", "axis 1"),
    (lambda: read_body(message_of_parts(joints=[replace(JOINTS[0], station=np.nan)])), "joints", "nan"),
    (lambda: read_body(message_of_parts(joints=JOINTS * 200)), "joints", "at most 256"),
    (lambda: read_joints(NS(name=["a"], position=[])), "position", "1 numbers to fit name"),
    (lambda: read_joints(NS(name=["a"], position=[np.inf])), "position", "not finite"),
    (lambda: read_joints(NS(name=["a"], position=[0.1], velocity=[1, 2])), "velocity", "got 2"),
    (lambda: read_motors(NS(torque=[1.0], limit=[np.nan], power=[1.0])), "limit", ">= 0"),
    (lambda: read_motors(NS(torque=[1.0], limit=[1.0], power=[])), "power", "fit torque"),
    (lambda: read_motors(NS(torque=[np.nan], limit=[1.0], power=[1.0])), "torque", "not finite"),
]


@pytest.mark.parametrize(("call", "field", "words"), BAD, ids=[f"{field}: {words}" for _, field, words in BAD])
def test_parts_that_do_not_fit_are_refused_by_name(call, field, words):
    with pytest.raises(BadMessage, match=words) as problem:
        call()
    assert problem.value.field == field
