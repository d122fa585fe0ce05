"""Energy ledger (model identity 1): the change of kinetic energy is the integral of the four powers."""

import numpy as np
import pytest
from cases import falling_law, random_law
from library_state import Scene, distance, simulate

TERMS = ("actuator_power", "wake_power", "nose_power", "drag_power")
SCENES = {
    "all": {},
    "no drag": {"resistive": False},
    "no water inertia": {"reactive": False, "friction": "laminar"},
    "current": {"current": (0.2, 0.1, -0.1), "friction": "laminar"},
    "distributed": {"tail_pressure": "distributed", "friction": "laminar"},
    "printed": {"added_mass": "printed", "perimeter": "printed"},
}


def work_of(run):
    """Integral of |actuator power| [J]: the scale of the balance."""
    return np.trapezoid(np.abs(run.energy.actuator_power), run.time)


@pytest.mark.parametrize("name", SCENES)
def test_residual_is_small(name):
    """1e-3 of the actuators' work is what the suite promises; the finest preset gives 1e-6."""
    law = falling_law()
    runs = {
        accuracy: simulate(law, duration=3.0, scene=Scene(**SCENES[name]), accuracy=accuracy, sample_period=0.05)
        for accuracy in ("standard", "reference")
    }
    for accuracy, bound in (("standard", 1e-3), ("reference", 1e-6)):
        run = runs[accuracy]
        assert np.max(np.abs(run.energy.residual)) < bound * work_of(run)


def test_powers_integrate_to_the_energy_term_by_term():
    """The published powers add up to the slope of the published energies: no term hides another."""
    law = random_law(np.random.default_rng(4), spline=False, size=0.7)
    run = simulate(law, duration=2.0, scene=Scene(friction="laminar"), accuracy="reference", sample_period=0.005)
    energy = run.energy.kinetic_body + run.energy.kinetic_fluid
    powers = sum(getattr(run.energy, term) for term in TERMS)
    slope = (energy[:-4] - 8 * energy[1:-3] + 8 * energy[3:-1] - energy[4:]) / (12 * 0.005)
    smooth = np.all(np.abs(run.time[2:-2, None] - (0.1, 0.4, 1.3, 2.0)) > 0.013, axis=1)  # away from the ramps' corners
    # fourth-order difference of a signal of 10 rad/s at 0.005 s: (0.05)^4 / 30 = 2e-7 of the power, more for harmonics
    assert distance(slope[smooth], powers[2:-2][smooth]) < 1e-5
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
