"""How hard a swim is, and what follows for its settings: finer for a long or violent one, coarser for a gentle one."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from eel_dynamics.accuracy.accuracy import Key, key_of, table
from eel_dynamics.curvature.difficulty import EASIEST, HARDEST, NOMINAL, Difficulty, difficulty_of, speed_of
from eel_dynamics.runs.error_estimate import relative_errors
from eel_dynamics.studies.calibration.calibration import REFERENCE, Case, swim, varied
from eel_gaits.law import Law, Ramp, Term

from eel_dynamics import Accuracy, Body, Scene, Simulation, simulate, simulate_batch
from eel_gaits import falling, gait, straight

LENGTH = 1.3
WAVE = Term(axis="yaw", amplitude=(0.4, 0.2, 0.3), wavelength=0.9, period=0.7, phase=0.4)
ALONE = Scene(ledger=False, internal_wrench=False)


def moved(law: Law, length: float, time: np.ndarray) -> np.ndarray:
    """Velocity (T, N) [m/s] of the sections about their mean, by what the law's rates integrate to twice along X."""
    x = length * (np.arange(2000) + 0.5) / 2000
    rates = np.array([law.curvature(t, x)[1] for t in time])[..., 1:]
    velocity = np.cumsum(np.cumsum(rates, axis=1), axis=1) * (length / 2000) ** 2
    return velocity - velocity.mean(axis=1, keepdims=True)


@pytest.mark.parametrize("terms", [(WAVE,), (WAVE, replace(WAVE, axis="pitch", phase=2.0, amplitude=(0.7,)))])
def test_the_speed_of_a_shape_is_that_of_its_sections(terms):
    law = Law(*terms)
    velocity = moved(law, LENGTH, np.linspace(0.0, 0.7, 200, endpoint=False))
    expected = math.sqrt((velocity**2).sum(axis=2).mean())
    assert speed_of(law, LENGTH) == pytest.approx(expected, rel=0.03)
    difficulty = difficulty_of(law, LENGTH, 7.0)
    assert difficulty.stroke_rms == pytest.approx(expected * 0.7 / LENGTH, rel=0.03)
    assert difficulty.path_rms == pytest.approx(10.0 * difficulty.stroke_rms)


def test_terms_that_go_together_add_up_and_others_do_not():
    opposite = replace(WAVE, phase=WAVE.phase + math.pi)
    assert difficulty_of(Law(WAVE, opposite), LENGTH, 1.0).stroke_rms < 1e-12
    apart = replace(opposite, envelope=(Ramp(0.0, 1.0, 1.0),))
    assert difficulty_of(Law(WAVE, apart), LENGTH, 1.0).stroke_rms == pytest.approx(
        math.sqrt(2.0) * difficulty_of(Law(WAVE), LENGTH, 1.0).stroke_rms
    )


def test_a_bend_is_a_way_once():
    bend = Law(Term(amplitude=(1.0,), phase=math.pi / 2.0, envelope=(Ramp(0.0, 2.0, 0.5), Ramp(3.0, 5.0, 0.5))))
    short, long = difficulty_of(bend, LENGTH, 1.0), difficulty_of(bend, LENGTH, 100.0)
    assert short.path_rms == pytest.approx(0.5 * long.path_rms) and long.path_rms == pytest.approx(long.stroke_rms)
    half = Law(Term(amplitude=(1.0,), phase=math.pi / 2.0, envelope=(Ramp(0.0, 2.0, 0.5),)))
    assert long.stroke_rms == pytest.approx(2.0 * difficulty_of(half, LENGTH, 100.0).stroke_rms)  # the ramps' sum
    assert difficulty_of(Law(Term(amplitude=(1.0,), phase=1.0)), LENGTH, 10.0) == Difficulty(0.0, 0.0)  # always bent


def test_beyond_sixty_periods_a_swim_gets_no_harder():
    minute, hour = (difficulty_of(Law(WAVE), LENGTH, 0.7 * periods) for periods in (60.0, 3600.0))
    assert hour == minute and minute.path_rms == pytest.approx(60.0 * minute.stroke_rms)


def test_scales_that_do_not_matter():
    """Twice as large a body with half the bends, at another pace: the same swim."""
    law = Law(WAVE, Term(axis="pitch", amplitude=(0.5,), period=1.1, envelope=(Ramp(0.2, 0.9, 1.0),)))
    large = Law(
        replace(WAVE, amplitude=(0.2, 0.05, 0.0375), wavelength=1.8),
        Term(axis="pitch", amplitude=(0.25,), period=1.1, envelope=(Ramp(0.2, 0.9, 1.0),)),
    )
    expected = difficulty_of(law, LENGTH, 5.0)
    assert difficulty_of(large, 2.0 * LENGTH, 5.0) == pytest.approx(expected)
    assert difficulty_of(varied(law, 1.0, 3.0), LENGTH, 5.0 / 3.0) == pytest.approx(expected)
    assert difficulty_of(varied(law, 2.0, 1.0), LENGTH, 5.0).stroke_rms == pytest.approx(2.0 * expected.stroke_rms)


@pytest.mark.parametrize("key", list(table()))
def test_what_is_harder_never_gets_looser_settings(key):
    key = Key(*key)
    gradually = [10.0**power for power in np.linspace(-3.0, 3.0, 61)]
    harder = [Difficulty(NOMINAL.stroke_rms * by, NOMINAL.path_rms * by) for by in gradually]
    scales = [each.target_scale(key.drag, key.torque, key.plane) for each in harder]
    assert scales == sorted(scales, reverse=True) and scales[0] <= 1.0 / EASIEST * 1.001
    assert NOMINAL.target_scale(key.drag, key.torque, key.plane) == 1.0
    for wild in (Difficulty(math.inf, math.inf), Difficulty(math.nan, math.nan)):
        assert 0.5 / HARDEST < wild.target_scale(key.drag, key.torque, key.plane) <= 1.0 / HARDEST


