# SPDX-License-Identifier: Apache-2.0
"""Random robots run, or are refused with the part that is to blame; what they deliver is within their target."""

import numpy as np
import pytest
from eel_dynamics.analysis.peaks import torque_size
from random_robots import drawn, drawn_at_stops
from random_scenes import with_weight_and_fins

from eel_dynamics import Accuracy, Simulation, SimulationStopped, simulate, simulate_batch

ALL = 5000
EXACT = Accuracy(name="exact", resolution=120.0, tolerance=1e-7)  # at 36 the torque of some is off by a hundredth
NEAR = Accuracy(name="near", resolution=40.0, tolerance=3e-6)
ROUGH = Accuracy(name="rough", resolution=40.0, tolerance=1e-5)  # at 1e-3 its own error was 0.03 to 0.2 in 7 of 100


def error_of(run, exact) -> float:
    """The error of a run's position and torque, whichever is greater."""
    position = np.linalg.norm(run.position - exact.position, axis=1).max() / max(exact.path_length, 1.0)
    torque = np.linalg.norm(run.torque - exact.torque, axis=2).max() / np.linalg.norm(exact.torque, axis=2).max()
    return float(max(position, torque))


def swum_together(seeds, accuracy, estimate: bool = True):
    draws = [drawn(seed) for seed in seeds]
    return simulate_batch(
        [each.law for each in draws],
        0.02,
        robots=[each.robot for each in draws],
        scenes=[each.scene for each in draws],
        accuracy=accuracy,
        estimate=estimate,
        stations=5,
        sample_period=0.0005,  # at fewer samples the torque may be much less than its maximum
    )


def check_refused(seeds, runs):
    refused = [(seed, error) for seed, error in zip(seeds, runs.error, strict=True) if error is not None]
    for seed, error in refused:
        assert any(part.name in str(error) for part in drawn(seed).robot.parts), (seed, error)
    assert len(refused) <= 0.05 * len(seeds)


@pytest.mark.parametrize("count", [120, pytest.param(ALL, marks=[pytest.mark.soak, pytest.mark.timeout(1200)])])
def test_random_robots_run_or_are_refused_with_the_part_to_blame(count):
    runs = swum_together(range(count), 0.1, estimate=False)
    check_refused(range(count), runs)
    assert np.isfinite(runs.torque).all() and np.isfinite(runs.joint_angle).all()


LONG = [pytest.param(range(first, first + 100), marks=pytest.mark.soak) for first in range(0, ALL, 100)]


@pytest.mark.parametrize("seeds", [range(0, 500, 30), *LONG], ids=lambda seeds: f"{seeds[0]}-{seeds[-1]}")
def test_many_random_robots_keep_their_target_or_tell(seeds):
    target = 0.03
    runs, exact = swum_together(seeds, target), swum_together(seeds, ROUGH, estimate=False)
    check_refused(seeds, runs)
    swum = [index for index in range(len(seeds)) if runs.error[index] is None and exact.error[index] is None]
    missed = [index for index in swum if error_of(runs[index], exact[index]) > target]
    told = [index for index in swum if runs[index].error_estimate.worst > target]
    print(f"{len(seeds)} robots, {len(swum)} compared, {len(missed)} above the target, {len(told)} told")
    silent = [seeds[index] for index in missed if index not in told]
    if silent:  # the reference itself may be late at a stop
        runs, exact = swum_together(silent, target), swum_together(silent, EXACT, estimate=False)
    unseen = [seed for index, seed in enumerate(silent) if error_of(runs[index], exact[index]) > target]
    assert not unseen


def swum(seed: int, accuracy, estimate: bool = True):
    draw = drawn(seed)
    return simulate(
        draw.law, 0.5, robot=draw.robot, scene=draw.scene, accuracy=accuracy, stations=11, estimate=estimate
    )


# Seeds that have missed their target unseen, before: motors and stops at their limits between two samples, a companion
# that was as exact as the run by chance (158), and a torque at the start that was off by the grid (1206, 1430).
SEEN = [(seed, 1e-3) for seed in (158, 200, 1430)] + [(seed, 1e-2) for seed in (1032, 1206, 1442)]


