# SPDX-License-Identifier: Apache-2.0
"""A robot in the node, over DDS: its servos follow laws, its joints are measured, and commanded by a controller.

All its joints are in yaw: in messages their values have the opposite of the library's sign (test_joint_signs.py).
"""

import hashlib
import math
from time import monotonic

import numpy as np
import pytest
from eel_gaits.ros.messages import law_to_message
from sensor_msgs.msg import JointState
from swim_client import LIMIT, LOSSLESS, nanoseconds

from eel_dynamics import Robot, Scene, Simulation
from eel_gaits import Law, straight

ROBOT = ("--ros-args", "-p", "robot:=eight_servos")
FAST = (*ROBOT, "-p", "real_time_factor:=0", "-p", "rate:=50")
JOINTS = [f"joint_{index + 1}" for index in range(8)]


def command(time, **fields):
    """A JointState with the stamp `time` [s]; `name` by default all joints."""
    message = JointState(**{"name": JOINTS} | fields)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(time * 1e9), 1_000_000_000)
    return message


def by_stamp(messages):
    """Of the messages, the last of each stamp [ns]."""
    return {nanoseconds(message.header.stamp): message for message in messages}


def publisher(swim):
    made = swim.node.create_publisher(JointState, "joint_commands", LOSSLESS)
    swim.until(lambda: made.get_subscription_count() == 1, "the node's subscription")
    return made


def test_joint_states_are_those_of_the_library(start, client):
    swim = client(topics=("joint_states", "head_pose"))
    node = start("dynamics", *FAST, "-p", "duration:=1.0", "-p", "scene.planar:=true", "-p", "estimate_error:=false")
    swim.laws.publish(law_to_message(straight()))
    assert node.wait(LIMIT) == 0, node.output()
    swim.until(lambda: len(by_stamp(swim.received["joint_states"])) == 51, "51 samples")
    simulation = Simulation(robot=Robot.named("eight_servos"), scene=Scene(planar=True), law=straight())
    for stamp, message in sorted(by_stamp(swim.received["joint_states"]).items()):
        simulation.advance(stamp * 1e-9)
        joints = simulation.observe().joints
        assert message.name == JOINTS
        assert message.position == pytest.approx(-joints["joint_angle"], abs=1e-12)
        assert message.velocity == pytest.approx(-joints["joint_rate"], abs=1e-11)
        assert message.effort == pytest.approx(-joints["joint_torque"], abs=1e-10)
    assert max(map(abs, message.effort)) > 0.1


class Controller:
    """Answers each sample of joint_states with a wave of positions, which it stamps with that sample's time."""

    def __init__(self, swim):
        self.swim, self.answered = swim, set()
        self.publisher = publisher(swim)

    def answer(self):
        for stamp in sorted(by_stamp(self.swim.received["joint_states"]).keys() - self.answered):
            self.answered.add(stamp)
            t = stamp * 1e-9
            ramp = min(t, 1.0) ** 2
            wave = [0.2 * ramp * math.sin(2.0 * math.pi * (t - 0.1 * joint)) for joint in range(8)]
            self.publisher.publish(command(t, position=wave))


@pytest.mark.fault("time", "a controller of joints in lockstep, three times", "the same run to the last bit")
def test_a_controller_of_joints_runs_in_lockstep_and_each_time_alike(start, client):
    digests = []
    for _ in range(3):
        swim = client(topics=("joint_states", "head_pose"))
        node = start(
            "dynamics", *FAST, "-p", "duration:=1.5", "-p", "subscriber_timeout:=60", "-p", "estimate_error:=false"
        )
        controller = Controller(swim)

        def done(controller=controller, swim=swim):
            controller.answer()
            return (
                len(by_stamp(swim.received["joint_states"])) == 76 and len(by_stamp(swim.received["head_pose"])) == 76
            )

        swim.until(done, "76 samples")
        assert node.wait(LIMIT) == 0 and "ERROR" not in node.output() and "WARN" not in node.output(), node.output()
        digest = hashlib.sha256()
        for topic in ("joint_states", "head_pose"):
            for stamp, message in sorted(by_stamp(swim.received[topic]).items()):
                if stamp > 0:
                    digest.update(repr(message).encode())
        digests.append(digest.hexdigest())
        last = by_stamp(swim.received["joint_states"])[1_500_000_000]
        wanted = [0.2 * math.sin(2.0 * math.pi * (1.5 - 0.1 * joint)) for joint in range(8)]
        assert np.max(np.abs(np.subtract(last.position, wanted))) < 0.15  # it lags: without a feed-forward of the rate
        assert np.max(np.abs(last.position)) > 0.1
        swim.close()
    assert len(set(digests)) == 1


