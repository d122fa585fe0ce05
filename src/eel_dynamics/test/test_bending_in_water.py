# SPDX-License-Identifier: Apache-2.0
"""Robots that weigh, that have fins, and in water that moves: against the reference, and against what must hold."""

from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.model.axes import turn_quaternion, turn_vector
from flows import FLOWS, formula
from flows import in_paper_axes as flow_in_paper_axes
from library_state import library_body
from reference import boyer_body, rotation, scene
from reference_bending import BentReference
from test_bending_reference import TURN, coordinates_of
from test_reference_bending import MIXED, WAVE
from test_weight import weighing

from eel_dynamics import (
    Accuracy,
    Body,
    Fin,
    FlowField,
    Joint,
    PassiveTail,
    Robot,
    RollHold,
    Run,
    Scene,
    Servo,
    Simulation,
    Uniform,
    simulate,
    simulate_batch,
)
from eel_gaits import Law, falling, straight

HEAVY = weighing(boyer_body(), 0.1, 0.3, 0.006, 0.5)
HELD = {"angle": RollHold(2.0, 0.15), "time_constant": 0.05}
INSIDE = (*Fin.pair(0.22, 1e-3, 2.5, dihedral=0.3, angle=0.2), Fin(0.49, "right", 1e-3, 3.0, angle=-0.3))  # of joints
YAW = Robot([Joint(0.1 + 0.12 * k, width=0.06, actuator=Servo(kp=20.0, kd=0.1)) for k in range(8)])
BOTH = Robot(
    [
        Joint(0.12 + 0.11 * k, axis=("yaw", "pitch")[k % 2], width=0.05, actuator=Servo(kp=20.0, kd=0.05))
        for k in range(8)
    ]
)


@pytest.mark.parametrize(
    ("flow", "fins", "weight", "resistive"),
    [
        (None, (), True, False),
        (None, INSIDE, False, False),
        ("shear", (), False, True),
        ("street", INSIDE, True, False),
        ("wave", INSIDE, True, True),
    ],
)
def test_accelerations_are_those_of_lagrange_s_equations(flow, fins, weight, resistive):
    """In the middle of a swim; two fins lie inside the supports of joints."""
    settings = {"resistive": resistive, "friction": "laminar", "weight": weight}
    body = HEAVY if weight else boyer_body()
    stations = [fin.station for fin in fins]
    reference = BentReference(
        body, MIXED, scene(**settings), law=WAVE, splits=stations, panels_per_span=2, nodes_per_panel=14
    )
    reference.fins = [(fin, lambda t, angle=fin.angle: angle) for fin in fins]
    if flow is not None:
        reference.flow = flow_in_paper_axes(formula(flow))
    simulation = Simulation(
        robot=MIXED,
        body=library_body(body),
        law=WAVE,
        scene=Scene(**settings),
        accuracy=Accuracy(name="dense", resolution=120.0, tolerance=1e-6),
        stations=11,
        fins=fins,
        flow=None if flow is None else FLOWS[flow][1],
        position=turn_vector((0.1, 0.05, -0.2)),
    )
    modes, time = len(reference.owner), 0.6
    simulation.advance(time)
    now, x, rate, acceleration = coordinates_of(simulation)
    axes, place = rotation(turn_quaternion(now.orientation)), turn_vector(now.position)
    reference.up, reference.height = axes[2], place[2]
    reference.pose = SimpleNamespace(position=place, axes=axes, time=time)
    twist, found = now.twist * TURN, now.head_acceleration * TURN
    head, qddot, thdd = reference.bent_accelerations(time, twist, x[:modes], rate[:modes], x[modes:], rate[modes:])
    found = found - np.concatenate([np.zeros(3), np.cross(twist[:3], twist[3:])])
    close = 1e-4 if resistive else 1e-7  # kinks of the drag; without, the condition of the mass matrix
    assert np.abs(acceleration[:modes] - qddot).max() < close * np.abs(qddot).max()
    assert np.abs(acceleration[modes:] - thdd).max() < close * np.abs(thdd).max()
    assert np.abs(found - head).max() < close * np.abs(head).max()


STREET, WATER = FLOWS["street"][1], FLOWS["street"][1] + FLOWS["wave"][1] + FLOWS["shear"][1]
COMBINED = {  # name: law, arguments, tolerance of steps, duration
    "joints in a street": (straight(), {"robot": YAW, "flow": STREET}, 1e-9, 0.5),
    "tail in waves": (
        straight(),
        {"robot": Robot([PassiveTail(0.6, 0.6, 0.02)]), "flow": FLOWS["wave"][1]},
        1e-9,
        0.5,
    ),
    "heavy, yaw and pitch": (
        falling(),
        {"robot": BOTH, "body": library_body(HEAVY), "scene": Scene(weight=True)},
        1e-8,
        0.5,
    ),
    "fins in a shear": (
        falling(),
        {"robot": BOTH, "fins": [Fin.pair(0.2, 1e-3, 2.5, **HELD)], "flow": FLOWS["shear"][1]},
        1e-8,
        0.5,
    ),
    "all": (
        WAVE,
        {
            "robot": MIXED,
            "body": library_body(HEAVY),
            "scene": Scene(weight=True),
            "fins": [*INSIDE, *Fin.pair(0.8, 5e-4, 2.5, **HELD)],
            "flow": WATER,
        },
        1e-8,
        0.3,
    ),
}


