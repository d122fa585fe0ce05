# SPDX-License-Identifier: Apache-2.0
"""The reference of bodies that bend by themselves against what must hold without it; and the tables against it."""

from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.model.robot.compiled import mode_table
from reference import Reference, boyer_body, rotation, scene
from reference_bending import BentReference

from eel_dynamics import Body, Joint, Muscle, PassiveTail, Robot, Servo, Torque
from eel_gaits import Law, Ramp, Term, falling

SPACE = {"panels_per_span": 1, "nodes_per_panel": 12}
BEAM = SimpleNamespace(
    half_width=lambda x: 0.005 + 0 * x,
    half_height=lambda x: 0.03 + 0 * x,
    kinks=(0.0, 1.0),
    nose=(0, 0, 0),
    density=1000.0,
)
WAVE = Law(
    Term(axis="yaw", amplitude=(1.0, 0.5, 2.0), wavelength=1.0, period=1.0, envelope=(Ramp(0.0, 1.0, 1.0),)),
    Term(axis="pitch", amplitude=(0.6,), wavelength=-0.8, period=0.7, phase=0.4),
)
LEGENDRE = PassiveTail(0.0, 2.0, modes=8)
SERVO = Servo(kp=8.0, kd=0.1, torque_limit=0.5, speed_limit=6.0, gear=50.0, rotor_inertia=1e-7, friction=0.01)
MIXED = Robot(
    [
        Joint(0.2, "-yaw", width=0.1, stiffness=1.0, damping=0.02, rest_angle=0.1, actuator=SERVO),
        Joint(
            0.35,
            "pitch",
            width=0.06,
            damping=0.01,
            limits=(-0.1, 0.05),
            actuator=Torque([0.1, 0.3, 0.0], time=[0.0, 1.0, 2.0]),
        ),
        Joint(0.5, width=0.05, actuator=Servo(kp=5.0, rotor_inertia=2e-4, series_stiffness=20.0, series_damping=0.01)),
        Muscle(0.55, 0.7, lambda x: 2.0 * x, 0.02, Law(Term(amplitude=(0.3,), period=0.9, wavelength=0.5)), modes=2),
        PassiveTail(0.75, 0.6, 0.01, modes=3),
        PassiveTail(0.7, 0.8, lambda x: 0.1 * x, modes=2, axis="pitch", name="fin"),
    ]
)


def state_of(robot, reference, size=0.3):
    """Twist, q, qdot, th, thdot at random."""
    modes, motors, random = len(reference.owner), len(reference.series), np.random.default_rng(44)
    return [size * random.standard_normal(count) for count in (6, modes, modes, motors, motors)]


@pytest.mark.parametrize(
    "settings", [scene(), scene(reactive=False, resistive=False, nose=False), scene(metacentric_height=0.02)]
)
def test_generalised_torques_are_the_strong_form_s_torque_projected_on_the_modes(settings):
    """integral B . C dX = Q + armature qddot: Lagrange's equations against eq. (50) integrated from the nose."""
    reference = BentReference(boyer_body(), MIXED, settings, law=WAVE, **SPACE)
    time, (mu, q, qdot, th, thdot) = 0.83, state_of(MIXED, reference)
    _, qddot, _ = reference.bent_accelerations(time, mu, q, qdot, th, thdot)
    motion = reference.bent_motion(time, mu, q, qdot, th, thdot)
    found = reference.fields(*motion)
    torque = np.einsum("mxi,xi,x->m", reference.shapes, found.torque, reference.space.weights)
    Q, _, _ = reference.forces(time, q, qdot, th, thdot)
    # the tail's condition is met: the modes and the head have the accelerations of the whole balance
    assert np.max(np.abs(found.tail_residual)) < 1e-7 * np.max(np.abs(found.torque))  # inertia of condition 1e8
    assert torque == pytest.approx(Q + reference.armature * qddot, abs=1e-8 * np.max(np.abs(Q)))


