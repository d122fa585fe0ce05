# SPDX-License-Identifier: Apache-2.0
"""A swimmer as a URDF: its masses are the body's, it bends as the swimmer does, and read again it swims alike."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from eel_dynamics.commands.urdf import main
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.inertia import straight_inertia
from eel_dynamics.model.robot.joint_signs import message_limits, message_signs, sense_of
from eel_dynamics.model.robot.ready import READY
from eel_dynamics.model.section_data import sections_of
from random_bodies import drawn_body
from random_robots import drawn
from scipy.spatial.transform import Rotation
from urdf_frames import frames, masses, vector

from eel_dynamics import Body, Fin, Joint, Muscle, PassiveTail, Robot, Scene, Servo, Torque, simulate, urdf_of
from eel_gaits import Law, Term

WAVE = Law(Term(axis="yaw", amplitude=(0.5, 2.0), wavelength=1.0, period=1.0))
WAVES = Law(*WAVE.terms, Term(axis="pitch", amplitude=(0.5, 1.0), wavelength=1.0, period=1.3))
HINGE = 0.06  # m, of the ready robots
LOADED = Body.of_links(
    1.2, 6, 0.03, 0.04, joints="flush", mass_per_length=lambda x: 2.0 + x, centre_of_mass_offset=0.01
)
DRAWN = drawn_body(np.random.default_rng(4))
BODIES = {
    "the paper's": Body.boyer2010(),
    "Kern's": Body.kern2006(0.8),
    "loaded off its axis": LOADED,
    "from data": DRAWN.data,
}


def composite(text):
    """Inertia (6, 6) of all links together about the base link, rotation first, in its axes."""
    total = np.zeros((6, 6))
    for mass, c, inertia in masses(text).values():
        cross = np.array([[0.0, -c[2], c[1]], [c[2], 0.0, -c[0]], [-c[1], c[0], 0.0]])
        total[:3, :3] += inertia - mass * cross @ cross
        total[:3, 3:] += mass * cross
        total[3:, :3] -= mass * cross
        total[3:, 3:] += mass * np.eye(3)
    return total


def of_mechanics(body, density=None):
    """The same of the straight body that the mechanics march, without its water."""
    grid = Grid.of(panels_of(body, resolution=200))
    sections = sections_of(body, Scene(density=density, reactive=False), grid.x)
    matrix = straight_inertia(grid, sections, 0.0, 1.0, offset=body.offset)
    turn = np.array([-1.0, -1.0, 1.0] * 2)  # from section axes
    return matrix * np.outer(turn, turn)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("joints", [{}, {"yaw_joints": 7}, {"yaw_joints": 9, "pitch_joints": 4}], ids=str)
def test_masses_and_inertias_of_the_links_are_those_of_the_body(name, joints):
    body = BODIES[name]
    text = urdf_of(body, **joints).text
    links = masses(text)
    assert len(links) == 1 + sum(joints.values())
    assert sum(link.mass for link in links.values()) == pytest.approx(body.mass, rel=1e-12)
    whole = composite(text)
    exact = DRAWN.cut if body is DRAWN.data else body  # the same body, with a kink at each data point
    assert np.allclose(whole, of_mechanics(exact), rtol=0.0, atol=1e-9 * whole[3, 3])
    for link in links.values():
        least, middle, most = np.linalg.eigvalsh(link.inertia)
        assert least > 0.0 and most <= (least + middle) * (1.0 + 1e-9)


def test_a_density_of_the_scene_weighs():
    body = Body.boyer2010()
    whole = composite(urdf_of(body, yaw_joints=3, density=2000.0).text)
    assert whole[3, 3] == pytest.approx(2000.0 * body.volume, rel=1e-12)
    assert np.allclose(whole, of_mechanics(body, 2000.0), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "law", "near", "turn"),
    [("eight_servos", WAVE, 0.002, 1e-12), ("sixteen_servos", WAVES, 0.006, 0.07)],
)
def test_links_lie_where_the_sections_of_the_swimmer_lie(name, law, near, turn):
    """A hinge stands for an arc. In a universal joint the turns follow one another, and those of the arc do not: half
    of their product, 0.04 rad at most in a joint here, is roll."""
    robot = Robot.named(name)
    text = urdf_of(robot=robot).text
    places = np.array([joint.position for joint in robot.joints])
    x = np.concatenate(
        ([0.0], np.unique(places) + 0.5 * HINGE, [1.0])
    )  # the first rigid section of each link, and the tail
    run = simulate(law, 1.5, robot=robot, accuracy="draft", stations=x, sample_period=0.1)
    _, links = np.unique(places[::-1], return_index=True)
    links = len(places) - links  # the last of those that begin at one place
    far = angle = 0.0
    for k in range(len(run.time)):
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = Rotation.from_quat(run.orientation[k]).as_matrix(), run.position[k]
        angles = zip((joint.name for joint in robot.joints), message_signs(robot) * run.joint_angle[k], strict=True)
        poses = frames(text, dict(angles), base)
        for station, link in enumerate([*links, links[-1]], start=1):
            pose = poses[f"link_{link}"]
            behind = x[station] - places[link - 1]
            section = Rotation.from_quat(run.section_orientation[k, station]).as_matrix()
            far = max(far, np.linalg.norm(pose[:3, 3] - behind * pose[:3, 0] - run.backbone[k, station]))
            angle = max(angle, Rotation.from_matrix(pose[:3, :3].T @ section).magnitude())
    assert np.abs(run.joint_angle).max() > 0.25
    assert far < near and angle < turn


def read_again(tmp_path, urdf, **options):
    path = tmp_path / "eel.urdf"
    path.write_text(urdf.text)
    return Robot.from_file(path, **{"joints": "flush"} | options)


@pytest.mark.parametrize("name", [name for name in READY if name != "passive_tail"])
def test_a_robot_that_is_read_again_is_the_same_but_for_what_is_told(tmp_path, name):
    """With the servo's gains, and the body in place of one of boxes: the same swim."""
    robot = Robot.named(name)
    servo, law = robot.servos[0], WAVES if name == "sixteen_servos" else WAVE
    urdf = urdf_of(robot=robot)
    read = read_again(tmp_path, urdf, servo=replace(servo, torque_limit=None, speed_limit=None))
    assert read.name == name and urdf.left_out == (
        f"kp, kd, gear, rotor_inertia{', series_stiffness' if name == 'series_elastic' else ''} of servos",
    )
    assert read.body.mass == pytest.approx(Body.boyer2010().mass, rel=1e-12) and read.body.length == 1.0
    for one, other in zip(robot.joints, read.joints, strict=True):
        assert (one.name, one.component, sense_of(one.axis)) == (other.name, other.component, sense_of(other.axis))
        assert other.position == pytest.approx(one.position, rel=1e-14)
        limits = one.actuator.torque_limit, one.actuator.speed_limit
        assert (other.actuator.torque_limit, other.actuator.speed_limit) == pytest.approx(limits, rel=1e-14)
    options = {"body": Body.boyer2010(), "accuracy": "draft", "sample_period": 0.1}
    swims = [simulate(law, 1.0, robot=each, **options) for each in (robot, read)]
    assert np.abs(swims[0].position).max() > 0.01
    for quantity in ("position", "backbone", "torque"):
        one, other = (getattr(swim, quantity) for swim in swims)
        assert np.allclose(one, other, rtol=0.0, atol=1e-9), quantity