# Seeds that missed their target unseen where the damper of a stop had its whole torque at contact, by up to 0.24.
AT_STOPS = 0, 5, 16, 45, 122, 176
LONG_AT_STOPS = [pytest.param(range(first, first + 100), marks=pytest.mark.soak) for first in range(0, 1000, 100)]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seeds", [AT_STOPS, *LONG_AT_STOPS], ids=lambda seeds: f"{seeds[0]}-{seeds[-1]}")
def test_robots_that_swing_into_their_stops_keep_their_target_or_tell(seeds):
    target, told, met, missed = 0.03, 0, 0, []
    for seed in seeds:
        draw = drawn_at_stops(seed)
        swim = {"robot": draw.robot, "scene": draw.scene, "stations": 5, "sample_period": 1e-3}
        run = simulate(draw.law, 0.2, accuracy=target, **swim)
        error = error_of(run, simulate(draw.law, 0.2, accuracy=ROUGH, estimate=False, **swim))
        if error > 0.5 * target:
            if run.accuracy.tolerance < EXACT.tolerance:
                continue  # the reference errs more: the motion between the stops is chaotic
            error = error_of(run, simulate(draw.law, 0.2, accuracy=EXACT, estimate=False, **swim))
        above = run.error_estimate.worst > target
        told, met = told + above, met + any_stop_met(run)
        if error > target and not above:
            missed.append((seed, error))
    print(f"{len(seeds)} robots, {met} at stops, {told} told")
    assert not missed and met > 0.8 * len(seeds) and told <= 0.02 * len(seeds)


def swum_on(draw, times, accuracy, measure_error: bool = False):
    """A `Simulation` that went through the `times` [s], and its torque there."""
    swim = Simulation(
        law=draw.law,
        robot=draw.robot,
        scene=draw.scene,
        accuracy=accuracy,
        stations=5,
        measure_error=measure_error,
    )
    torques = []
    for time in times:
        swim.advance(float(time))
        torques.append(swim.observe().torque)
    return swim, np.array(torques)


@pytest.mark.parametrize("seeds", [(10, 23, 31), pytest.param(range(200), marks=pytest.mark.soak)], ids=["few", "many"])
def test_a_simulation_that_goes_on_tells_its_error_at_stops(seeds):
    """What a stop gives is short: compared each 0.1 s, a twentieth of the error was seen. Now three quarters are, or
    more."""
    times, rough = 1e-3 * np.arange(1, 301), Accuracy(name="rough", resolution=20.0, tolerance=1e-3)
    silent = []
    for seed in seeds:
        swim, torques = swum_on(drawn_at_stops(seed), times, rough, measure_error=True)
        exact = swum_on(drawn_at_stops(seed), times, NEAR)[1]
        error = torque_size(torques - exact).max() / torque_size(exact).max()
        if swim.error_estimate.torque < 0.7 * error:
            silent.append((seed, error, swim.error_estimate.torque))
    assert not silent


def any_stop_met(run) -> bool:
    low, high = np.array([joint.limits for joint in run.robot.joints]).T
    return bool(((run.joint_angle < low) | (run.joint_angle > high)).any())


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("cases", "reference"),
    [(SEEN, NEAR), pytest.param([(seed, 1e-3) for seed in range(100)], EXACT, marks=pytest.mark.soak)],
)
def test_error_of_random_robots_is_within_the_target_or_told(cases, reference):
    for seed, target in cases:
        run = swum(seed, target)
        error = error_of(run, swum(seed, reference, False))
        assert error < target or run.error_estimate.worst > target, (seed, error)


def swims_in_water(count: int):
    """Robots on the paper's body, with weight, fins, and in water that moves: arguments of `simulate`."""
    for seed, scene in enumerate(with_weight_and_fins(count, seed=46)):
        if scene["body"].length == 1.0 and not scene["scene"].planar:
            draw = drawn(seed)
            yield seed, draw.robot, scene | {"law": draw.law, "robot": draw.robot, "duration": 0.5, "stations": 11}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("count", [10, pytest.param(1200, marks=pytest.mark.soak)])
def test_random_robots_in_all_waters_keep_their_energy_or_are_refused(count):
    refused = swum = 0
    for seed, robot, arguments in swims_in_water(count):
        swum += 1
        try:
            ledger = simulate(accuracy=1e-4, estimate=False, **arguments).energy
        except (SimulationStopped, ValueError) as error:
            refused += 1
            assert any(part.name in str(error) for part in robot.parts), (seed, error)
            continue
        amounts = (v for name, v in vars(ledger).items() if not name.endswith(("power", "residual")))  # J
        scale = max(np.abs(each).max() for each in amounts)
        assert np.abs(ledger.residual).max() < 0.01 * scale, seed  # of which stiff dampers take what they take
    assert refused <= 0.05 * swum


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("count", [3, pytest.param(300, marks=pytest.mark.soak)])
def test_error_of_random_robots_in_all_waters_is_within_the_target_or_told(count):
    for seed, _, arguments in swims_in_water(count):
        fine = Accuracy(name="exact", resolution=40.0, tolerance=1e-6)
        run, exact = simulate(accuracy=1e-3, **arguments), simulate(accuracy=fine, estimate=False, **arguments)
        error = error_of(run, exact)
        assert error < 1e-3 or run.error_estimate.worst > 1e-3, (seed, error)
