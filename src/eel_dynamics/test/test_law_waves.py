# SPDX-License-Identifier: Apache-2.0
"""How many waves a law has on the body: small ones do not count, and the grid without them is fine enough."""

import numpy as np
import pytest
from eel_dynamics.accuracy import law_waves
from eel_dynamics.accuracy.law_waves import LEAST_WIGGLE, check_law
from eel_dynamics.analysis.measures import AT_END, MEASURES, OF_ESTIMATE, OF_LEDGER, OF_WRENCH, measures_of

from eel_dynamics import Scene, Simulation, simulate
from eel_gaits import Law, Term, straight

KNOTS = tuple(np.linspace(0.0, 1.0, 15).tolist())


def spline(values) -> Law:
    return Law(
        Term(amplitude=tuple(np.asarray(values).tolist()), knots=KNOTS, wavelength=1.0, period=1.0), name="spline"
    )


def flat_but_one(part: float) -> Law:
    """Fifteen equal amplitudes, one of them moved by a `part` of it."""
    values = np.full(15, 0.5)
    values[7] *= 1.0 + part
    return spline(values)


def nodes_of(law: Law) -> int:
    return len(Simulation(law=law).grid.x)


@pytest.mark.parametrize("part", [1e-15, 1e-9, 1e-6, -1e-6, 1e-4, 0.5 * LEAST_WIGGLE])
def test_small_changes_of_a_flat_spline_do_not_change_its_grid(part):
    assert nodes_of(flat_but_one(part)) == nodes_of(flat_but_one(0.0)) == 80


def test_waves_that_are_not_small_count():
    rough = 0.5 + 0.2 * (-1.0) ** np.arange(15)
    assert check_law(spline(rough), 1.0) > 3.0 * check_law(flat_but_one(0.0), 1.0)
    assert nodes_of(flat_but_one(0.5)) > 2 * nodes_of(flat_but_one(0.0))


@pytest.mark.parametrize("seed", range(20))
def test_turns_are_those_of_a_curve_whose_noise_is_below_the_threshold(seed):
    """Of a sine with clear turns: noise of less than the threshold adds none, and a flat part is none."""
    draw = np.random.default_rng(seed)
    x = np.linspace(0.0, 1.0, 1025)
    values = 1.0 + 0.5 * np.sin(2.0 * np.pi * (draw.integers(1, 9) * x + draw.uniform(-0.1, 0.1)))  # none at the ends
    plain = law_waves._turns(values)
    clear = np.flatnonzero(np.diff(np.sign(np.diff(values)))) + 1
    assert plain == clear.tolist()
    noisy = values + 0.4 * LEAST_WIGGLE * draw.uniform(-1.0, 1.0, len(x))
    found = law_waves._turns(noisy)
    assert len(found) == len(plain) and np.abs(np.array(found) - plain).max() < 30
    assert law_waves._turns(np.full(1025, 2.0)) == [] == law_waves._turns(np.sort(values))


@pytest.mark.parametrize("accuracy", [1e-3, "standard"])
def test_a_swim_whose_small_waves_are_not_counted_meets_its_target(accuracy, monkeypatch):
    values = 0.5 * (1.0 + 0.35 * LEAST_WIGGLE * (-1.0) ** np.arange(15))  # the worst: all but counted
    run = simulate(spline(values), 2.0, accuracy=accuracy, estimate=False)
    assert run.nodes < 100
    monkeypatch.setattr(law_waves, "LEAST_WIGGLE", 0.0)
    for cached in (law_waves._wiggles, law_waves._waves, check_law):
        cached.cache_clear()
    fine = simulate(spline(values), 2.0, accuracy=1e-7, estimate=False)
    for cached in (law_waves._wiggles, law_waves._waves, check_law):
        cached.cache_clear()
    assert fine.nodes > 2 * run.nodes
    target = run.accuracy.target
    assert np.abs(run.position - fine.position).max() <= target * max(1.0, fine.path_length)
    assert np.abs(run.torque - fine.torque).max() <= target * np.abs(fine.torque).max()


def test_each_measure_needs_what_it_is_said_to_need_and_no_more():
    names = [name for name in MEASURES if name not in OF_ESTIMATE]
    whole = measures_of(simulate(straight(), 4.0, estimate=False), names)
    spare = {
        "motion": ({}, [name for name in names if name not in OF_LEDGER | OF_WRENCH]),
        "ledger": ({"ledger": True}, [name for name in names if name in OF_LEDGER]),
        "wrench": ({"internal_wrench": True}, [name for name in names if name in OF_WRENCH]),
    }
    for part, (settings, of) in spare.items():
        scene = Scene(**{"ledger": False, "internal_wrench": False} | settings)
        found = measures_of(simulate(straight(), 4.0, scene=scene, estimate=False), of)
        for name in set(of) - {"evaluations", "ledger_residual"}:  # of the way, not of the motion
            assert found[name] == pytest.approx(whole[name], rel=1e-3), (part, name)
    none = measures_of(
        simulate(straight(), 4.0, scene=Scene(ledger=False, internal_wrench=False), estimate=False), names
    )
    assert {name for name in names if np.isnan(none[name])} == (OF_LEDGER | OF_WRENCH) - set(OF_ESTIMATE)
    ends = measures_of(simulate(straight(), 4.0, sample_period=4.0, estimate=False), AT_END)
    assert {name: ends[name] for name in AT_END} == {name: whole[name] for name in AT_END}