def test_a_command_takes_effect_at_its_stamp_and_holds_with_a_warning(start, client):
    """Between the samples at 0.1 and 0.12 s: the step is split. Then nothing comes for more than command_timeout."""
    swim = client(topics=("joint_states",))
    node = start(
        "dynamics", *FAST, "-p", "duration:=1.2", "-p", "subscriber_timeout:=0.2", "-p", "estimate_error:=false"
    )
    sender = publisher(swim)
    sender.publish(command(0.0, position=[0.0] * 8))
    sender.publish(command(0.11, name=["joint_4"], position=[0.3]))
    assert node.wait(LIMIT) == 0
    swim.until(lambda: len(by_stamp(swim.received["joint_states"])) == 61, "61 samples")
    simulation = Simulation(robot=Robot.named("eight_servos"), law=Law())
    for joint in JOINTS:
        simulation.command(joint, position=0.0)
    states = by_stamp(swim.received["joint_states"])
    for stamp in sorted(states):
        if stamp == 120_000_000:
            simulation.advance(0.11)
            simulation.command("joint_4", position=-0.3)
        simulation.advance(stamp * 1e-9)
        assert states[stamp].position == pytest.approx(-simulation.observe().joints["joint_angle"], abs=1e-12)
    assert states[1_200_000_000].position[3] == pytest.approx(0.3, abs=0.02)
    assert "no joint command for joint_1" in node.output() and "it holds" in node.output(), node.output()


@pytest.mark.fault(
    "samples",
    "joint commands for unknown joints, of wrong length, infinite, in another mode, far ahead, or for none",
    "refused with the joint and the value, once in the log; the last command holds",
)
def test_commands_that_do_not_fit_are_refused_and_the_node_goes_on(start, client):
    swim = client(topics=("joint_states",))
    node = start("dynamics", *ROBOT, "-p", "command_timeout:=0.0", "-p", "command_interfaces:=[position]")
    sender, nan, inf = publisher(swim), math.nan, math.inf
    sender.publish(command(0.0, position=[0.0] * 8))
    swim.until_time(0.2, "joint_states")
    for message, told in (
        (command(0.0, name=["neck"], position=[0.1]), "joint must be one of joint_1"),
        (
            command(0.0, name=["joint_1"], position=[0.1, 0.2]),
            "position must be empty or have as many values as name, 1",
        ),
        (command(0.0, name=["joint_1"], position=[nan]), "joint commands without a number: what is NaN leaves a joint"),
        (command(0.0, name=["joint_1"], position=[inf]), "position of joint 'joint_1' must be finite, got inf"),
        (
            command(0.0, name=["joint_1"], effort=[0.1]),
            "joint 'joint_1' has the command interface position, got effort",
        ),
        (
            command(0.0, name=["joint_1"], position=[0.1], effort=[0.1]),
            "joint 'joint_1' has the command interface position, got effort too",
        ),
        (
            command(0.0, name=["joint_1"] * 2, position=[0.1, 0.2]),
            "name must hold each joint once, got 'joint_1' twice",
        ),
        (command(0.0, name=[]), "name must hold 1 to 1000 joints, got 0"),
        (command(1e6, position=[0.0] * 8), "header.stamp must be simulation time"),
        (command(100.0, position=[0.0] * 8), "header.stamp must be at most 5 s ahead of the simulation"),
    ):
        sender.publish(message)
        swim.until(lambda told=told: told in node.output(), told)
    sender.publish(command(0.0, name=["joint_2"], position=[0.25], velocity=[nan], effort=[nan]))
    swim.until(lambda: abs(swim.received["joint_states"][-1].position[1] - 0.25) < 0.02, "the position of joint_2")
    swim.until(lambda: swim.diagnosis()[2].get("commanded_joints") == "8", "the joints in the diagnostics")
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()