def test_modes_that_follow_the_imposed_motion_have_its_acceleration():
    """With the torques that the imposed motion needs, the free body keeps to it."""
    robot = Robot([Joint(0.3, width=0.1), Joint(0.6, "pitch", width=0.1)])
    reference = BentReference(boyer_body(), robot, scene(friction="laminar"), law=Law(), **SPACE)
    mu, q, qdot, *_ = state_of(robot, reference)
    qddot = np.array([3.0, -2.0])
    K, K_rate = reference.shape(reference.imposed(0.0), q, qdot)
    K_acceleration = np.einsum("m,mxi->xi", qddot, reference.shapes)
    imposed = Reference.acceleration(reference, K, K_rate, K_acceleration, mu)
    torque = reference.fields(K, K_rate, K_acceleration, mu, imposed).torque
    Q = np.einsum("mxi,xi,x->m", reference.shapes, torque, reference.space.weights)
    reference.forces = lambda *_: (Q, np.zeros(0), None)
    mu_rate, found, _ = reference.bent_accelerations(0.0, mu, q, qdot)
    assert mu_rate == pytest.approx(imposed, rel=1e-9) and found == pytest.approx(qddot, rel=1e-9)


def frequencies(settings, modes=8):
    reference = BentReference(
        BEAM, Robot([PassiveTail(0.0, 2.0, modes=modes)]), settings, law=Law(), nodes_per_panel=24
    )
    matrix = reference.whole_matrix(np.zeros_like(reference.shapes[0]))
    inner = matrix[6:, 6:] - matrix[6:, :6] @ np.linalg.solve(matrix[:6, :6], matrix[:6, 6:])
    shapes = reference.shapes[:, :, 2]
    stiffness = 2.0 * (shapes * reference.space.weights) @ shapes.T
    return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(inner, stiffness)).real))


def test_a_free_free_beam_has_the_frequencies_of_euler_and_bernoulli():
    """2 N m^2, 0.4712 kg/m, 1 m: the roots 4.7300, ... of cos x cosh x = 1. In water by the added mass lower."""
    vacuum = scene(reactive=False, resistive=False, nose=False)
    dry = frequencies(vacuum)
    mass = 1000.0 * np.pi * 0.03 * 0.005
    exact = np.array([4.730041, 7.853205, 10.995608]) ** 2 * np.sqrt(2.0 / mass)
    assert dry[:3] == pytest.approx([46.0847, 127.011, 249.348], rel=2e-6)
    assert np.abs(dry[:3] / exact - 1.0) == pytest.approx(
        [1.6e-4, 3.4e-4, 1.1e-3], rel=0.1
    )  # rotary inertia; few modes
    assert frequencies(vacuum, 3)[0] / exact[0] == pytest.approx(1.008, abs=1e-3)
    wet = frequencies(scene(resistive=False, nose=False))
    lowered = np.sqrt(mass / (mass + 1000.0 * np.pi * 0.03**2))
    assert np.abs(wet[:3] / dry[:3] / lowered - 1.0) == pytest.approx([1.3e-4, 2.9e-4, 5.0e-4], rel=0.1)


FREE = scene(reactive=False, resistive=False, nose=False)
SPRUNG = Robot(
    [
        Joint(0.3, width=0.1, stiffness=2.0),
        Joint(0.5, "pitch", width=0.1, stiffness=1.0),
        PassiveTail(0.6, 0.5, modes=2),
    ]
)


def test_momentum_is_kept_in_vacuum():
    reference = BentReference(boyer_body(), SPRUNG, FREE, law=Law(), **SPACE)
    mu, q, qdot, *_ = state_of(SPRUNG, reference, size=2.0)
    motion = reference.bent_motion(0.0, mu, q, qdot)
    scale = np.abs(reference.momentum_rate(*motion[:3], mu, np.zeros(6)))
    assert np.abs(reference.momentum_rate(*motion)) == pytest.approx(np.zeros(6), abs=1e-11 * scale.max())


def test_a_march_keeps_momentum_and_energy_in_vacuum():
    reference = BentReference(boyer_body(), SPRUNG, FREE, law=Law(), panels_per_span=1, nodes_per_panel=8)
    q, qdot, twist = np.array([0.5, -0.4, 0.8, 0.3]), np.array([1.0, 2.0, -1.0, 0.5]), (0.5, -1.0, 2.0, -0.3, 0.1, 0.2)
    position, quaternion, twist, q, qdot, *_ = reference.bent_march(
        np.array([0.0, 0.02]), q, qdot, twist=twist, rtol=1e-8
    )
    kept = []
    for k in range(2):
        K, K_rate = reference.shape(reference.imposed(0.0), q[k], qdot[k])
        L, P = np.split(reference.momentum(K, K_rate, twist[k]), 2)
        world = rotation(quaternion[k] / np.linalg.norm(quaternion[k]))
        elastic = reference.forces(0.0, q[k], qdot[k], np.zeros(0), np.zeros(0))[2].elastic
        energy = sum(reference.energies(K, K_rate, twist[k])) + elastic
        kept.append(np.concatenate([world @ P, world @ L + np.cross(position[k], world @ P), [energy]]))
    assert np.ptp(kept, axis=0) == pytest.approx(np.zeros(7), abs=1e-7)


