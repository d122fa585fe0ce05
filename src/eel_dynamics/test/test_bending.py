# SPDX-License-Identifier: Apache-2.0
"""Bodies that bend by themselves: the march of a robot against what must hold for it."""

import pickle
from copy import deepcopy

import numpy as np
import pytest
from eel_dynamics.analysis.powers import drag_powers
from eel_dynamics.model.robot.actuators import Servo, Torque
from eel_dynamics.model.robot.continuous import PassiveTail
from eel_dynamics.model.robot.joint import Joint
from eel_dynamics.model.robot.robot import Robot

from eel_dynamics import (
    Accuracy,
    Batch,
    Body,
    Run,
    Scene,
    Simulation,
    SimulationStopped,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, Term, falling, straight

READY = "eight_servos", "series_elastic", "passive_tail"
SMOOTH = Scene(friction="laminar")


def chain(**servo) -> Robot:
    """Eight joints with such servos."""
    return Robot([Joint(0.1 + 0.12 * k, actuator=Servo(**servo)) for k in range(8)])


def greatest(values) -> float:
    return float(np.max(np.abs(values)))


@pytest.mark.parametrize("name", READY)
def test_energy_is_kept_to_the_accuracy_of_the_run(name):
    for accuracy, share in (("draft", 4e-3), (1e-3, 8e-4), ("standard", 8e-5)):
        run = simulate(straight(), 2.0, robot=Robot.named(name), accuracy=accuracy, estimate=False)
        assert greatest(run.energy.residual) < share * greatest(run.energy.actuator_work)
        assert greatest(run.closure_torque) < 1e-12 and greatest(run.closure_force) < 1e-12


def test_internal_torque_on_each_joint_is_that_of_spring_and_motor():
    """integral B . C dX = - motor torque + armature times acceleration: section 2 of the derivation, at each joint."""
    x = 0.1 + 0.12 * np.arange(8)
    points, weights = np.polynomial.legendre.leggauss(6)
    stations = (x[:, None] + 0.03 * points).ravel()
    simulation = Simulation(robot=Robot.named("eight_servos"), law=straight(), stations=stations, accuracy="fine")
    simulation.advance(1.3)
    now = simulation.observe(load=False)
    mean = 0.5 * (now.torque[:, 2].reshape(8, 6) @ weights)
    row = np.zeros((1, max(end for _, end in simulation._march.core.row.values())))
    assert simulation._march.core.observe(now.whole, row, True, False)
    first, last = simulation._march.core.row["moment"]
    assert greatest(mean - row[0, first:last]) < 1e-7 * greatest(mean)
    assert greatest(mean + now.joints["joint_torque"] * -1.0) > 0.01  # the rotors' inertia is no small part


@pytest.mark.parametrize("damping", [0.0, 0.1, 2.0])
def test_a_stop_s_torque_grows_from_zero_never_pulls_and_gives_back_no_more_than_it_took(damping):
    """A spring throws the joint against its stop, again and again; the moment less the spring's is that of the stop."""
    joint = Joint(0.5, "-yaw", 0.1, 0.2, rest_angle=-0.6, initial_angle=0.2, limits=(-0.1, 0.3), stop_damping=damping)
    simulation = Simulation(robot=Robot([joint]), law=straight(), scene=SMOOTH, accuracy=1e-6)
    core, seen = simulation._march.core, []
    row = np.zeros((1, max(end for _, end in core.row.values())))
    for time in np.arange(1, 201) * 5e-3:
        simulation.advance(time)
        now = simulation.observe(load=False)
        assert core.observe(now.whole, row, True, False)
        moment = row[0, core.row["moment"][0]]
        angle, rate = now.joints["joint_angle"][0], now.joints["joint_rate"][0]
        seen.append((angle, rate, moment - joint.stiffness * (angle - joint.rest_angle), now.energy.damping_work))
    angle, rate, torque, work = np.array(seen).T
    beyond = angle - np.clip(angle, *joint.limits)
    deeper = np.sign(beyond) * rate
    assert torque == pytest.approx(beyond * np.maximum(0.0, 100.0 + damping / 0.01 * deeper), abs=1e-12)
    assert (beyond < 0.0).sum() > 5 and (torque * beyond).min() > -1e-12
    assert np.diff(work).max() < 2e-6  # J: of the quadrature
    assert greatest(now.energy.residual) < 1e-5 and (work[-1] < -1e-3) == (damping > 0.0)


@pytest.mark.parametrize(
    ("kd", "least", "greatest_errors"), [(0.02, 2.7, (4e-5, 8e-6, 1e-6)), (1.0, 2.0, (2.3e-4, 2.7e-5, 3.5e-6))]
)
def test_time_method_is_of_third_order(kd, least, greatest_errors):
    """At kd = 1 the errors stay below those of bending's derivation at 10, 5, 2.5 ms; the order rises to 3."""
    robot = chain(kp=20.0, kd=kd)
    reference = _with_steps(robot, 2.5e-3 / 8)
    errors = [greatest(_with_steps(robot, step) - reference) for step in (1e-2, 5e-3, 2.5e-3)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert all(error < bound for error, bound in zip(errors, greatest_errors, strict=True)), errors
    assert least < orders[-1] < 3.5, orders


def _with_steps(robot: Robot, step: float) -> np.ndarray:
    accuracy = Accuracy(name="steps", resolution=16.0, step=step)
    scene = Scene(resistive=False, ledger=False)
    run = simulate(straight(), 2.0, robot=robot, scene=scene, accuracy=accuracy, estimate=False, sample_period=1.0)
    return run.position[-1]


def test_stiffer_servos_follow_the_law_more_closely():
    """The head's error falls with 1/kp, as where the law is imposed between the joints."""
    ends = [
        simulate(straight(), 2.0, robot=chain(kp=kp, kd=0.1), scene=SMOOTH, accuracy=1e-4, estimate=False)
        for kp in (50.0, 200.0, 800.0, 12800.0)
    ]
    errors = [greatest(run.position[-1] - ends[-1].position[-1]) for run in ends[:-1]]
    assert 3.2 < errors[0] / errors[1] < 4.8 and 3.2 < errors[1] / errors[2] < 4.8, errors


@pytest.mark.parametrize("name", READY)
def test_robot_at_rest_stays_at_rest_exactly(name):
    run = simulate(Law(name="none"), 1.0, robot=Robot.named(name), estimate=False)
    assert (
        not run.position.any() and not run.twist.any() and not run.joint_angle.any() and not run.energy.residual.any()
    )


def test_robot_starts_in_the_pose_that_is_given():
    """At rest, in the joint's own sign, the motor behind a spring too; springs then bring it back."""
    servo = Servo(kp=5.0, kd=0.1, rotor_inertia=2e-4, series_stiffness=20.0)
    robot = Robot(
        [
            Joint(0.3, "-yaw", stiffness=1.0, damping=0.1, initial_angle=0.2),
            Joint(0.5, actuator=servo, initial_angle=-0.3),
            Joint(0.7, actuator=Servo(kp=5.0, kd=0.1)),
        ]
    )
    run = simulate(Law(name="none"), 4.0, robot=robot, accuracy=1e-3, estimate=False)
    assert run.joint_angle[0] == pytest.approx([0.2, -0.3, 0.0]) and not run.joint_rate[0].any()
    assert run.motor_angle[0, 1] == pytest.approx(-0.3) and run.energy.elastic[0] == pytest.approx(0.02)
    assert greatest(run.joint_angle[-1]) < 0.02 and greatest(run.energy.residual) < 2e-4
    with pytest.raises(ValueError, match=r"initial_angle must lie within limits \(-0.1, 0.1\) rad, got 0.2 rad"):
        Joint(0.3, limits=(-0.1, 0.1), initial_angle=0.2)


LIMITED = """joints:
- {position: 0.3, servo: {kp: 10}, limits: [0.1, 0.3]}
- {position: 0.6, stiffness: 1, limits: [-3, -2]}
"""
URDF = """<robot name="a">
<link name="a"><collision><origin xyz="-0.2 0 0"/><geometry><box size="0.4 0.1 0.1"/></geometry></collision></link>
<link name="b"><collision><origin xyz="-0.2 0 0"/><geometry><box size="0.4 0.1 0.1"/></geometry></collision></link>
<joint name="ab" type="revolute"><parent link="a"/><child link="b"/><origin xyz="-0.4 0 0"/><axis xyz="0 0 -1"/>
<limit lower="0.1" upper="0.3" effort="3" velocity="3"/></joint></robot>"""


def robots_with_limits_beside_straight(folder):
    """Joints that cannot be straight: in Python, also behind a spring and of other signs, in YAML and in a URDF."""
    (folder / "robot.yaml").write_text(LIMITED)
    (folder / "robot.urdf").write_text(URDF)
    spring = Servo(series_stiffness=20.0, rotor_inertia=1e-6, gear=100.0)
    joints = Joint(0.3, "-yaw", limits=(0.1, 0.3), actuator=spring), Joint(0.6, "-yaw", stiffness=1.0, limits=(-3, -2))
    yield Robot(joints), [0.1, -2.0]
    yield Robot.from_file(folder / "robot.yaml"), [0.1, -2.0]
    yield Robot.from_file(folder / "robot.urdf", joints="flush"), [0.1]


def test_a_joint_may_lie_close_to_a_blunt_nose():
    """There is as much inertia ahead of it as behind; on a pointed body it is refused, with the place."""
    robot = Robot([Joint(0.05, width=0.02, actuator=Servo()), Joint(0.5, actuator=Servo())])
    body = Body.of_links(1.0, 16, half_width=0.03, half_height=0.04, joints="flush")
    coarse, fine = (simulate(straight(), 1.0, body=body, robot=robot, accuracy=each) for each in (1e-3, 1e-5))
    assert greatest(coarse.position - fine.position) < 1e-3 and greatest(fine.energy.residual) < 1e-6
    with pytest.raises(ValueError, match=r"position and width must lie behind the nose's first panel, from 0\.05 m on"):
        simulate(straight(), 1.0, robot=robot)


def test_a_joint_starts_within_its_limits(tmp_path):
    for robot, angles in robots_with_limits_beside_straight(tmp_path):
        run = simulate(straight(), 0.1, body=robot.body, robot=robot, scene=Scene(planar=True), accuracy=1e-2)
        assert run.joint_angle[0] == pytest.approx(angles, abs=1e-12) and not run.joint_rate[0].any()
        assert run.motor_angle[0] == pytest.approx(angles, abs=1e-12)
        assert run.energy.elastic[0] == pytest.approx(2.0 if len(angles) > 1 else 0.0, abs=1e-9)  # no stop is bent


def test_planar_scene_gives_what_space_gives():
    plane, space = (
        simulate(straight(), 2.0, robot=Robot.named("series_elastic"), scene=Scene(planar=planar), estimate=False)
        for planar in (True, False)
    )
    assert greatest(plane.position - space.position) < 1e-9 and greatest(plane.torque - space.torque) < 1e-6
    assert greatest(plane.motor_angle - space.motor_angle) < 1e-8


def test_copy_goes_on_to_the_last_bit():
    robot, law = Robot.named("eight_servos"), straight()
    one = Simulation(robot=robot, law=law)
    one.advance(0.777)
    other = deepcopy(one)
    for simulation in (one, other):
        simulation.advance(1.5)
    assert one.state.tobytes() == other.state.tobytes()
    assert one.observe().joints["joint_torque"].tobytes() == other.observe().joints["joint_torque"].tobytes()


def test_pitch_joints_dive():
    robot = Robot(
        [
            Joint(0.1 + 0.1 * k, axis=axis, name=f"{axis}_{k}", actuator=Servo(kp=50.0, kd=0.05))
            for k in range(8)
            for axis in ("yaw", "pitch")
        ]
    )
    run = simulate(falling(), 4.0, robot=robot, accuracy=1e-3, estimate=False)
    imposed = simulate(falling(), 4.0, accuracy=1e-3, estimate=False)
    assert greatest(run.position[-1] - imposed.position[-1]) < 0.15 * imposed.path_length
    assert run.position[-1, 2] < -0.05
    assert greatest(run.energy.residual) < 1e-4


def test_law_of_a_robot_may_have_no_pitch_joints():
    """In an axis without motors the law is imposed."""
    law = Law(Term(axis="pitch", amplitude=(0.3,), period=0.0, phase=0.5 * np.pi), *straight().terms, name="both")
    run = simulate(law, 1.0, robot=Robot.named("eight_servos"), estimate=False)
    assert np.allclose(run.curvature[-1, :, 1], 0.3)


def test_run_of_a_robot_comes_back_from_a_file(tmp_path):
    run = simulate(straight(), 0.5, robot=Robot.named("series_elastic"), accuracy=1e-3)
    run.save(tmp_path / "robot.nc")
    assert Run.load(tmp_path / "robot.nc") == run


def test_batch_of_robots_has_the_runs_of_each_and_comes_back_from_a_file(tmp_path):
    robots = [Robot.named("eight_servos"), None, Robot.named("passive_tail")]
    batch = simulate_batch(straight(), 0.5, robots=robots, accuracy=1e-3, stations=11)
    for index, robot in enumerate(robots):
        alone = simulate(straight(), 0.5, robot=robot, accuracy=1e-3, stations=11)
        assert batch[index] == alone
    assert batch.joint_angle.shape == (3, len(batch.time), 8) and batch.mode_amplitude.shape[2] == 4
    assert not batch.motor_torque[1:].any() and batch.motor_torque[0].any()
    batch.save(tmp_path / "batch.nc")
    loaded = Batch.load(tmp_path / "batch.nc")
    assert loaded == batch and loaded[2] == batch[2] and pickle.loads(pickle.dumps(batch)) == batch
    driven = Robot([Joint(0.5, actuator=Torque(lambda time: 0.01 * time))])
    with pytest.raises(ValueError, match="joint 'joint_1' torque is a function, which no file holds"):
        simulate_batch(straight(), 0.1, robots=driven, estimate=False).save(tmp_path / "driven.nc")
    with pytest.raises(ValueError, match="swimmer 0: joint"):
        simulate_batch(straight(), 0.5, robots=Robot([Joint(0.999)]))


def test_stopped_robot_names_the_part_to_blame():
    robot = Robot([Joint(0.3, name="hinge", stiffness=1e6, actuator=Servo(kp=1e3))])
    with pytest.raises(SimulationStopped, match="'hinge'"):
        simulate(straight(), 5.0, robot=robot, accuracy=1e-8, estimate=False, most_evaluations=10.0)


def test_tuned_tail_swims_fastest_at_one_stiffness():
    """Speed over bending stiffness has one peak, near 0.6 N m^2 at a period of 1 s."""
    speeds = [
        simulate(straight(), 6.0, robot=Robot([PassiveTail(0.6, EI, 0.01)]), accuracy=1e-3, estimate=False).mean_speed
        for EI in (0.075, 0.3, 0.6, 1.2, 4.8)
    ]
    best = int(np.argmax(speeds))
    assert best in (1, 2, 3), speeds
    assert (np.diff(speeds[: best + 1]) > 0.0).all() and (np.diff(speeds[best:]) < 0.0).all(), speeds


def test_momentum_and_energy_are_kept_in_vacuum():
    """A bent chain in yaw and pitch tumbles: its springs give and take."""
    robot = Robot(
        [Joint(0.15 + 0.1 * k, axis=("yaw", "pitch")[k % 2], stiffness=0.3, rest_angle=0.3) for k in range(8)]
    )
    scene = Scene(reactive=False, resistive=False, nose=False)
    spin = (0.5, 2.0, 3.0, 0.0, 0.0, 0.0)
    run = simulate(Law(name="none"), 1.0, robot=robot, scene=scene, accuracy=1e-5, twist=spin, estimate=False)
    speed = np.diff(run.center_of_mass, axis=0) / 0.05
    assert greatest(speed - speed[0]) < 3e-5 * greatest(speed)
    energy = run.energy.kinetic_body + run.energy.elastic
    assert greatest(energy - energy[0]) < 3e-5 * energy[0] and run.energy.elastic.max() > 0.01 * energy[0]


@pytest.mark.parametrize("name", READY)
def test_drag_of_a_robot_s_run_by_kind_adds_up_to_the_ledger_s(name):
    run = simulate(straight(), 2.0, robot=Robot.named(name), accuracy=1e-3, estimate=False)
    assert greatest(drag_powers(run).sum(axis=1) - run.energy.drag_power) < 1e-6 * greatest(run.energy.drag_power)
    assert "straight" in run.summary() and run.analysis().friction_power < 0.0


def test_torques_of_a_run_drive_the_same_motion_as_open_loop_torques():
    """The servos' torques, as splines over time."""
    swum = simulate(straight(), 1.5, robot=chain(kp=20.0, kd=0.2), accuracy=1e-6, sample_period=0.005, estimate=False)
    joints = [Joint(0.1 + 0.12 * k, actuator=Torque(swum.joint_torque[:, k], time=swum.time)) for k in range(8)]
    again = simulate(straight(), 1.5, robot=Robot(joints), accuracy=1e-6, sample_period=0.005, estimate=False)
    assert greatest(again.joint_angle - swum.joint_angle) < 1e-3 * greatest(swum.joint_angle)
    assert greatest(again.position - swum.position) < 1e-4


def test_a_copy_with_a_lower_limit_goes_on_from_the_present_and_keeps_it():
    robot = Robot.named("eight_servos")
    simulation = Simulation(law=straight(), robot=robot, scene=Scene(planar=True), accuracy=1e-4)
    simulation.advance(1.2)
    weak, same = (simulation.copy_with(robot=each) for each in (robot.changed(torque_limit=0.1), robot))
    for copied in (weak, same):
        assert copied.time == 1.2
        assert copied.observe().joints["joint_angle"] == pytest.approx(
            simulation.observe().joints["joint_angle"], abs=1e-14
        )
        assert copied.observe().position == pytest.approx(simulation.observe().position, abs=1e-15)
    swum = []
    for each in (simulation, same, weak):
        joints = [(each.advance(float(time)), each.observe().joints)[1] for time in np.arange(1.3, 2.31, 0.1)]
        swum.append(np.array([row["joint_angle"] for row in joints]))
        torque = greatest([row["motor_torque"] for row in joints])
        assert torque <= 0.1 if each is weak else torque > 0.2
    assert greatest(swum[1] - swum[0]) < 1e-6 and greatest(swum[2] - swum[0]) > 0.1
    other = chain(torque_limit=1.0, kp=5.0).changed("joint_1", position=0.09)
    for change in (lambda: simulation.copy_with(robot=other), lambda: simulation.change_robot(other)):
        with pytest.raises(ValueError, match="the same parts at the same places"):
            change()
    bare = Simulation(law=straight())
    bare.change_robot(Robot([]))  # which is none
    assert bare.robot is None and bare.advance(0.01)


def test_a_robot_that_is_changed_goes_on_as_a_copy_does_and_is_the_same_after_a_reset():
    robot = Robot.named("eight_servos")
    weak = robot.changed("servos", torque_limit=0.1)
    simulation = Simulation(law=straight(), robot=robot, accuracy=1e-3, measure_error=True)
    simulation.advance(0.8)
    simulation.command("joint_2", position=0.4)
    copied = simulation.copy_with(robot=weak)
    simulation.change_robot(weak)
    for each in (simulation, copied):
        each.advance(1.6)
    assert np.array_equal(simulation.observe().joints["joint_angle"], copied.observe().joints["joint_angle"])
    assert 1e-9 < simulation.error_estimate.position < 1e-3  # the companion has changed too
    simulation.reset()
    simulation.advance(0.8)
    begun = Simulation(law=straight(), robot=weak, accuracy=1e-3)
    begun.advance(0.8)
    assert np.array_equal(simulation.observe().joints["joint_angle"], begun.observe().joints["joint_angle"])
