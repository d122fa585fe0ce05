# SPDX-License-Identifier: Apache-2.0
"""Random scenes: each finishes with a ledger that closes, or says why not; nothing hangs. The soak has more of them."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.simulation.energy import WORKS
from eel_dynamics.simulation.stopping import OPEN
from random_scenes import anywhere, robots_anywhere, with_weight_and_fins

from eel_dynamics import Scene, Simulation, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term

MOST_STEPS = 100_000  # of half a second or one, where steps are chosen; the worst of 10,000 takes 5e4
AIMED = 0.05  # of the energy, that the ledger of a run of target 1e-2 may be open by


def finite(batch):
    arrays = batch.position, batch.orientation, batch.twist, batch.head_acceleration, batch.center_of_mass
    return all(np.isfinite(array).all() for array in (*arrays, *(batch.energy[name] for name in batch.energy.keys())))  # noqa: SIM118


def share_from_nowhere(energy):
    """Greatest residual of the ledger, as a share of the energy that was there or passed: of each run of (B, T)
    samples."""
    works = energy.actuator_work, energy.wake_work, energy.nose_work, energy.drag_work
    passed = (energy.kinetic_body + energy.kinetic_fluid + sum(np.abs(work) for work in works)).max(axis=-1)
    return np.abs(energy.residual).max(axis=-1) / np.where(passed > 0.0, passed, 1.0)


def share_with_ramps(law, body, scene, accuracy, twist, duration):
    """The same for one run that is looked at within its ramps too: what a sudden one puts in, it takes out again."""
    swimmer = Simulation(body=body, scene=scene, accuracy=accuracy, twist=twist, law=law, stations=2)
    ends = swimmer.shape.breakpoints()
    ends = np.unique([0.0, *ends[(ends > 0.0) & (ends < duration)], duration])
    times = np.append((ends[:-1, None] + np.diff(ends)[:, None] * np.linspace(0.0, 1.0, 9)[:-1]).ravel(), duration)
    energies = []
    for time in times:
        swimmer.advance(time)
        energies.append(swimmer.observe(wrench=False, load=False).energy)
    names = "kinetic_body", "kinetic_fluid", "actuator_work", "wake_work", "nose_work", "drag_work", "residual"
    rows = {name: np.array([getattr(each, name) for each in energies]) for name in names}
    return float(share_from_nowhere(type("Samples", (), rows)))


SCENES = [
    pytest.param(robots_anywhere, 150, 0.5, id="robots"),
    pytest.param(robots_anywhere, 10_000, 0.5, id="ten thousand robots", marks=pytest.mark.soak),
    pytest.param(anywhere, 150, 0.5, id="all sizes"),
    pytest.param(anywhere, 10_000, 1.0, id="ten thousand of all sizes", marks=pytest.mark.soak),
]


@pytest.mark.timeout(900)
@pytest.mark.parametrize(("scenes", "count", "duration"), SCENES)
def test_a_swimmer_driven_anywhere_finishes_or_says_why_not(scenes, count, duration):
    cases = {"accuracy": 1e-2, **scenes(count, seed=count)}
    batch = simulate_batch(duration=duration, sample_period=duration / 8, estimate=False, **cases)
    assert finite(batch)
    aimed = np.array([accuracy.method != "classical" for accuracy in batch.accuracies])
    assert batch.steps[aimed].max() < MOST_STEPS
    for error in batch.error:
        if error is not None:
            assert error.hint and error.quantity and error.time <= duration
    # Motions too small for a step to be asked for have an error by the body's length, not by their own energy.
    lengths = np.array([body.length for body in batch.bodies])
    moved = np.linalg.norm(np.diff(batch.position, axis=1), axis=2).sum(axis=1) > 0.1 * lengths
    counted = moved & ~batch.stopped
    assert counted.sum() > count // 15
    share = np.where(counted, share_from_nowhere(batch.energy), 0.0)
    for index in np.flatnonzero(share > np.where(aimed, AIMED, OPEN)):
        assert any("energy ledger" in text for text in batch[index].warnings)
        if aimed[index]:
            of_one = batch.laws[index], batch.bodies[index], batch.scenes[index], batch.accuracies[index]
            assert share_with_ramps(*of_one, cases["twists"][index], duration) < AIMED


@pytest.mark.timeout(3600)
@pytest.mark.parametrize(
    ("count", "duration", "accuracy", "open_by"),
    [(60, 0.15, 1e-7, 1e-8), pytest.param(3000, 1.0, 1e-3, 1e-3, marks=pytest.mark.soak)],
)
@pytest.mark.filterwarnings("ignore")
def test_swimmers_that_weigh_and_have_fins_close_their_ledger(count, duration, accuracy, open_by):
    """In each combination of weight, fins, plane and flow: the ledger, by the energy that was there or passed, the
    wrench at the nose, and an error estimate that the soak holds against a finer run."""
    for index, arguments in enumerate(with_weight_and_fins(count, seed=count)):
        how = {"duration": duration, "sample_period": duration / 5, "stations": 11} | arguments
        run = simulate(accuracy=accuracy, **how)
        energy = run.energy
        works = sum(np.abs(energy[f"{part}_work"]).max() for part in WORKS)
        passed = works + energy.kinetic_body.max() + energy.kinetic_fluid.max() + np.ptp(energy.potential)
        assert np.abs(energy.residual).max() < open_by * passed, index
        assert run.closure_force.max() < 1e-10 * np.abs(run.force).max(), index
        assert run.closure_torque.max() < 1e-10 * run.body.length * np.abs(run.force).max(), index
        assert np.isfinite(run.error_estimate.position) and run.error_estimate.growth_rate is not None, index
        if count > 1000:
            apart = relative_errors(run, simulate(accuracy=0.1 * accuracy, **how)).worst
            assert apart < 2.0 * max(run.error_estimate.worst, accuracy), (index, apart)


def test_steps_of_adams_that_stability_keeps_short_fall_in_order():
    """The motion alone is marched by Adams' steps: at their full order a light body in thick water takes 1.1e5."""
    cases = {name: each[420:530] for name, each in robots_anywhere(600, seed=2_000).items()}
    scenes = [replace(scene, ledger=False, internal_wrench=False) for scene in cases["scenes"]]
    batch = simulate_batch(
        duration=2.0, sample_period=0.25, accuracy=1e-2, estimate=False, **(cases | {"scenes": scenes})
    )
    assert batch.accuracies[0].method == "adams"
    assert all(np.isfinite(array).all() for array in (batch.position, batch.orientation, batch.twist))
    assert not batch.stopped.any()
    assert batch.steps.max() < 50_000


@pytest.mark.parametrize(
    ("size", "envelope"),
    [(3.0, [(0.0, 0.02, 1.0)]), (0.3, [(0.0, 0.1, 0.5), (0.1, 0.1 + 1e-6, 0.5), (0.1 + 5e-7, 0.1 + 2e-6, -0.3)])],
)
def test_what_is_left_of_a_sudden_ramp_s_work_is_known(size, envelope):
    """The ramp gives a heavy body a thousand times the energy that it leaves: at a fourth of the ramp a step, the
    ledger is open by 0.5 to 1 % of the work."""
    ramps = tuple(Ramp(*ramp) for ramp in envelope)
    amplitude = size, 0.5 * size, 2.0 * size
    law = Law(Term(axis="yaw", amplitude=amplitude, wavelength=1.0, period=1.0, envelope=ramps))
    run = simulate(law, 0.2, scene=Scene(density=5e5), accuracy=1e-2, stations=2)
    assert np.abs(run.energy.residual).max() < 1e-3 * run.energy.actuator_work[-1]
