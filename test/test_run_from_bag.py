# SPDX-License-Identifier: Apache-2.0
"""`Run.from_bag`: a run of the library, from what a dynamics node published of it."""

from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from eel_common.topics import ENERGY_FIELDS, GLOBAL, OWN
from eel_common.topics import LATER_ENERGY_FIELDS as LATER
from eel_dynamics.ros.messages import SampleMessages, body_message, diagnostic_array
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_dynamics.runs.exchange.recorded_run import fields_of_messages
from eel_dynamics.simulation.bending.joint_motion import JOINT_ARRAYS
from eel_dynamics.simulation.energy import EnergyLedger
from eel_gaits.ros.messages import law_to_message
from eel_viz.bags.definitions import definition, type_hash
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin, Writer

from eel_dynamics import Body, Fin, Robot, RollHold, Run, Scene, Shear, simulate
from eel_gaits import falling, straight

PROFILES = ("backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force", "fluid_force")
PROFILES += ("resistive_force", "tail_force", "nose_force", "wake_momentum_rate", "position", "orientation", "twist")
COMPUTED = ("head_acceleration", "center_of_mass", "energy", "body", "time", "law", "accuracy", "error_estimate")
COMPUTED += ("steps", "evaluations", "nodes", "closure_torque", "closure_force")


SCENE = Scene(friction="laminar", density=990.0)


@pytest.fixture(scope="module")
def run() -> Run:
    return simulate(falling(), 2.0, sample_period=0.02, load=True, scene=SCENE, accuracy=1e-3)


def write_bag(folder, run, *, left_out=(), space="", runs=1, laws=1, origin=0, first=0, waiting=0):
    """A bag of the messages that a node publishes of `run`, `runs` times; the law's own time begins at `origin` [s].
    waiting: before each run, so many messages of sample 0 with the numbers of another."""
    writer, connections = Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP), {}
    with writer:

        def add(topic: str, kind: str, data: bytes):
            if topic.removeprefix(f"{space}/") in left_out:
                return
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, msgdef=definition(kind), rihs01=type_hash(kind))
            writer.write(connections[topic], 1_800_000_000 * 10**9, data)

        add(f"{space}/body", OWN["body"], serialize_message(body_message(run, "section")))
        for _ in range(laws):
            message = law_to_message(run.law, stamp=Time(sec=origin))
            add(f"{space}/curvature_law", OWN["curvature_law"], serialize_message(message))
        told = diagnostic_array(0.0, "/dynamics", 0, "swimming", {"law": run.law.name, "accuracy": run.accuracy.name})
        add("/diagnostics", GLOBAL["/diagnostics"], serialize_message(told))
        water = {"water_at": lambda place: run.scene.current, "flow": None}
        swimmer = SimpleNamespace(x=run.x, scene=run.scene, head_errors=None, robot=run.robot, fins=run.fins, **water)
        sample = SampleMessages(swimmer, DynamicsParameters())
        shown = (*PROFILES, "fin_angle", "fin_force") if run.fins else PROFILES
        whole = [*[(0, 7)] * waiting, *((k, k) for k in range(first, len(run.time)))]
        for stamp, k in whole * runs:
            sample.set_time(round(run.time[stamp] * 1e9))
            energy = SimpleNamespace(**{name: run.energy[name][k] for name in run.energy.keys()})  # noqa: SIM118
            joints = {name: getattr(run, name)[k] for name in JOINT_ARRAYS if run.robot is not None}
            snapshot = SimpleNamespace(energy=energy, joints=joints, **{name: getattr(run, name)[k] for name in shown})
            for topic in sample.kinds:
                if topic in OWN and topic != "swim_state":
                    add(f"{space}/{topic}", OWN[topic], sample.fill(topic, snapshot))
    return folder


def test_a_robot_s_run_has_the_motion_of_its_joints(tmp_path):
    robot = Robot.named("eight_servos")
    run = simulate(straight(), 0.5, robot=robot, sample_period=0.02, load=True, accuracy=1e-2, estimate=False)
    bag = write_bag(tmp_path / "bag", run)
    again = Run.from_bag(bag, scene=run.scene, robot="eight_servos")
    assert again.robot == robot and again.mode_amplitude is None
    for name in ("joint_angle", "joint_rate", "joint_torque", "motor_angle", "motor_torque", "motor_power"):
        assert np.array_equal(getattr(again, name), getattr(run, name)), name
    assert Run.from_bag(bag, scene=run.scene).joint_angle is None
    again.save(tmp_path / "again.nc")
    assert np.array_equal(Run.load(tmp_path / "again.nc").joint_angle, run.joint_angle)
    with pytest.raises(ValueError, match="joint_states must have the robot's joints, got none of yaw_1, pitch_1"):
        Run.from_bag(bag, robot=robot.changed("joint_1", name="yaw_1").changed("joint_2", name="pitch_1"))
    with pytest.raises(ValueError, match="no message on joint_states, which a run of a robot needs"):
        Run.from_bag(write_bag(tmp_path / "bare", run, left_out=("joint_states",)), robot=robot)


