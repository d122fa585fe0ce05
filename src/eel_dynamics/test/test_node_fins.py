# SPDX-License-Identifier: Apache-2.0
"""Fins over DDS: the parameter fins, the topics fin_command and fin_states."""

import numpy as np
import pytest
from eel_dynamics.model.fins.text import fins_from_text, text_of_fins
from eel_dynamics.model.flow.text import flow_from_text
from eel_dynamics.model.robot.robot import robot_of
from eel_gaits.ros.messages import law_to_message
from rclpy.duration import Duration
from sensor_msgs.msg import JointState
from swim_client import LIMIT, nanoseconds

from eel_dynamics import Fin, RollHold, Simulation, load_scene, save_scene
from eel_gaits import straight

PAIR = "pair station=0.2 area=0.001 aspect_ratio=2.5 k_p=2 k_d=0.15 time_constant=0.05"
FLOW = "shear velocity=0.2,0,0 across=0,1,0 width=1"
RUDDER = "left station=0.5 area=0.001 aspect_ratio=2.5 dihedral=1.2 angle=commanded time_constant=0.1"


def place(pose):
    return [getattr(pose.pose.position, axis) for axis in "xyz"]


@pytest.mark.parametrize("robot", [None, "eight_servos"])
def test_commands_reach_the_fins_between_two_samples_as_in_the_library(start, client, robot):
    """The robot, whose joints bend by themselves, swims in a shear."""
    more = () if robot is None else ("-p", f"robot:={robot}", "-p", f"flow:={FLOW}")
    swim = client(topics=("head_pose",))
    swim.listen("fin_states", JointState)
    commands = swim.node.create_publisher(JointState, "fin_command", 10)
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", "--ros-args", "-p", f"fins:={PAIR} + {RUDDER}", *more)
    swim.until(lambda: commands.get_subscription_count() > 0, "subscription")
    swim.until_time(0.1)
    paused = swim.stop_the_clock("head_pose")
    commands.publish(JointState(name=["left_2"], position=[0.3]))
    commands.publish(JointState(name=["right_2"], position=[0.3]))
    assert commands.wait_for_all_acked(Duration(seconds=LIMIT))
    node.wait_for_output("fin command refused", LIMIT)
    assert swim.pause(False).success
    samples = [round(1e9 * paused) + 10_000_000 * k for k in range(1, 21)]
    swim.until_time(samples[-1] * 1e-9, "head_pose", "fin_states")
    flow, robot = robot and flow_from_text(FLOW), robot_of(robot or "")
    library = Simulation(law=straight(), fins=fins_from_text(f"{PAIR} + {RUDDER}"), robot=robot, flow=flow)
    library.advance(paused)
    library.command_fins({"left_2": 0.3})
    poses, states = (
        {nanoseconds(m.header.stamp): m for m in swim.received[topic]} for topic in ("head_pose", "fin_states")
    )
    for stamp in samples:
        library.advance(round(stamp / 1e7) / 100.0)
        assert np.array_equal(place(poses[stamp]), library.head.position)
        assert list(states[stamp].name) == ["left", "right", "left_2"]
        assert np.array_equal(states[stamp].position, library.observe(False, False).fin_angle)
    assert states[stamp].position[2] > 0.1


def test_fins_that_do_not_fit_are_refused(start_in_turn):
    texts = "top station=0.2", "pair station=0.2", "pair station=2 area=0.001 aspect_ratio=2.5"
    lines = [["--ros-args", "-p", f"fins:={text}"] for text in texts]
    for status, said in start_in_turn("eel_dynamics.ros.node", lines):
        assert status == 2 and said.startswith("dynamics: ") and said.count("\n") == 1, said


def test_the_text_of_fins_is_read_again(tmp_path):
    fins = fins_from_text(f"{PAIR} + {RUDDER}")
    assert fins[:2] == Fin.pair(0.2, 1e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05)
    assert fins_from_text(text_of_fins(fins)) == fins
    path = tmp_path / "swim.yaml"
    path.write_text(
        f"/**: {{ros__parameters: {{gait: straight, fins: '{PAIR}', robot: eight_servos, flow: '{FLOW}'}}}}"
    )
    swim = load_scene(path)
    assert swim.fins == fins[:2] and swim.robot is not None and swim.flow is not None
    save_scene(swim, tmp_path / "again.yaml")
    assert load_scene(tmp_path / "again.yaml").fins == swim.fins


@pytest.mark.parametrize(
    ("commands", "message"),
    [({"left_1": 0.1}, "fin must be one of left,"), ({"left": np.nan}, "angle of fin left must be")],
)
def test_a_command_that_does_not_fit_is_refused(commands, message):
    simulation = Simulation(law=straight(), fins=fins_from_text(RUDDER))
    with pytest.raises(ValueError, match=message):
        simulation.command_fins(commands)
    with pytest.raises(ValueError, match="fin time_constant must be given for a commanded fin"):
        Fin(0.2, "left", 1e-3, 2.5, angle="commanded")