def test_the_ledger_closes_along_the_motion():
    """d/dt (T + U + motors' T) = motors - losses - integral C . imposed rate + wake + nose + drag, by small steps."""
    reference = BentReference(boyer_body(), MIXED, scene(friction="laminar"), law=WAVE, **SPACE)
    mu, q, qdot, th, thdot = state_of(MIXED, reference)
    time, step = 0.83, 1e-7
    mu_rate, qddot, thdd = reference.bent_accelerations(time, mu, q, qdot, th, thdot)
    found = reference.fields(*reference.bent_motion(time, mu, q, qdot, th, thdot))
    *_, ledger = reference.forces(time, q, qdot, th, thdot)
    inertia = np.array([reference.owner[m].actuator.reflected_inertia for m in reference.series])

    def energy(h):
        moved = q + h * qdot + h * h / 2 * qddot, qdot + h * qddot
        motors = th + h * thdot + h * h / 2 * thdd, thdot + h * thdd
        K, K_rate = reference.shape(reference.imposed(time + h), *moved)
        kinetic = sum(reference.energies(K, K_rate, mu + h * mu_rate)) + reference.armature @ moved[1] ** 2 / 2
        kinetic += inertia @ motors[1] ** 2 / 2
        return kinetic + reference.forces(time + h, *moved, *motors)[2].elastic

    gained = (energy(step) - energy(-step)) / (2 * step)
    _, imposed_rate, _ = reference.imposed(time)
    imposed = -reference.space.weights @ np.sum(found.torque * imposed_rate, axis=1)
    powers = ledger.motor - ledger.lost + imposed + found.wake_power + found.nose_power + found.drag_power
    assert gained == pytest.approx(powers, rel=1e-6)  # round-off of an energy of 1 J over 2e-7 s


def torques_of_table(table, time, law, q, qdot, th, thdot):
    """Q (M,) of a `mode_table`, by the formulas of its docstrings."""
    x, xdot, M = np.concatenate((q, th)), np.concatenate((qdot, thdot)), len(table)
    Q = table.stiffness @ (x - table.rest) + table.damping @ xdot
    low, high = np.minimum(q - table.limits[:, 0], 0.0), np.maximum(q - table.limits[:, 1], 0.0)
    inwards = table.stop_damping * qdot * np.where(low < 0.0, -1.0, 1.0)
    Q[:M] += (low + high) * np.maximum(0.0, table.stop_stiffness + inwards)
    value, rate, _ = law.curvature(time, table.points)
    reference, reference_rate = (np.sum(table.projection * each[:, table.axis].T, axis=1) for each in (value, rate))
    for mode, torque in table.torques:
        Q[mode] -= table.sign[mode] * torque.at(time)
    for servo, mode, own in table.motors:
        limit, fastest = servo.torque_limit, servo.speed_limit or np.inf
        tau = servo.kp * (reference[mode] - x[own]) + servo.kd * (reference_rate[mode] - xdot[own])
        if limit is not None:
            below, above = np.clip(1 + xdot[own] / fastest, 0, 1), np.clip(1 - xdot[own] / fastest, 0, 1)
            tau = np.clip(tau, -limit * below, limit * above)
        Q[own] -= tau
    for muscle in table.muscles:
        moment = muscle.moment.curvature(time, muscle.points)[0][:, table.axis[muscle.modes[0]]]
        Q[muscle.modes] -= muscle.projection @ moment
    return Q[:M]


@pytest.mark.parametrize("time", [0.3, 1.7])
def test_tables_give_the_reference_s_torques(time):
    for robot in (MIXED, Robot.named("eight_servos"), Robot.named("series_elastic"), Robot.named("passive_tail")):
        reference = BentReference(boyer_body(), robot, law=falling(), **SPACE)
        _, q, qdot, th, thdot = state_of(robot, reference)
        table = mode_table(robot, Body.boyer2010())
        Q = torques_of_table(table, time, falling(), q, qdot, th, thdot)
        assert pytest.approx(reference.forces(time, q, qdot, th, thdot)[0], abs=1e-10) == Q
        assert table.armature[: len(table)] == pytest.approx(reference.armature)
        free = reference.imposed(time)[0]
        law = falling().curvature(time, reference.space.x)[0]
        assert np.allclose(free[:, 1:], law[:, 1:] * table.imposed(reference.space.x).T, atol=1e-15)
