# SPDX-License-Identifier: Apache-2.0
"""A robot that ros2_control drives through joint_state_topic_hardware_interface, whose messages are made up here.

What is known of these is from the source of that package, tag 1.1.0 of
github.com/ros-controls/topic_based_hardware_interfaces (src/joint_state_topic_hardware_interface.cpp, `write`), and of
ros2_control, branch jazzy. Each fact that a test uses stands with it.
"""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import yaml
from eel_common.ros.loop.diagnostics import Report
from eel_common.ros.testing.log import Log
from eel_dynamics.model.robot.joint_signs import sense_of
from eel_dynamics.model.robot.ready import READY
from eel_dynamics.ros.inputs.command_messages import interfaces_of, joint_command_from_message
from fake_publishers import fake_publishers, run_loop
from sensor_msgs.msg import JointState

from eel_dynamics import Joint, Robot, Servo, Simulation
from eel_gaits import Law

NAN = math.nan
SERVO = Servo(kp=14.0, kd=0.4, torque_limit=3.0, speed_limit=8.0)
MIXED = Robot(
    [
        Joint(0.15, name="neck", actuator=SERVO, limits=(-1.0, 0.8)),  # -0.8 to 1 in messages
        Joint(0.3, name="chest", actuator=SERVO),
        Joint(0.45, name="belly", stiffness=1.0, damping=0.05),
        Joint(0.6, name="hip", actuator=SERVO),
        Joint(0.75, name="tail", actuator=SERVO),
    ],
    name="mixed",
)
INTERFACES = ("position", "velocity", "none", "position velocity", "position velocity effort")


class TopicSystem:
    """As JointStateTopicSystem: what it publishes for the joints of a <ros2_control> tag.

    joints: command interfaces by name, in the tag's order. threshold: trigger_joint_command_threshold.
    """

    def __init__(self, joints, threshold=1e-5):
        self.joints, self.threshold = joints, threshold
        # A command is NaN until a controller has written it: hardware_interface/handle.hpp, constructor of Handle
        # without an initial value. The package's own test expects it (load_topic_based_system_2dof).
        self.commands = {(name, each): NAN for name, own in joints.items() for each in own}
        self.states = dict.fromkeys(self.commands, NAN)

    def write(self, stamp):
        """The message, or None. Commands are compared with the *states*, summed over all joints; so a command that the
        joint has reached is not sent, and NaN always is. With a threshold of -1 all are (README)."""
        difference = sum(abs(self.states[key] - self.commands[key]) for key in self.commands)
        if difference <= self.threshold:
            return None
        message = JointState()
        for name, own in self.joints.items():
            message.name.append(name)  # each joint, also one without a command interface
            for each in own:  # and a value for those interfaces alone that the joint has
                getattr(message, each).append(self.commands[name, each])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(stamp * 1e9), 1_000_000_000)
        return message


def split(words):
    return () if words == "none" else tuple(words.split())


def read(message, words, robot=MIXED):
    return joint_command_from_message(message, interfaces_of(robot, words), 0.0)[1]


TWO = Robot([Joint(0.3, name="joint1", actuator=SERVO), Joint(0.6, name="joint2", actuator=SERVO)])


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
@pytest.mark.parametrize("told", ["any", "its own"])
def test_arrays_of_robots_with_one_interface_are_read(interface, told):
    """The messages of the package's tests topic_based_system_2dof_position_only_publishes_commands, and likewise of
    velocity and effort: the other two arrays are empty."""
    message = JointState(name=["joint1", "joint2"], **{interface: [0.12, 0.14]})
    wanted = {"joint1": {interface: 0.12}, "joint2": {interface: 0.14}}
    assert read(message, (interface if told != "any" else "any",), TWO) == wanted


def test_arrays_of_a_mixed_robot_are_shorter_than_name_and_are_read_by_the_interfaces():
    system = TopicSystem(dict(zip(("neck", "chest", "belly", "hip", "tail"), map(split, INTERFACES), strict=True)))
    system.states = dict.fromkeys(system.states, 0.0)
    system.commands = {key: 0.1 * (1 + number) for number, key in enumerate(system.commands)}
    message = system.write(0.5)
    assert [len(each) for each in (message.name, message.position, message.velocity, message.effort)] == [5, 3, 3, 1]
    assert read(message, INTERFACES) == {
        "neck": {"position": pytest.approx(0.1)},
        "chest": {"velocity": pytest.approx(0.2)},
        "belly": {},
        "hip": {"position": pytest.approx(0.3), "velocity": pytest.approx(0.4)},
        "tail": {"position": pytest.approx(0.5), "velocity": pytest.approx(0.6), "effort": pytest.approx(0.7)},
    }
    with pytest.raises(
        ValueError, match=r"position must be empty or have as many values as name, 5, got 3: with fewer, "
    ):
        read(message, ("any",))


