# SPDX-License-Identifier: Apache-2.0
"""Bags of before joints had the signs of REP-103, with the messages of then: they replay, with the signs of today."""

import warnings

import numpy as np
import pytest
from eel_viz.bags.bag import Bag
from eel_viz.bags.definitions import definition
from eel_viz.bags.joint_signs import is_older
from eel_viz.bags.replay import main
from eel_viz.bags.swimmer_messages import JOINTS, joint_states, swimmer_messages
from eel_viz.recording.reading import read
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from test_run_from_bag import write_bag

from eel_dynamics import Fin, Joint, Robot, Run, Servo, simulate
from eel_gaits import straight
from eel_viz import entities

SERVO = Servo(kp=14.0, kd=0.4, torque_limit=3.0)
CAME_LATER = {  # lines of the definitions, by the message that has them
    "JointGeometry": ("int8 ",),
    "MotorStates": ("string[] name ",),
    "HydrodynamicLoad": ("string[] fin_name ",),
}
READ = "joint_angle", "joint_rate", "joint_torque", "motor_torque", "motor_power"


@pytest.fixture(scope="module")
def run() -> Run:
    joints = [Joint(0.2, name="a", actuator=SERVO), Joint(0.4, "pitch", name="b", actuator=SERVO, initial_angle=0.1)]
    joints += [Joint(0.6, "z", name="c", actuator=SERVO), Joint(0.8, "-yaw", name="d", actuator=SERVO)]
    fins = Fin.pair(0.3, 1e-3, 2.5)
    return simulate(straight(), 0.3, robot=Robot(joints), fins=fins, sample_period=0.02, load=True, estimate=False)


def older_definition(kind):
    """The definition of messages of a `kind` before."""
    parts = definition(kind).split("=" * 80)
    kept = []
    for part in parts:
        name = next((name for name in CAME_LATER if f"MSG: eel_msgs/{name}\n" in part), None)
        if part is parts[0]:
            name = kind.rpartition("/")[2]
        lines = part.splitlines(keepends=True)
        kept.append("".join(line for line in lines if not line.startswith(CAME_LATER.get(name, ("no such line",)))))
    return ("=" * 80).join(kept)


def older_bag(folder, bag, signs, imposed=None):
    """The `bag` as it would have been recorded before: joints, by `signs` (J,), with the library's. imposed: angles
    [rad] of joints of an imposed motion, by name, at each odom."""
    store = get_typestore(Stores.EMPTY)
    with Bag(bag) as source, Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connections = {}
        kinds = {topic: about.type for topic, about in source.topics.items()}
        for topic, kind in (kinds | ({"/joint_states": JOINTS} if imposed else {})).items():
            text = older_definition(kind)
            found = get_types_from_msg(text, kind)
            store.register({name: each for name, each in found.items() if name not in store.fielddefs})
            connections[topic] = writer.add_connection(topic, kind, msgdef=text, rihs01="RIHS01_" + 64 * "0")

        def older(message):
            if isinstance(message, list):
                return [older(each) for each in message]
            if not hasattr(message, "__msgtype__"):
                return message
            kind = message.__msgtype__
            return store.types[kind](**{name: older(getattr(message, name)) for name, _ in store.fielddefs[kind][1]})

        for topic, time, message in source.messages(*source.topics):
            made = older(message)
            if topic == "/joint_states":
                for field in ("position", "velocity", "effort"):
                    setattr(made, field, getattr(made, field) * signs)
            if topic == "/motor_states":
                made.torque = made.torque * signs
            writer.write(connections[topic], time, store.serialize_cdr(made, made.__msgtype__))
            if topic == "/odom" and imposed:
                rows = {field: np.array([*imposed.values()]) for field in ("position", "velocity", "effort")}
                made = store.types[JOINTS](header=made.header, name=[*imposed], **rows)
                writer.write(connections["/joint_states"], time, store.serialize_cdr(made, JOINTS))
    return folder


@pytest.fixture
def bags(run, tmp_path):
    new = write_bag(tmp_path / "new", run)
    return new, older_bag(tmp_path / "older", new, np.array([-1.0, 1.0, 1.0, -1.0]))


def test_older_definitions_are_told_from_those_of_today(bags):
    new, older = bags
    for path, expected in ((new, False), (older, True)):
        with Bag(path) as bag:
            assert is_older(bag, "") is expected
    with Bag(older) as bag:
        body = next(message for _, _, message in bag.messages("/body"))
        load = next(message for _, _, message in bag.messages("/hydrodynamic_load"))
        assert not hasattr(body.joints[0], "sense") and not hasattr(load, "fin_name")


def test_a_run_of_a_robot_is_the_same_from_bags_of_today_and_of_before(run, bags):
    for bag in bags:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            again = Run.from_bag(bag, scene=run.scene, robot=run.robot)
        for name in READ:
            assert np.array_equal(getattr(again, name), getattr(run, name)), (bag, name)
        assert np.array_equal(again.fin_force, run.fin_force) and run.fin_force.any()


def test_joints_of_an_older_bag_have_the_signs_of_today(run, bags):
    """Where no robot is given, what bends in yaw counts as a robot's of this suite, with a line that says so."""
    new, older = bags
    with pytest.warns(UserWarning, match="before joints had the signs of REP-103: those in yaw are turned; for a"):
        _, angles, names = joint_states(older, "joint_states")
    today = joint_states(new, "joint_states")[1]
    assert names == ["a", "b", "c", "d"] and np.abs(today).max(axis=0).min() > 1e-4
    assert np.array_equal(
        angles, today * [1.0, 1.0, -1.0, 1.0]
    )  # of the URDF's, which the messages of then do not tell
    assert np.array_equal(today, run.joint_angle * [-1.0, 1.0, 1.0, -1.0])
    with pytest.warns(UserWarning, match="those in yaw are turned"):
        told = [message for topic, message in swimmer_messages(older) if topic == "motor_states"]
    assert np.array_equal([each.torque for each in told], run.motor_torque * [-1.0, 1.0, -1.0, -1.0])


@pytest.mark.soak
def test_an_older_bag_of_an_imposed_motion_has_its_pitch_turned(tmp_path):
    """There the joints are those of `yaw_joints` and `pitch_joints`, and the body has none."""
    swum = simulate(straight(), 0.2, sample_period=0.02, load=True, estimate=False)
    bag = older_bag(tmp_path / "older", write_bag(tmp_path / "new", swum), np.ones(2), {"yaw_1": 0.1, "pitch_1": 0.2})
    states = [message for topic, message in swimmer_messages(bag) if topic == "joint_states"]
    assert len(states) == len(swum.time) and all(each.position.tolist() == [0.1, -0.2] for each in states)


@pytest.mark.soak
def test_an_older_bag_is_replayed(bags, tmp_path, capsys):
    numbers = []
    for bag in bags:
        assert main([str(bag), "-o", str(tmp_path / f"{bag.name}.rrd")]) == 0
        numbers.append(read(tmp_path / f"{bag.name}.rrd", entities.JOINT_NUMBERS)["position"])
    said = capsys.readouterr().err
    assert said.count("before joints had the signs of REP-103") == 1 and "left out" not in said
    assert np.array_equal(np.array(numbers[1]), np.array(numbers[0]) * [1.0, 1.0, -1.0, 1.0])