def test_joints_are_driven_in_the_interface_that_they_have_from_the_start(start, client):
    swim = client(topics=("joint_states",))
    node = start("dynamics", *FAST, "-p", "duration:=1.0")
    sender, nan = publisher(swim), math.nan
    message = command(0.0, position=[nan, nan, *[0.1] * 6], velocity=[0.4, *[nan] * 7], effort=[nan, 0.05, *[nan] * 6])
    sender.publish(message)
    assert node.wait(LIMIT) == 0, node.output()
    swim.until(lambda: 1_000_000_000 in by_stamp(swim.received["joint_states"]), "the last sample")
    last = by_stamp(swim.received["joint_states"])[1_000_000_000]
    assert last.velocity[0] == pytest.approx(0.4, abs=0.05) and last.effort[1] == pytest.approx(0.05, abs=1e-9)
    assert last.position[2:] == pytest.approx([0.1] * 6, abs=0.03)


def test_motors_at_their_limits_are_named_with_how_long(start, client, tmp_path):
    weak = tmp_path / "weak.yaml"
    weak.write_text(
        "joints:\n  - {position: [0.2, 0.4, 0.6, 0.8], servo: {kp: 14, kd: 0.4, torque_limit: 0.2, speed_limit: 8}}\n"
    )
    swim = client(topics=("joint_states",))
    node = start("dynamics", "--ros-args", "-p", f"robot:={weak}", "-p", "real_time_factor:=0", "-p", "duration:=4")
    swim.laws.publish(law_to_message(straight()))
    assert node.wait(LIMIT) == 0, node.output()
    assert "at the torque limit at t = " in node.output() and "joint_3 for " in node.output(), node.output()
    swim.until(lambda: float(swim.diagnosis()[2]["time"]) == 4.0, "the last diagnostics")
    told = swim.diagnosis()[2]["at_torque_limit"]
    times = dict(each.split(" ", 1) for each in told.split(", "))
    assert 0.1 < float(times["joint_3"].split()[0]) < 4.0
    assert max(abs(effort) for message in swim.received["joint_states"] for effort in message.effort) <= 0.2 + 1e-12


@pytest.mark.fault(
    "parameters", "a torque limit of servos where there are none", "refused with the number; at the start status 2"
)
def test_a_torque_limit_is_lowered_in_mid_run_until_the_robot_cannot_follow(start, client):
    """As the library does it, to round-off; it stays over a reset, and is given back."""
    swim = client(topics=("joint_states",))
    swim.laws.publish(law_to_message(straight()))
    node = start("dynamics", *FAST, "-p", "estimate_error:=false")
    swim.until_time(0.5, "joint_states")
    times, limits = [], (0.3, 0.1)
    for limit in limits:
        times.append(swim.stop_the_clock("joint_states"))
        assert swim.set(servo_torque_limit=limit)[0].successful and swim.pause(False).success
        swim.until_time(times[-1] + 2.0, "joint_states")
    robot = Robot.named("eight_servos")
    simulation = Simulation(robot=robot, law=straight())
    for stamp, message in sorted(by_stamp(swim.received["joint_states"]).items()):
        if stamp * 1e-9 > times[-1] + 2.0:
            break
        simulation.advance(stamp * 1e-9)
        assert message.position == pytest.approx(-simulation.observe().joints["joint_angle"], abs=1e-11)
        for time, limit in zip(times, limits, strict=True):
            if abs(stamp * 1e-9 - time) < 1e-6:
                simulation.change_robot(robot.changed(torque_limit=limit))
    assert simulation.robot.servos[0].torque_limit == 0.1
    assert node.output().count("the torque limit of each servo is 0.1 N m from t = ") == 1
    swim.until(lambda: "at_torque_limit" in swim.diagnosis()[2], "servos at their limits")
    swim.stop_the_clock("joint_states")
    assert swim.reset().success
    begun = len(swim.received["joint_states"])
    assert swim.pause(False).success
    swim.until(lambda: len(swim.received["joint_states"]) > begun + 100, "a second run")
    again = [message for message in swim.received["joint_states"][begun:] if nanoseconds(message.header.stamp) < 2e9]
    assert 0.1 - 1e-9 < max(abs(effort) for message in again for effort in message.effort) < 0.1 + 1e-9
    assert swim.set(servo_torque_limit=0.0)[0].successful
    swim.until(lambda: max(map(abs, swim.received["joint_states"][-1].effort)) > 0.3, "the servos' own torques")
    (answer,) = swim.set(robot="passive_tail")
    assert answer.successful
    (answer,) = swim.set(servo_torque_limit=0.2)
    assert answer.reason == "servo_torque_limit must be 0 without servos, got 0.2 N m with robot 'passive_tail'"


