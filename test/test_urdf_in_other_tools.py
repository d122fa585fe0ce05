# SPDX-License-Identifier: Apache-2.0
"""What is written as a URDF is read and drawn by Rerun's own loader; the file for RViz shows topics that there are."""

from pathlib import Path

import pytest
import rerun as rr
import yaml
from eel_common.topics import OWN
from eel_dynamics.model.robot.ready import READY
from rerun.urdf import UrdfTree

from eel_dynamics import Body, Robot, urdf_of

RVIZ = Path(__file__).resolve().parents[1] / "docs" / "examples" / "eel.rviz"
UNLIMITED = 1e6
SWIMMERS = {name: {"robot": Robot.named(name)} for name in READY}
SWIMMERS |= {"an imposed shape": {"body": Body.kern2006(), "yaw_joints": 4, "pitch_joints": 4}, "one link": {}}


@pytest.mark.parametrize("name", SWIMMERS)
def test_reruns_loader_reads_and_draws_each_swimmer(tmp_path, name):
    given, path = SWIMMERS[name], tmp_path / "eel.urdf"
    path.write_text(urdf_of(**given).text)
    tree = UrdfTree.from_file_path(path)
    joints = [joint for joint in tree.joints() if joint.joint_type != "fixed"]
    assert tree.root_link().name == "base_link"
    robot = given.get("robot")
    if robot is None:
        assert len(joints) == given.get("yaw_joints", 0) + given.get("pitch_joints", 0)
    else:
        assert [joint.name for joint in joints] == [joint.name for joint in robot.joints]
        for joint, own in zip(joints, robot.joints, strict=True):
            assert joint.axis == pytest.approx([0, 1, 0] if own.component == 1 else [0, 0, 1])
            assert sorted((joint.limit_lower, joint.limit_upper)) == pytest.approx(own.limits)  # alike to both sides
            servo = own.actuator
            assert (joint.limit_effort, joint.limit_velocity) == pytest.approx((servo.torque_limit, servo.speed_limit))
    stream = rr.RecordingStream("urdf")
    stream.save(tmp_path / "eel.rrd")
    tree.log_urdf_to_recording(stream)
    stream.flush()
    stream.disconnect()
    links = [tree.root_link(), *(tree.get_joint_child(joint) for joint in tree.joints())]
    assert not tree.get_visual_geometry_paths(links[0])
    assert all(tree.get_visual_geometry_paths(link) and tree.get_collision_geometry_paths(link) for link in links[1:])
    assert (tmp_path / "eel.rrd").stat().st_size > 10_000


def test_the_file_for_rviz_shows_the_topics_of_the_suite_as_they_are_published():
    _, manager = yaml.safe_load(RVIZ.read_text()).values()
    topics = {}
    for display in manager["Displays"]:
        assert display["Class"].startswith("rviz_default_plugins/")
        for key in ("Topic", "Description Topic"):
            if key in display:
                topics[display[key]["Value"].strip("/")] = display[key]["Durability Policy"]
    assert topics.pop("robot_description") == "Transient Local"
    assert topics.keys() - OWN.keys() == {"markers", "midline"} and set(topics.values()) == {"Volatile"}
    assert manager["Global Options"]["Fixed Frame"] == "odom"
