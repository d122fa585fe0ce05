# SPDX-License-Identifier: Apache-2.0
"""The gait of least cost for each speed: `optimise`.

    front = optimise({"period": (0.4, 3.0), "amplitude_0": (0.0, 2.0), "amplitude_2": (0.0, 6.0)}, [0.2, 0.4, 0.6])
    print(front.table())
    front.draw("front.png")
    front.runs[1].law                # the gait for 0.4 m/s

First, gaits spread over the bounds are tried. For each speed the search begins from the best of them and from the gait
found for the previous speed. It minimises the cost with the speed as a constraint.
"""

import warnings
from collections.abc import Callable, Iterator, Sized
from dataclasses import replace
from typing import Any

import numpy as np
from eel_common.command.progress import progress_of
from eel_common.quantity import checked_choice, checked_instance, checked_row, number
from eel_common.wording import shown
from eel_dynamics.analysis.measures import checked_measures, measures_of

from eel_dynamics import Body, Robot, Scene
from eel_studies.gradients.fixed_discretisation import fixed_steps
from eel_studies.optimisation.front import Front
from eel_studies.optimisation.gait_problem import GaitProblem
from eel_studies.optimisation.searches import METHODS
from eel_studies.points import AccuracyLike, Gait, Numbers, Progress, base_of
from eel_studies.steady_swim import swim_times

SPREAD_OVER_BOUNDS = 16  # first gaits, per parameter
MORE_STARTS = 2  # further starts if the first ones missed the speed
MISSED = 0.01  # relative error of the final swim's speed, above which a warning names it
NOT_KEPT = 0.05  # the same, for a speed that only the search's short swims had, as they began with it
PENALTY = 20.0  # for a missed speed, when starts are ranked


def optimise(
    bounds: dict[str, tuple[float, float]],
    speeds: Any,
    *,
    gait: Gait = "straight",
    numbers: Numbers | None = None,
    body: Body | None = None,
    scene: Scene | None = None,
    robot: Robot | str | None = None,
    cost: str = "cost_of_transport",
    periods: int = 10,
    accuracy: AccuracyLike = 1e-3,
    method: str = "gradient",
    starts: int = 1,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress = None,
) -> Front:
    """The gaits of least `cost` at `speeds` (S,) [m/s] over the water, by parameters within their `bounds`.

    bounds: (low, high) by name, with the names of `studies.points`. gait: its name, a function of numbers that returns
    a law, or a whole `Swim`, as from `load_scene`. numbers: other numbers, held fixed, by the same names. body,
    accuracy, threads: as in `gradient`.
    scene: by default the library's with blended friction, whose derivatives have no jump; a current is left out.
    cost: the name of a measure (`analysis.measures.MEASURES`). periods: of each swim, which begins at the wanted speed;
    its later half is measured. method: "gradient" (SLSQP), or "cma", which needs the package cma (extra `[cma]`).
    starts: gaits from which each search by gradients begins, besides the previous speed's. seed: of random numbers.
    progress: as in `sweep`, by speeds.

    A speed that no gait reaches is left out, with a warning that names the speeds reached. `ValueError` names a bad
    argument, or says that no speed is reached; `ImportError`: a package is missing.
    """
    low, high = _checked_bounds(bounds)
    wanted = checked_row("speeds", speeds, None)
    if not len(wanted) or np.any(wanted <= 0.0) or len(set(wanted.tolist())) < len(wanted):
        raise ValueError(f"speeds must be one or more, > 0 m/s, none twice, got {shown(wanted.tolist())}")
    checked_choice("method", method, METHODS)
    counts = {"periods": (periods, 4), "starts": (starts, 1), "seed": (seed, 0)}
    for name, (value, least) in counts.items():
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            raise ValueError(f"{name} must be a whole number >= {least}, got {shown(value)}")
    (cost,) = checked_measures("cost", checked_instance("cost", cost, str), estimate=False)
    base = base_of(gait, friction="blended", body=body, scene=scene, robot=robot, accuracy=fixed_steps(accuracy))
    wrench = base.scene.internal_wrench or cost == "greatest_torque"
    base = base.unchecked(scene=replace(base.scene, current=(0.0, 0.0, 0.0), internal_wrench=wrench))
    problem = GaitProblem(tuple(bounds), low, high, gait, dict(numbers or {}), base, cost, int(periods), threads)
    for place in np.vstack((np.zeros(len(low)), np.ones(len(low)), 0.5 * np.ones(len(low)))):
        try:
            swim_times(problem.law(place), base.body.length, problem.periods)
        except ValueError as error:
            raise ValueError(f"optimise {error}") from None
    return _front(problem, np.sort(wanted), method, int(starts), int(seed), progress_of(progress, "speeds"))