@pytest.mark.parametrize("seed", range(12))
def test_random_robots_keep_joints_stops_and_limits(tmp_path, seed):
    draw = drawn(seed)
    robot, body = draw.robot, Body.boyer2010()
    urdf = urdf_of(body, robot, density=draw.scene.density)
    whole = composite(urdf.text)
    assert np.allclose(whole, of_mechanics(body, draw.scene.density), rtol=0.0, atol=1e-9 * whole[3, 3])
    read = read_again(tmp_path, urdf)
    assert read.body.mass == pytest.approx(body.mass_in(draw.scene.density), rel=1e-12)
    for one, other in zip(robot.joints, read.joints, strict=True):
        assert (one.name, one.component, one.damping) == (other.name, other.component, pytest.approx(other.damping))
        assert other.position == pytest.approx(one.position, rel=1e-13)
        assert (one.limits is None) == (other.limits is None)
        if one.limits is not None:
            assert other.limits == pytest.approx(message_limits(one))
        if one.actuator is not None:
            limits = (one.actuator.torque_limit, one.actuator.speed_limit)
            assert (other.actuator.torque_limit, other.actuator.speed_limit) == pytest.approx(limits)
    for part in robot.parts:
        if isinstance(part, PassiveTail):
            assert any(repr(part.name) in each for each in urdf.left_out)


def test_what_a_urdf_has_no_word_for_is_told_and_stands_in_a_comment():
    robot = Robot(
        [
            Joint(0.2, actuator=Servo(friction=0.1), name="a--b"),
            Joint(0.3, actuator=Torque((0.0, 1.0), (0.0, 1.0)), stiffness=2.0),
            Muscle(0.4, 0.5, 1.0, 0.1, moment=Law(Term(axis="yaw", amplitude=(1.0,), wavelength=1.0, period=1.0))),
            PassiveTail(0.6, 0.3, name="rear---"),
        ]
    )
    text, left_out = urdf_of(
        robot=robot, fins=(Fin(side="left", station=0.5, area=0.001, aspect_ratio=2.0, name="left"),)
    )
    assert left_out == (
        "muscle 'muscle' bends behind X = 0.4 m",
        "passive tail 'rear---' bends behind X = 0.6 m",
        "joint 'joint_2': its torque over time",
        "stiffness of joints",
        "kp, kd, friction of servos",
        "fin 'left'",
    )
    comment = re.search("<!--(.*)-->", text)[1]
    assert all(each.replace("---", "- - -") in comment for each in left_out)
    root = ElementTree.fromstring(text)
    assert [joint.get("name") for joint in root.findall("joint")] == ["head_joint", "a--b", "joint_2"]