def test_the_tag_may_have_the_joints_in_another_order_or_a_part_of_them():
    system = TopicSystem({"tail": ("position", "velocity", "effort"), "neck": ("position",)})
    system.commands = {key: float(number) for number, key in enumerate(system.commands)}
    assert read(system.write(0.0), INTERFACES) == {
        "tail": {"position": 0.0, "velocity": 1.0, "effort": 2.0},
        "neck": {"position": 3.0},
    }


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"position": [0.1, 0.2]}, "or one for each of the 3 joints with that interface, got 2"),
        ({"velocity": [0.1] * 5}, "joint 'neck' has the command interface position, got velocity too"),
        ({"effort": [math.inf]}, "effort of joint 'tail' must be finite, got inf"),
    ],
)
def test_arrays_that_fit_no_interfaces_are_refused(fields, told):
    with pytest.raises(ValueError) as refused:
        read(JointState(name=["neck", "chest", "belly", "hip", "tail"], **fields), INTERFACES)
    assert told in str(refused.value)


def managed(threshold, active_at, duration=0.6, **parameters):
    """The log, angles (T, 5) [rad] and messages of a run that a controller manager at 50 Hz drives.

    It begins once /clock has gone on by a period (ros2_control_node.cpp, jazzy: sleep_for before the loop). Its
    controller is active from `active_at` [s] on, and asks for a wave.
    """
    log, angles, sent = Log(), [], []
    system = TopicSystem(
        dict(zip(("neck", "chest", "belly", "hip", "tail"), map(split, INTERFACES), strict=True)), threshold
    )
    names = [joint.name for joint in MIXED.joints]

    def publish(snapshot, nanoseconds):
        time, joints = 1e-9 * nanoseconds, snapshot.joints
        if time == 0.0:  # repeated at the start
            angles.clear()
        angles.append(joints["joint_angle"].copy())
        for name, own in system.joints.items():
            for each, measured in zip(("position", "velocity", "effort"), ("angle", "rate", "torque"), strict=True):
                if each in own:
                    system.states[name, each] = float(joints[f"joint_{measured}"][names.index(name)])
        if time >= active_at:
            for name, each in system.commands:
                phase = 6.0 * (time - active_at) - names.index(name)
                wave = {"position": 0.2 * math.sin(phase), "velocity": 1.2 * math.cos(phase), "effort": 0.01}
                system.commands[name, each] = wave[each]
        if time > 0.0 and (message := system.write(time)) is not None:
            sent.append(message)
            run.requests.put(run.take_command, run.inputs.joints, message)

    given = {"real_time_factor": 0.0, "rate": 50.0, "duration": duration, "subscriber_timeout": 0.1}
    given |= {"command_interfaces": INTERFACES, "wait_for": ("joint_commands 0.02",)} | parameters
    run = run_loop(Simulation(robot=MIXED, accuracy=1e-2), fake_publishers(publish), Report(log), **given)
    run.run()
    return log, np.array(angles), sent


def test_a_controller_manager_drives_the_swimmer_in_lockstep_as_the_library_does():
    """NaN until its controller is active, which answers the manager's samples and begins nothing."""
    log, angles, sent = managed(-1.0, active_at=0.2)
    assert len(sent) == 30 and math.isnan(sent[0].position[0]) and not math.isnan(sent[10].position[0])
    assert [text for level, text in log.lines if level != "info"] == [
        "joint commands without a number: what is NaN leaves a joint as it is"
    ]
    library, interfaces = Simulation(robot=MIXED, accuracy=1e-2, law=Law()), interfaces_of(MIXED, INTERFACES)
    for row, message in zip(angles[1:], [None, *sent], strict=False):
        for name, values in (
            {} if message is None else joint_command_from_message(message, interfaces, 9.0)[1]
        ).items():
            if values:
                library.command(name, **{each: -value for each, value in values.items()})  # all are in yaw
        library.advance(round(library.time + 0.02, 9))
        assert np.array_equal(row, library.observe().joints["joint_angle"])
    assert np.abs(angles[-1]).min() > 0.01 and np.array_equal(angles, managed(-1.0, active_at=0.2)[1])