def _front(
    problem: GaitProblem,
    wanted: np.ndarray,
    method: str,
    starts: int,
    seed: int,
    progress: Callable[[float, float], object],
) -> Front:
    from scipy.stats import qmc

    count = SPREAD_OVER_BOUNDS * len(problem.names)
    places = qmc.Sobol(len(problem.names), seed=seed).random(2 ** int(np.ceil(np.log2(count))))  # spread evenly
    measured = problem.measured(places, None)
    found, runs = [], []
    before: list[Any] = []
    for done, speed in enumerate(wanted.tolist()):
        progress(done, len(wanted))
        order = np.argsort(_merit(measured, speed))
        place = METHODS[method](problem, np.array([*before, *places[order[:starts]]]), speed, seed)
        if place is None:
            place = METHODS[method](problem, places[order[starts : starts + MORE_STARTS]], speed, seed)
        if place is None:
            continue
        run = problem.run(place, speed)
        if abs(run.mean_speed / speed - 1.0) <= NOT_KEPT:
            before = [place]
            found.append((speed, place))
            runs.append(run)
    progress(len(wanted), len(wanted))
    tried = np.array(problem.tried).reshape(-1, 2)
    lines = list(_missed(wanted, [speed for speed, _ in found], tried))
    if not runs:
        raise ValueError(lines[0])
    speed = np.array([run.analysis().mean_speed for run in runs])
    reached = np.array([speed for speed, _ in found])
    for index in np.flatnonzero(np.abs(speed / reached - 1.0) > MISSED):
        swum = f"{speed[index]:.4g} m/s in a longer swim: more periods settle it"
        lines.append(f"the gait for {reached[index]:.4g} m/s swims at {swum}")
    if problem.jumps:
        lines.append("the printed friction jumps between swims of a derivative: friction blended or laminar is smooth")
    for line in lines:
        warnings.warn(line, stacklevel=3)
    return Front(
        cost_name=problem.cost,
        names=problem.names,
        low=problem.low,
        high=problem.high,
        wanted=reached,
        values=np.array([list(problem.values(place).values()) for _, place in found]),
        speed=speed,
        cost=np.array([measures_of(run, (problem.cost,))[problem.cost] for run in runs]),
        runs=tuple(runs),
        tried=tried,
        warnings=tuple(lines),
    )


def _checked_bounds(bounds: Any) -> tuple[np.ndarray, np.ndarray]:
    if not isinstance(bounds, dict) or not bounds:
        raise ValueError(f"bounds must be a dict of parameters and (low, high), got {shown(bounds)}")
    rows = []
    for name, pair in bounds.items():
        if isinstance(pair, str) or not np.iterable(pair) or not isinstance(pair, Sized) or len(pair) != 2:
            raise ValueError(f"bounds {shown(name)} must be (low, high), got {shown(pair)}")
        low, high = (number(f"bounds {shown(name)}", value) for value in pair)
        if not low < high:
            raise ValueError(f"bounds {shown(name)} must have low < high, got ({low:g}, {high:g})")
        rows.append((low, high))
    return tuple(np.array(rows).T)


def _merit(measured: np.ndarray, speed: float) -> np.ndarray:
    """The merit (N,) of gaits as starts for `speed` [m/s]: low cost, and a speed close to it; the least is best."""
    scale = np.nanmedian(np.abs(measured[:, 1])) if np.isfinite(measured[:, 1]).any() else 1.0
    worth = measured[:, 1] / scale + PENALTY * np.abs(np.log(np.maximum(measured[:, 0], 1e-9) / speed))
    return np.where(np.isfinite(worth), worth, np.inf)


def _missed(wanted: np.ndarray, met: list[float], tried: np.ndarray) -> Iterator[str]:
    """One line about the speeds for which no gait was found."""
    left = [f"{speed:.4g}" for speed in wanted.tolist() if speed not in met]
    if left:
        reached = "no gait that was tried swims steadily"
        if len(tried):
            reached = f"the gaits that were tried swim at {tried[:, 0].min():.3g} to {tried[:, 0].max():.3g} m/s"
        yield f"speeds: no gait within the bounds was found for {', '.join(left)} m/s; {reached}"