def test_settings_between_the_rows_of_the_table_and_beyond_them():
    key = key_of(ALONE)
    rows = {row["target"]: row for row in table()[key]}
    at, between = (Accuracy.of(target).in_scene(ALONE) for target in (1e-5, 2e-5))
    assert (at.resolution, at.tolerance) == (rows[1e-5]["resolution"], rows[1e-5]["tolerance"])
    assert between.resolution == at.resolution and between.tolerance == pytest.approx(2.0**0.8 * at.tolerance)
    finest = min(rows)
    hard = Difficulty(NOMINAL.stroke_rms, 100.0 * NOMINAL.path_rms)
    plain, harder = (Accuracy.of(finest).in_scene(ALONE, False, difficulty) for difficulty in (NOMINAL, hard))
    assert harder.tolerance < plain.tolerance and harder.resolution > plain.resolution
    fixed = Accuracy.of("1e-4, fixed steps")
    assert fixed.in_scene(ALONE, False, hard).fixed > fixed.in_scene(ALONE).fixed


def test_initial_velocity_or_samples_take_the_settings_of_a_nominal_swim():
    gentle = varied(straight(), 0.05, 1.0)
    usual = Accuracy.of(1e-4).in_scene(ALONE, plane=True)
    still = Simulation(scene=ALONE, accuracy=1e-4, law=gentle)
    assert still.accuracy.tolerance > usual.tolerance or still.accuracy.resolution < usual.resolution
    moving = Simulation(scene=ALONE, accuracy=1e-4, law=gentle, twist=(0.0, 0.0, 0.0, -0.1, 0.0, 0.0))
    assert moving.accuracy == usual
    x, none = np.linspace(0.0, 1.0, 9), np.zeros(9)
    still.add_samples(0.1, x, *[none] * 6)
    assert still.accuracy == Accuracy.of(1e-4).in_scene(ALONE)


def test_the_horizon_is_the_duration_of_a_run():
    usual, far = (
        simulate(falling(), duration, scene=ALONE, accuracy=1e-4, sample_period=duration).accuracy
        for duration in (10.0, 100.0)
    )
    assert usual.tolerance > far.tolerance
    at = partial(Simulation, scene=ALONE, accuracy=1e-4, law=falling())
    assert at(horizon=10.0).accuracy == usual and at(horizon=100.0).accuracy == far
    for wrong in (math.nan, -1.0):
        with pytest.raises(ValueError, match=f"horizon must be >= 0 s, got {wrong}"):
            at(horizon=wrong)


def test_without_a_horizon_the_settings_hold_for_any_duration():
    endless = Simulation(scene=ALONE, accuracy=1e-4, law=falling())
    assert endless.accuracy == simulate(falling(), 1e3, scene=ALONE, accuracy=1e-4, sample_period=1e3).accuracy
    bend = Law(Term(axis="yaw", amplitude=(0.5,), envelope=(Ramp(0.2, 0.9, 1.0),)))
    assert difficulty_of(bend, LENGTH, math.inf) == difficulty_of(bend, LENGTH, 1e6)


def test_a_batch_of_gentle_and_violent_laws_swims_as_each_alone():
    laws = [varied(falling(), by, 1.0) for by in (0.05, 1.5, 0.05, 0.3, 1.0, 0.3, 1.5)]
    batch = simulate_batch(laws, 3.0, scenes=ALONE, accuracy=1e-3, stations=None)
    assert len({each.tolerance for each in batch.accuracies}) >= 3
    for index, law in enumerate(laws):
        run = simulate(law, 3.0, scene=ALONE, accuracy=1e-3, stations=2)
        assert batch.accuracies[index] == run.accuracy and batch.steps[index] == run.steps
        np.testing.assert_allclose(batch.position[index], run.position, atol=1e-8)


@pytest.mark.parametrize("friction", ["laminar", "printed"])
@pytest.mark.parametrize("name", ["straight", "turning", "falling", "kern_fast"])
def test_long_swims_deliver_their_target_too(name, friction):
    """A minute: before settings went with the difficulty, some missed by a factor three and more."""
    body = Body.kern2006() if "kern" in name else Body.boyer2010()
    scene = replace(ALONE, friction=friction)
    case = Case(name=name, law=gait(name), body=body, scene=scene, duration=60.0)
    reference = swim(case, replace(REFERENCE, resolution=150.0, tolerance=1e-11))
    for target in (1e-2, 1e-3, 1e-5):
        assert relative_errors(swim(case, target), reference).worst <= target, target


@pytest.mark.parametrize("bends, pace, seconds", [(0.1, 1.0, 10.0), (1.5, 2.0, 6.0), (0.3, 0.4, 25.0)])
def test_gentle_and_violent_swims_deliver_their_target_and_not_far_more(bends, pace, seconds):
    for name in ("falling", "rolling"):
        case = Case(
            name=name, law=varied(gait(name), bends, pace), body=Body.boyer2010(), scene=ALONE, duration=seconds
        )
        reference = swim(case, replace(REFERENCE, resolution=150.0, tolerance=1e-11))
        for target in (1e-3, 1e-5):
            error = relative_errors(swim(case, target), reference).worst
            assert target / 300.0 <= error <= target, (name, target, error)