@pytest.mark.fault("parameters", "a robot that there is not, or interfaces that do not fit", "status 2, with one line")
def test_a_robot_that_does_not_fit_ends_the_start(start_in_turn):
    cannot_be = {
        (
            "robot:=ten_servos",
        ): "robot must be one of eight_servos, sixteen_servos, series_elastic, passive_tail, a file",
        ("robot:=none.yaml",): "robot file 'none.yaml': there is no such file",
        ("servo_torque_limit:=0.2",): "servo_torque_limit must be 0 without servos, got 0.2 N m with robot ''",
        ("robot:=eight_servos", "yaw_joints:=3"): "yaw_joints and pitch_joints must be 0 with a robot",
        ("robot:=eight_servos", "command_interfaces:=[force]"): "command_interfaces must be one of position, velocity",
        (
            "robot:=eight_servos",
            "wait_for:=[joints]",
        ): "wait_for must be one of curvature_law, curvature_samples, joint_com",
        ("robot:=eight_servos", "wait_for:=[fin_command]"): "wait_for must name inputs that there are, got fin_command",
        ("wait_for:=[curvature_law/foo]",): "wait_for curvature_law has no names, got 'foo'",
        ("robot:=eight_servos", "wait_for:=[joint_commands/hip]"): "wait_for joint_commands/ must be one of joint_1",
        (
            "robot:=eight_servos",
            "wait_for:=[joint_commands x]",
        ): "wait_for must have a period > 0 s behind joint_commands",
        ("robot:=eight_servos", "command_interfaces:=[effort, effort]"): "or one for each of 8 joints, got 2",
    }
    lines = [["--ros-args", *(word for each in given for word in ("-p", each))] for given in cannot_be]
    for told, (status, said) in zip(cannot_be.values(), start_in_turn("eel_dynamics.ros.node", lines), strict=True):
        assert status == 2 and said.count("\n") == 1 and told in said, said


@pytest.mark.fault(
    "samples",
    "a command for a joint without a servo, or for one that has gone since a reset with another robot",
    "refused with the joint, once; the node goes on, and takes commands for the joints and fins that there are now",
)
def test_commands_are_checked_against_the_robot_that_there_is_now(start, client, tmp_path):
    tail = tmp_path / "tail.yaml"
    tail.write_text(
        "joints:\n  - {position: 0.4, name: hip, servo: {kp: 14, kd: 0.4, torque_limit: 3, speed_limit: 8}}\n"
        "  - {position: 0.7, name: tail, stiffness: 0.1, damping: 0.01}\n"
    )
    swim = client(topics=("joint_states",))
    node = start("dynamics", *ROBOT, "-p", "command_interfaces:=[position]")
    sender = publisher(swim)
    sender.publish(command(0.0, position=[0.1] * 8))
    swim.until_time(0.1, "joint_states")
    fins = "left station=0.5 area=0.001 aspect_ratio=2.5 angle=commanded time_constant=0.1"
    assert all(answer.successful for answer in swim.set(robot=str(tail), fins=fins))
    assert swim.reset().success
    swim.until(lambda: node.output().count("waiting for curvature_law") == 2, "a start without commands")
    sender.publish(command(0.0, name=["joint_1"], position=[0.2]))
    node.wait_for_output("joint command refused: joint must be one of hip, tail, got 'joint_1'")
    sender.publish(command(0.0, name=["hip", "tail"], position=[0.2, 0.2]))
    node.wait_for_output("joint command refused: joint 'tail' cannot be commanded: it has no servo")
    sender.publish(command(0.0, name=["hip"], position=[0.2]))
    swim.until(lambda: swim.received["joint_states"][-1].position[0] > 0.15, "the position of the hip")
    commands = swim.node.create_publisher(JointState, "fin_command", 10)
    swim.listen("fin_states", JointState)
    swim.until(commands.get_subscription_count, "the subscription of the new fin")
    commands.publish(JointState(name=["left"], position=[0.3]))
    swim.until(lambda: swim.received["fin_states"] and swim.received["fin_states"][-1].position[0] > 0.2, "its angle")
    assert all(answer.successful for answer in swim.set(robot="", fins="")) and swim.reset().success
    sender.publish(command(0.0, name=["hip"], position=[0.2]))
    node.wait_for_output("joint command refused: there are no servos: the shape is imposed")
    commands.publish(JointState(name=["left"], position=[0.3]))
    node.wait_for_output("fin command refused: no fin is commanded")
    assert node.interrupt() == 0 and "FATAL" not in node.output() and "Traceback" not in node.output()


