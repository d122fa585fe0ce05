# SPDX-License-Identifier: Apache-2.0
"""No fluid, or water that sheds no wake: linear and angular momentum stay, energy is the actuators' work."""

import numpy as np
import pytest
from cases import falling_law
from draws import few, swimmers, twists
from hypothesis import example, given
from library_state import Reference, Scene, distance, library_body, reference_scene, rotation
from library_state import simulate_in_paper_axes as simulate
from reference import boyer_body
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

pytestmark = pytest.mark.identity("No water")
VACUUM = {"reactive": False, "resistive": False}
START = np.array([0.3, 0.2, -0.4, -0.5, 0.1, 0.2])
# Dormand and Prince's pair with 1e-10 per step over 2 s of some 300 steps: a bound above what is measured.
TOLERANCE = 1e-7


def momenta(reference, law, run, samples=slice(None)):
    """(T, 6) angular (about the origin) and linear momentum in world axes, by the reference's own integrals."""
    out = []
    heads = run.time[samples], run.position[samples], run.orientation[samples], run.twist[samples]
    for time, position, q, twist in zip(*heads, strict=True):
        L, P = np.split(reference.momentum(*law.curvature(time, reference.space.x)[:2], twist), 2)
        L, P = rotation(q) @ L, rotation(q) @ P
        out.append(np.concatenate([L + np.cross(position, P), P]))
    return np.array(out)


@few(4)
@given(swimmers(ramps=True), twists())
@example((boyer_body(), falling_law()), START)
def test_momentum_and_energy(measured, swimmer, twist):
    """The momenta are the reference's, of the run's pose and twist; the energies are the ledger's."""
    body, law = swimmer
    run = simulate(
        law,
        2.0,
        body=library_body(body),
        scene=Scene(**VACUUM),
        accuracy="reference",
        sample_period=0.1,
        twist=twist,
    )
    reference = Reference(body, reference_scene(**VACUUM), panels_per_span=1, nodes_per_panel=24)
    L, P = np.split(momenta(reference, law, run), 2, axis=1)
    size = np.linalg.norm(P[0])
    measured("linear momentum over 2 s, any swimmer", np.ptp(P, axis=0) / size, TOLERANCE)
    measured(
        "angular momentum over 2 s (by body length times momentum)",
        np.ptp(L, axis=0) / size / body.kinks[-1],
        TOLERANCE,
    )
    line = run.center_of_mass[0] + np.outer(run.time, P[0]) / run.body_mass
    measured("centre of mass against P t / m", distance(run.center_of_mass, line, body.kinks[-1]), TOLERANCE)

    kinetic, ledger = run.energy.kinetic_body, run.energy
    assert np.all(ledger.kinetic_fluid == 0)
    assert all(np.all(getattr(ledger, name) == 0) for name in ("wake_power", "nose_power", "drag_power"))
    apart = np.abs(kinetic - kinetic[0] - ledger.actuator_work) / kinetic.max()
    measured("kinetic energy gained against the work of the actuators", apart, TOLERANCE)
    assert np.ptp(kinetic) > 1e-3 * kinetic.max()  # it is not trivially constant


def test_without_a_wake_body_and_water_keep_their_momentum(measured):
    """A perfect fluid without vorticity takes no momentum away; with the wake the same gait loses and gains it."""
    law, changes = falling_law(), {}
    for wake in (False, True):
        scene = {"resistive": False, "nose": False, "wake": wake}
        run = simulate(law, 1.5, scene=Scene(**scene), accuracy="reference", sample_period=0.1, twist=START, stations=2)
        reference = Reference(boyer_body(), reference_scene(**scene), panels_per_span=1, nodes_per_panel=24)
        along = momenta(reference, law, run)
        changes[wake] = np.ptp(along, axis=0).max() / np.linalg.norm(along[0])
        assert np.all(run.energy.wake_power == 0.0) != wake
        assert np.abs(run.energy.residual).max() < 1e-6 * np.abs(run.energy.kinetic_fluid).max()
    measured("momentum of body and water over 1.5 s, no wake, no drag", changes[False], TOLERANCE)
    assert changes[True] > 0.1


@pytest.mark.parametrize("resistive", (False, True))
def test_what_body_and_water_lose_in_momentum_is_what_the_tail_gives_to_the_wake(measured, resistive):
    """The momentum is the reference's, of the run's pose and twist; the rate is the run's, integrated by splines.

    With drag, its integral over the body is lost too; V|V| has kinks between the nodes of that quadrature.
    """
    law, scene = falling_law(), {"resistive": resistive, "nose": False, "friction": "laminar"}
    reference = Reference(boyer_body(), reference_scene(**scene), panels_per_span=1, nodes_per_panel=24)
    x, weights = reference.space.x, reference.space.weights
    stations = np.append(x, reference.space.ends[-1])  # and the tail
    run = simulate(
        law,
        1.5,
        scene=Scene(**scene),
        accuracy="reference",
        sample_period=0.005,
        stations=stations,
        load=True,
        estimate=False,
    )
    every = slice(None, None, 30)
    P = momenta(reference, law, run, every)[:, 3:]
    frames = Rotation.from_quat(run.section_orientation.reshape(-1, 4)).as_matrix()
    frames = frames.reshape(*run.section_orientation.shape[:2], 3, 3)
    to_wake = np.einsum("tij,tj->ti", frames[:, -1], run.wake_momentum_rate)
    drag = np.einsum("x,txij,txj->ti", weights, frames[:, :-1], run.resistive_force[:, :-1])
    lost = make_interp_spline(run.time, to_wake - drag, k=7).antiderivative()(run.time[every])
    lost -= lost[0]
    turned_over = np.trapezoid(np.linalg.norm(to_wake, axis=1), run.time)
    what = f"momentum lost against that given to the wake{' and taken by drag' if resistive else ''}, 1.5 s"
    measured(what, np.abs(P[0] - P - lost) / turned_over, 1e-5 if resistive else 1e-7)
    assert np.linalg.norm(lost[-1]) > 0.01 * turned_over