@pytest.mark.fault(
    "samples",
    "a controller manager that sends no command which its joints have reached",
    "the run goes on after subscriber_timeout, with a line; a trigger_joint_command_threshold of -1 sends all",
)
def test_commands_that_are_not_sent_are_waited_for_once_and_then_not_until_they_are_back():
    log, _, sent = managed(1e9, active_at=0.0)  # as if the joints had reached all
    assert not sent
    missing = [text for level, text in log.lines if level == "warning"]
    assert missing == ["no joint command at the start within 0.1 s: the run begins without"]


def test_what_is_beyond_a_limit_is_clipped_and_told_once_with_joint_limit_and_value():
    log, given = Log(), []
    simulation = Simulation(robot=MIXED, accuracy=1e-2, law=Law())
    simulation.command = lambda joint, **values: given.append((joint, values))
    run = run_loop(simulation, fake_publishers(lambda *_: None), Report(log), real_time_factor=0.0, duration=0.07)
    for step, values in enumerate(([50.0, 0.1], [60.0, 0.2], [0.5, 0.2], [-50.0, 0.1])):
        message = JointState(name=["neck", "hip"], position=values, velocity=[0.0, 99.0], effort=[-9.0, NAN])
        message.header.stamp.nanosec = 20_000_000 * step
        run.take_command(run.inputs.joints, message)
    run.run()
    neck = [values["position"] for joint, values in given if joint == "neck"]
    assert neck == [-1.0, -0.5, 0.8] and all(abs(values["velocity"]) <= 8.0 for _, values in given)
    assert [text for level, text in log.lines if level == "warning"] == [
        "position 50 rad of joint 'neck' is beyond its limit 1 rad: clipped",
        "effort -9 N m of joint 'neck' is beyond its limit -3 N m: clipped",
        "velocity 99 rad/s of joint 'hip' is beyond its limit 8 rad/s: clipped",
    ]
    assert all(later[1] != earlier[1] for earlier, later in pairwise(given) if earlier[0] == later[0])


@pytest.fixture
def pages():
    """The folder of the documentation, which a package alone does not have."""
    found = Path(__file__).parents[3] / "docs"
    if not found.is_dir():
        pytest.skip("a package alone has no pages")
    return found


def test_the_page_has_the_joints_of_the_ready_robots(pages):
    page = (pages / "howto" / "joints.md").read_text()
    for name in READY:
        (row,) = (line for line in page.splitlines() if line.startswith(f"| `{name}` |"))
        joints = Robot.named(name).joints
        names, places, axes, *limits = (cell.strip() for cell in row.strip("|").split("|")[1:])
        if not joints:
            assert names == "none"
            continue
        several = list(dict.fromkeys(joint.axis for joint in joints))
        ahead, behind = joints[: len(several)], joints[-len(several) :]
        assert names == " ... ".join(", ".join(f"`{joint.name}`" for joint in each) for each in (ahead, behind))
        assert places == "{:.2f}, {:.2f} ... {:.2f}".format(
            *np.unique([joint.position for joint in joints])[[0, 1, -1]]
        )
        assert axes == ", ".join(several)
        told = {
            (f"±{joint.limits[1]:.4g} rad", f"{servo.speed_limit:.4g} rad/s", f"{servo.torque_limit:g} N m")
            for joint, servo in zip(joints, Robot.named(name).servos, strict=True)
            if joint.limits[0] == -joint.limits[1]
        }
        assert told == {tuple(limits)}


def test_the_urdf_and_the_controllers_of_the_page_have_the_robot_s_joints(pages):
    text = (pages / "examples" / "eight_servos.urdf").read_text()
    robot, read = Robot.named("eight_servos"), Robot.from_file(pages / "examples" / "eight_servos.urdf", joints="flush")
    for joint, other in zip(robot.joints, read.joints, strict=True):
        assert (joint.name, sense_of(joint.axis)) == (other.name, sense_of(other.axis))
        assert other.position == pytest.approx(joint.position, abs=3e-3)  # a visual box begins behind the nose
        assert other.limits == pytest.approx(joint.limits, abs=1e-6)
        assert other.actuator.speed_limit == pytest.approx(joint.actuator.speed_limit, abs=1e-4)
        assert other.actuator.torque_limit == joint.actuator.torque_limit
        assert text.count(f'<joint name="{joint.name}">') == 1, "one in <ros2_control>"
    assert '<param name="trigger_joint_command_threshold">-1</param>' in text
    controllers = yaml.safe_load((pages / "examples" / "eight_servos_controllers.yaml").read_text())
    for name in ("trajectory", "positions"):
        assert controllers[name]["ros__parameters"]["joints"] == [joint.name for joint in robot.joints]
    assert controllers["controller_manager"]["ros__parameters"]["use_sim_time"] is True