@pytest.mark.fault(
    "samples",
    "joint commands at 2 kHz from two publishers for one joint: jumps, NaN, infinity, unknown names, stamps of before",
    "each fault is told once; joints turn no faster than their servos and stay within limits; the node goes on",
)
def test_the_body_never_jumps_whatever_two_publishers_command(start, client):
    """The two contradict each other: the newest holds. Rates are bounded by the servo's speed without load."""
    swim = client(topics=("joint_states", "head_pose"))
    node = start("dynamics", *ROBOT, "-p", "rate:=50", "-p", "estimate_error:=false")
    one, other = publisher(swim), swim.node.create_publisher(JointState, "joint_commands", LOSSLESS)
    swim.until(lambda: other.get_subscription_count() == 1, "the second publisher's subscription")
    one.publish(command(0.0, position=[0.0] * 8))
    swim.until_time(0.2, "joint_states")
    sent, flood = 0, monotonic()
    while sent < 1000:
        now = nanoseconds(swim.received["joint_states"][-1].header.stamp) * 1e-9
        for _ in range(100):  # 50 ms of 2 kHz
            sent += 1
            side = 50.0 if sent % 2 else -50.0
            one.publish(command(now, name=["joint_3"], position=[side]))
            other.publish(command(now - 0.02 * (sent % 7), name=["joint_3"], position=[-side]))
            if sent % 10 == 0:
                other.publish(command(now, name=["joint_3", "joint_4"], position=[math.nan, 0.5 * math.sin(sent)]))
                other.publish(command(now, name=["joint_3"], position=[math.inf]))
                one.publish(command(now, name=["neck"], position=[0.1]))
                one.publish(command(now, name=["joint_5"], velocity=[99.0], effort=[-1e9]))
        flood += 0.05
        swim.spin(max(0.0, flood - monotonic()))
    swim.until(lambda: abs(swim.received["joint_states"][-1].position[2]) > 0.5, "joint_3 following")
    states = [message for _, message in sorted(by_stamp(swim.received["joint_states"]).items())]
    angles, rates = (np.array([getattr(each, field) for each in states]) for field in ("position", "velocity"))
    fastest, furthest = 1.5 * 8.063, math.pi + 0.1  # the water and its neighbours push a joint, too; the stop gives way
    assert np.isfinite(angles).all() and np.abs(angles).max() < furthest and np.abs(rates).max() < fastest
    steps = np.diff([nanoseconds(each.header.stamp) for each in states]) * 1e-9
    assert (np.abs(np.diff(angles, axis=0)) <= fastest * steps[:, None]).all()
    said = node.output()
    for told in (
        "joint must be one of joint_1",
        "must be finite, got inf",
        "is beyond its limit",
        "is older than that of",
    ):
        assert told in said, told
    kinds = (
        "of joint 'joint_3' must be finite",
        "got 'neck'",
        "position 50 rad",
        "velocity 99 rad/s",
        "effort -1e+09 N m",
    )
    assert all(said.count(each) <= 2 for each in kinds), said[-3000:]  # once, and that it comes again and again
    assert len(said.splitlines()) < 60, said[-3000:]
    one.publish(command(states[-1].header.stamp.sec + 1.0, position=[0.0] * 8))
    swim.until(lambda: np.abs(swim.received["joint_states"][-1].position).max() < 0.1, "the body straight again")
    assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()[-2000:]