@pytest.mark.parametrize("name", COMBINED)
def test_the_ledger_of_a_marched_motion_closes(name):
    """The march has momenta, the powers accelerations: an error in either form gives energy from nowhere."""
    law, others, tolerance, duration = COMBINED[name]
    finest = Accuracy(name="finest", resolution=40.0, tolerance=tolerance)
    run = simulate(law, duration, accuracy=finest, estimate=False, **others)
    assert np.abs(run.energy.residual).max() < 1e-8 and np.abs(run.energy.actuator_work).max() > 1e-2
    assert run.closure_force.max() < 1e-11


def test_a_planar_robot_in_a_plane_flow_swims_as_in_space():
    flow = FLOWS["vortex"][1]
    plane, space = (
        simulate(straight(), 0.5, robot=YAW, flow=flow, scene=Scene(planar=planar), accuracy=1e-4, estimate=False)
        for planar in (True, False)
    )
    assert np.abs(plane.position - space.position).max() < 1e-9
    assert np.abs(plane.energy.flow_power - space.energy.flow_power).max() < 1e-9 < space.energy.flow_power.max()


def test_water_that_carries_a_robot_along_is_still_water():
    """A steady stream from the start on, with fins; and water that accelerates, which adds its own displacement."""
    u, a = np.array([0.2, -0.1, 0.05]), np.array([1.0, -0.5, 0.4])
    options = {
        "robot": BOTH,
        "fins": [Fin.pair(0.4, 1e-3, 2.5, angle=0.2)],
        "accuracy": Accuracy(name="steps", resolution=30.0, tolerance=1e-9),
        "estimate": False,
    }
    still = simulate(falling(), 0.4, **options)
    steady = simulate(falling(), 0.4, flow=Uniform(tuple(u)), twist=(0, 0, 0, *u), **options)
    none = lambda x, t: np.zeros((len(x), 3, 3))  # noqa: E731
    faster = FlowField(lambda x, t: 0 * x + a * t, jacobian=none, rate=lambda x, t: 0 * x + a)
    pushed = simulate(falling(), 0.4, flow=faster, **options)
    time = still.time[:, None]
    for run, gone in ((steady, u * time), (pushed, 0.5 * a * time**2)):
        assert np.abs(run.position - gone - still.position).max() < 1e-7
        assert np.abs(run.joint_angle - still.joint_angle).max() < 1e-6
        assert np.abs(run.torque - still.torque).max() < 1e-5 * np.abs(still.torque).max()


def test_a_trimmed_robot_at_rest_stays_at_rest():
    body = Body.boyer2010().changed(centre_of_mass_offset=0.005)
    robot = Robot([Joint(0.3, stiffness=1.0), Joint(0.6, "pitch", stiffness=1.0)])
    fins = [Fin.pair(0.2, 1e-3, 2.5)]
    run = simulate(Law(name="none"), 1.0, robot=robot, body=body, scene=Scene(weight=True), fins=fins)
    assert np.abs(run.position).max() < 1e-12 and np.abs(run.joint_angle).max() < 1e-10


def test_fins_hold_the_roll_of_a_robot():
    """A push: without fins the servos' swim rolls over."""
    push = {"robot": Robot.named("eight_servos"), "twist": (0.3, 0, 0, 0.3, 0, 0), "accuracy": 1e-2, "estimate": False}
    rolled, held = (simulate(straight(), 6.0, fins=fins, **push) for fins in (None, [Fin.pair(0.2, 1e-3, 2.5, **HELD)]))
    roll = [2.0 * np.abs(np.unwrap(np.arctan2(*run.orientation.T[[0, 3]]))).max() for run in (rolled, held)]
    assert roll[1] < 0.1 < 0.4 < roll[0], roll


def test_such_runs_are_estimated_saved_and_in_batches(tmp_path):
    options = {"flow": FLOWS["shear"][1], "robot": YAW, "accuracy": 1e-3, "stations": 11}
    run = simulate(straight(), 0.5, fins=[Fin.pair(0.2, 1e-3, 2.5)], **options)
    assert run.error_estimate.worst < 1e-3
    run.save(tmp_path / "run.nc")
    assert Run.load(tmp_path / "run.nc") == run
    one = {"flows" if name == "flow" else "robots" if name == "robot" else name: v for name, v in options.items()}
    assert simulate_batch(straight(), 0.5, **one)[0] == simulate(straight(), 0.5, **options)