def test_joints_without_motors_stops_and_limits_have_none():
    robot = Robot(
        [
            Joint(0.2),
            Joint(0.4, limits=(-0.5, 0.3), damping=0.1, actuator=Servo()),
            Joint(0.6, actuator=Servo(torque_limit=2.0)),
        ]
    )
    joints = ElementTree.fromstring(urdf_of(robot=robot).text).findall("joint")[1:]
    assert [joint.get("type") for joint in joints] == ["continuous", "revolute", "continuous"]
    limits = [joint.find("limit").attrib for joint in joints]
    assert [(limit["effort"], limit["velocity"]) for limit in limits] == [
        ("0", "1000000"),
        ("1000000", "1000000"),
        ("2", "1000000"),
    ]
    assert joints[1].find("dynamics").get("damping") == "0.1"
    assert (limits[1]["lower"], limits[1]["upper"]) == ("-0.3", "0.5")  # about +z, to the right


def test_boxes_are_as_wide_and_high_as_the_body():
    body = LOADED
    root = ElementTree.fromstring(urdf_of(body, yaw_joints=5).text)
    for link in root.findall("link")[1:]:
        for box in link.iter("box"):
            assert vector(box, "size")[1:] == pytest.approx([0.06, 0.08])
        looks, (bumper,) = (link.findall(tag) for tag in ("visual", "collision"))
        lengths = [vector(each.find("geometry/box"), "size")[0] for each in looks]
        assert sum(lengths) == pytest.approx(vector(bumper.find("geometry/box"), "size")[0], rel=1e-4)


def test_links_are_named_below_the_namespace_of_the_head():
    root = ElementTree.fromstring(urdf_of(yaw_joints=2, base_link="eel1/base_link").text)
    names = [link.get("name") for link in root.findall("link")]
    assert names == ["eel1/base_link", "eel1/link_0", "eel1/link_1", "eel1/link_2"]
    assert [joint.get("name") for joint in root.findall("joint")] == ["head_joint", "yaw_1", "yaw_2"]


def test_frames_of_sensors_lie_at_their_stations_on_the_link_that_is_there(tmp_path):
    robot, given = Robot.named("sixteen_servos"), {"imu": 0.05, "camera": 0.0, "dvl": 0.25, "tip": 1.0}
    urdf = urdf_of(robot=robot, frames=given)
    places = frames(urdf.text, dict.fromkeys((joint.name for joint in robot.joints), 0.0))
    for name, x in given.items():
        assert places[name] == pytest.approx(np.array([[1, 0, 0, -x], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]))
    joints = ElementTree.fromstring(urdf.text).findall("joint")
    parents = {each.find("child").get("link"): each.find("parent").get("link") for each in joints}
    assert [parents[name] for name in given] == ["link_0", "link_0", "link_4", "link_16"]
    assert len(read_again(tmp_path, urdf).joints) == 16


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"yaw_joints": 1.5}, "yaw_joints must be a whole number, 0 to 1000, got 1.5"),
        ({"pitch_joints": -1}, "pitch_joints must be a whole number, 0 to 1000, got -1"),
        ({"yaw_joints": 2, "robot": Robot.named("eight_servos")}, "yaw_joints must be 0 with a robot"),
        ({"robot": Robot([Joint(2.0)])}, "'joint_1' position and width must lie inside (0, 1) m"),
        ({"robot": "eight_servos"}, "robot must be a Robot, got 'eight_servos'"),
        ({"body": "boyer2010"}, "body must be a Body, got 'boyer2010'"),
        ({"density": -1.0}, "density must be > 0"),
        ({"base_link": "link_0"}, "each link in a URDF must have a name of its own, got 'link_0' twice"),
        ({"frames": {"base_link": 0.1}}, "each link in a URDF must have a name of its own, got 'base_link' twice"),
        ({"frames": {"imu": 1.5}}, "frame 'imu' must be <= 1 m, got 1.5"),
        ({"frames": [("imu", 0.5)]}, "frames must be a Mapping"),
        ({"base_link": ""}, "names in a URDF must be texts that XML can hold, got ''"),
        ({"robot": Robot([Joint(0.5, name="a\0")])}, r"names in a URDF must be texts that XML can hold, got 'a\x00'"),
    ],
)
def test_what_cannot_be_written_is_one_error(given, told):
    with pytest.raises(ValueError) as refused:
        urdf_of(**given)
    assert told in str(refused.value)


def test_the_command_prints_the_urdf_and_tells_what_it_left_out(capsys):
    assert main(["--robot", "eight_servos", "--scene", "density=900"]) == 0
    out, err = capsys.readouterr()
    assert out == urdf_of(robot=Robot.named("eight_servos"), density=900.0).text
    assert err == "eel urdf: left out: kp, kd, gear, rotor_inertia of servos\n"
    assert main(["--body", "kern2006", "--yaw-joints", "4", "--frame", "eye=0.02"]) == 0
    out, err = capsys.readouterr()
    assert out == urdf_of(Body.kern2006(), yaw_joints=4, frames={"eye": 0.02}).text and err == ""
    assert main(["--robot", "eight_servos", "--yaw-joints", "4"]) == 2
    assert (
        capsys.readouterr().err == "eel urdf: yaw_joints must be 0 with a robot, which has joints of its own, got 4\n"
    )
