# SPDX-License-Identifier: Apache-2.0
"""Energy ledger: the change of kinetic energy is the integral of the four powers."""

import numpy as np
import pytest
from cases import falling_law, random_law
from draws import few, scenes, swimmers, twists
from hypothesis import given
from library_state import Reference, Scene, distance, library_body, reference_scene, rotation
from library_state import simulate_in_paper_axes as simulate
from scipy.interpolate import make_interp_spline

pytestmark = pytest.mark.identity("Energy ledger")
TERMS = ("actuator_power", "wake_power", "nose_power", "drag_power")
WORKS = ("actuator_work", "wake_work", "nose_work", "drag_work")
SCENES = {
    "all": {},
    "no drag": {"resistive": False},
    "no water inertia": {"reactive": False, "friction": "laminar"},
    "no wake": {"wake": False, "friction": "laminar"},
    "current": {"current": (0.2, 0.1, -0.1), "friction": "laminar"},
    "distributed": {"tail_pressure": "distributed", "friction": "laminar"},
    "printed": {"added_mass": "printed", "perimeter": "printed"},
    "righting moment": {"metacentric_height": 0.01, "friction": "laminar"},
}


def turnover(run):
    """Integral of the magnitudes of all four powers [J]: the scale of the balance."""
    return sum(np.trapezoid(np.abs(getattr(run.energy, term)), run.time) for term in TERMS)


@pytest.mark.parametrize("name", SCENES)
def test_residual_is_small(measured, name):
    """1e-3 of the actuators' work is what the suite promises at its standard accuracy; the finest preset gives 1e-6."""
    law = falling_law()
    for accuracy, bound in (("standard", 1e-3), ("reference", 1e-6)):
        run = simulate(law, duration=3.0, scene=Scene(**SCENES[name]), accuracy=accuracy, sample_period=0.05)
        work = np.trapezoid(np.abs(run.energy.actuator_power), run.time)
        what = f"residual, 3 s of the falling gait, eight scenes, accuracy {accuracy} (by the actuators' work)"
        measured(what, np.max(np.abs(run.energy.residual)) / work, bound)


@few(12)
@given(swimmers(ramps=True), twists(), scenes(drag=True))
def test_residual_of_any_swimmer(measured, swimmer, twist, settings):
    """Preset fine: 1e-8 per step, at some hundred steps a second; by the turnover, as actuators may do little."""
    body, law = swimmer
    run = simulate(law, 1.5, body=library_body(body), scene=Scene(**settings), accuracy="fine", twist=twist)
    error = np.max(np.abs(run.energy.residual)) / turnover(run)
    measured("residual, any swimmer, accuracy fine (by all work turned over)", error, 1e-5)


@few(3)
@given(swimmers(), twists(), scenes(nose=True), scenes(drag=True, nose=True))
def test_works_term_by_term(measured, swimmer, twist, without_drag, with_drag):
    """Each work of the ledger is the integral of its published power, and this is the reference's own power.

    The reference takes the head's motion from the run and nothing else; its torque comes from the strong form. Light
    bodies roll at up to 33 rad/s: splines of order 8 integrate a power through samples 1 ms apart to 1e-9 or better,
    and through samples 5 ms apart to 1e-5 only. Of 300 other draws the worst power is off by 2.4e-7 without drag, where
    a wave is short; with drag by 2.3e-3, for kinks of V|V| between the reference's nodes. Kinks in time smooth a work.
    """
    for each in (without_drag, with_drag):
        check_works(measured, swimmer, twist, each)


def check_works(measured, swimmer, twist, settings):
    (body, law), scene = swimmer, Scene(**settings)
    run = simulate(
        law, 0.3, body=library_body(body), scene=scene, accuracy="reference", sample_period=0.001, twist=twist
    )
    reference, powers = Reference(body, reference_scene(**settings)), []
    seldom = slice(None, None, 10)
    motion = run.time, run.orientation, run.twist, run.head_acceleration
    for time, q, given_twist, rate in zip(*(each[seldom] for each in motion), strict=True):
        relative, relative_rate = given_twist.copy(), rate.copy()
        relative[3:] -= rotation(q).T @ np.asarray(settings["current"])
        relative_rate[3:] -= np.cross(relative[:3], relative[3:])
        fields = reference.fields(*law.curvature(time, reference.space.x), relative, relative_rate)
        powers.append([getattr(fields, term) for term in TERMS])
    for term, work, independent in zip(TERMS, WORKS, np.transpose(powers), strict=True):
        power, done = getattr(run.energy, term), getattr(run.energy, work)
        if term == "drag_power" and not settings["resistive"]:
            assert np.all(done == 0.0)
            continue
        size = np.abs(power).max() + 1e-6 * turnover(run)
        kind = "with drag" if settings["resistive"] else "without drag"
        name = "actuators'" if term == "actuator_power" else work.replace("_work", "'s")
        wrong = np.max(np.abs(power[seldom] - independent)) / size
        measured(f"{name} power against an independent one, {kind}", wrong, 5e-3 if settings["resistive"] else 1e-6)
        wanted = make_interp_spline(run.time, power, k=7).antiderivative()(run.time)
        wrong = np.max(np.abs(done - wanted)) / size
        bound = 1e-5 if settings["resistive"] else 1e-7
        measured(f"{name} work against the integral of its power, {kind}", wrong, bound)


def test_powers_integrate_to_the_energy_term_by_term(measured):
    """The published powers add up to the slope of the published energies: no term hides another."""
    law = random_law(np.random.default_rng(4), spline=False, size=0.7)
    run = simulate(law, duration=2.0, scene=Scene(friction="laminar"), accuracy="reference", sample_period=0.005)
    energy = run.energy.kinetic_body + run.energy.kinetic_fluid
    powers = sum(getattr(run.energy, term) for term in TERMS)
    slope = (energy[:-4] - 8 * energy[1:-3] + 8 * energy[3:-1] - energy[4:]) / (12 * 0.005)
    smooth = np.all(np.abs(run.time[2:-2, None] - (0.1, 0.4, 1.3, 2.0)) > 0.013, axis=1)  # away from the ramps' corners
    # fourth-order difference of a signal of 10 rad/s at 0.005 s: (0.05)^4 / 30 = 2e-7 of the power, more for harmonics
    measured("sum of the powers against the slope of the energy", distance(slope[smooth], powers[2:-2][smooth]), 1e-5)
    for term in TERMS:
        assert np.max(np.abs(getattr(run.energy, term))) > 1e-6 * np.max(np.abs(powers)), term


def test_wake_power_is_positive_where_the_tail_leads():
    """Backwards at 1 m/s, sideways too: V1(l) > 0, and the wake gives energy (a limit of the theory, kept)."""
    run = simulate(
        random_law(np.random.default_rng(1), size=0.01),
        duration=0.05,
        twist=(0, 0, 0, 1.0, 0.3, 0.0),
        scene=Scene(resistive=False),
        accuracy="fine",
        sample_period=0.05,
    )
    assert run.energy.wake_power[0] > 0


def test_ledger_off_leaves_the_motion_and_drops_the_energies():
    law = falling_law()
    on, off = (simulate(law, duration=1.0, scene=Scene(ledger=ledger), sample_period=0.25) for ledger in (True, False))
    assert off.energy is None
    assert np.array_equal(on.position, off.position)