def test_it_is_the_run_that_was_published(run, tmp_path):
    again = Run.from_bag(write_bag(tmp_path / "bag", run), scene=run.scene)
    for item in fields(Run):
        if item.name not in COMPUTED:
            assert np.array_equal(getattr(again, item.name), getattr(run, item.name)), item.name
    assert again.law == run.law and again.accuracy.name == "0.001" and again.time == pytest.approx(run.time, abs=1e-9)
    size = np.abs(run.head_acceleration).max()
    assert np.abs(again.head_acceleration - run.head_acceleration).max() < 5e-3 * size
    assert again.center_of_mass == pytest.approx(run.center_of_mass, abs=1e-4)
    assert again.body.mass == pytest.approx(0.99 * Body.boyer2010().mass, rel=1e-9)
    assert again.body_mass == pytest.approx(again.body.mass, rel=1e-5)  # the outline is that of the stations
    x = np.linspace(0.0, 1.0, 50)
    assert again.body.half_width(x) == pytest.approx(run.body.half_width(x), abs=1e-4)
    for name in run.energy.keys():  # noqa: SIM118
        assert again.energy[name] == pytest.approx(run.energy[name], abs=1e-4 * np.abs(run.energy[name]).max() + 1e-6)
    assert again.mean_speed == pytest.approx(run.mean_speed, rel=1e-3) and "Strouhal" in again.summary()
    again.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == again
    known = replace(again, body=run.body)
    assert known.refined.position == pytest.approx(run.position, abs=1e-3)


def test_what_flow_fins_and_weight_add_is_on_the_topics(tmp_path):
    """Every array of the library that such a scene adds comes back from a bag, to the last bit."""
    pair = Fin.pair(0.2, 1e-3, 2.5, angle=RollHold(2.0, 0.15), time_constant=0.05)
    body = Body.boyer2010().changed(density=1010.0, centre_of_mass_offset=0.005)
    scene = Scene(weight=True)
    run = simulate(falling(), 0.6, body=body, scene=scene, flow=Shear(), fins=[pair], load=True, accuracy=1e-3)
    again = Run.from_bag(write_bag(tmp_path / "bag", run), scene=scene)
    assert set(EnergyLedger.keys()) == set(ENERGY_FIELDS)
    for name in ENERGY_FIELDS:
        assert np.array_equal(again.energy[name], run.energy[name]), name
    assert run.energy.flow_work.any() and run.energy.fins_work.any() and run.energy.potential.any()
    for name in ("fin_angle", "fin_force"):
        assert np.array_equal(getattr(again, name), getattr(run, name)) and getattr(run, name).any()


def test_a_bag_without_the_powers_of_flow_and_fins_is_read(run):
    older = [
        (topic, SimpleNamespace(**{name: each for name, each in vars(message).items() if name not in LATER}))
        for topic, message in messages_of_run(run)
    ]
    law = next(message for topic, message in older if topic == "curvature_law")
    law.header, law.terms, law.transition = SimpleNamespace(stamp=SimpleNamespace(sec=0, nanosec=0)), [], 0.0
    energy = Run(**fields_of_messages(older, None, run.scene)).energy
    assert np.array_equal(energy.drag_power, run.energy.drag_power) and not energy.fins_power.any()
    assert energy.drag_work == pytest.approx(run.energy.drag_work, abs=1e-4 * np.abs(run.energy.drag_work).max())


def test_a_sample_0_that_was_repeated_before_the_run_counts_once(run, tmp_path, recwarn):
    again = Run.from_bag(write_bag(tmp_path / "bag", run, waiting=3), scene=run.scene)
    assert again.time == pytest.approx(run.time, abs=1e-9) and np.array_equal(again.torque, run.torque)
    assert not recwarn.list


def test_what_the_bag_lacks_is_none_or_named(run, tmp_path):
    bag = write_bag(tmp_path / "few", run, left_out=("internal_wrench", "energy", "hydrodynamic_load", "odom"))
    few = Run.from_bag(bag)
    assert few.torque is None and few.energy is None and few.fluid_force is None
    assert not few.scene.internal_wrench and not few.scene.ledger and "mean speed" in few.summary()
    bag = write_bag(tmp_path / "without", run, left_out=("backbone", "head_twist"))
    with pytest.raises(ValueError, match=r"bag .*without' holds no run: there is no message on head_twist, backbone"):
        Run.from_bag(bag)
    bag = write_bag(tmp_path / "bodiless", run, left_out=("body", "curvature_law"))
    with pytest.raises(ValueError, match="no message on body: give the body"), pytest.warns(UserWarning, match="law"):
        Run.from_bag(bag)
    with pytest.raises(ValueError, match=r"there must be \d+ instants or more .*, got 2"):
        Run.from_bag(write_bag(tmp_path / "two", run, first=len(run.time) - 2))
    with pytest.raises(ValueError, match="does not exist") as error:
        Run.from_bag(tmp_path / "nowhere")
    assert "\n" not in str(error.value)


def test_a_reset_and_several_laws_are_told(run, tmp_path):
    bag = write_bag(tmp_path / "bag", run, runs=2, laws=3)
    with pytest.warns(UserWarning) as told:
        again = Run.from_bag(bag)
    assert again.time == pytest.approx(run.time, abs=1e-9)
    words = [str(each.message) for each in told]
    assert any("time falls back to 0 s" in line for line in words) and any("there are 3 laws" in line for line in words)
    assert {each.filename for each in told} == {__file__}  # not a line of the library


def test_one_swimmer_of_a_namespace(run, tmp_path):
    bag = write_bag(tmp_path / "bag", run, space="/eel2", first=40)
    again = Run.from_bag(bag, "eel2", body=run.body)
    assert np.array_equal(again.position, run.position[40:]) and again.body is run.body
    with pytest.raises(ValueError, match="no swimmer in namespace 'eel3'"):
        Run.from_bag(bag, "eel3")


def test_a_law_is_moved_to_the_time_of_the_simulation(tmp_path):
    run = simulate(straight(period=0.7), 1.5, sample_period=0.05, load=True, accuracy=1e-2)
    law = Run.from_bag(write_bag(tmp_path / "bag", run, origin=1)).law
    moved, own = law.curvature(1.9, run.x), run.law.curvature(0.9, run.x)
    assert np.allclose(moved, own, rtol=1e-12, atol=1e-12)
