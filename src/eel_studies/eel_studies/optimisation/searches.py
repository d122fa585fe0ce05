# SPDX-License-Identifier: Apache-2.0
"""Searches for the place of least cost at a given speed: by derivatives (SLSQP of SciPy), or by CMA-ES (cma).

Each is a function (problem, starts, speed, seed) -> place (P,), or None if none of its swims has that speed.
"""

import contextlib
import warnings

import numpy as np
from eel_dynamics.runs.storage.tables import needed

from eel_studies.optimisation.gait_problem import STEP, GaitProblem, NoSteadySwim

MET = 1e-3  # a speed is met within this relative difference
EVALUATIONS, TOLERANCE = 25, 3e-4  # of SLSQP: most evaluations, and the relative change of the cost that ends it
MISSED_SPEED = 30.0  # weight of the squared logarithm of a missed speed, added to the constraint
# Penalty of CMA-ES for a missed speed: in the cost's logarithm, per logarithm of speed. It is exact if steeper
# than the front, where the cost grows with the second or third power of the speed.
PENALTY = 6.0
SPREAD, GENERATIONS = 0.2, 150  # of CMA-ES: initial standard deviation, of the bounds' distance; most generations
WORST = 1e3  # cost of a gait that does not swim


def by_gradients(problem: GaitProblem, starts: np.ndarray, speed: float, seed: int) -> np.ndarray | None:
    """Sequential least-squares programming with `gradient`, from each of the `starts` (S, P); the best result."""
    ends = [end for start in starts if (end := _slsqp(problem, start, speed)) is not None]
    return min(ends, key=lambda end: end[0])[1] if ends else None


def _slsqp(problem: GaitProblem, start: np.ndarray, speed: float) -> tuple[float, np.ndarray] | None:
    """Cost and place at the end of one search; None if it misses the speed."""
    import scipy.optimize

    known: dict[bytes, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def found(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        key = place.tobytes()
        if key not in known:
            if len(known) >= EVALUATIONS or _ended([measured for measured, _, _ in known.values()], speed):
                raise StopIteration
            known[key] = *problem.derivatives(place, speed), place.copy()
        return known[key][:2]

    def with_missed_speed(place: np.ndarray) -> tuple[float, np.ndarray]:
        """Cost divided by its first value plus the squared miss of the speed, and the derivative (P,).

        The second term changes no solution. Without it, the line search of SLSQP may refuse a step that meets the
        speed at a cost that is right for it.
        """
        (swum, cost), (by_speed, by_cost) = found(place)
        missed = np.log(swum / speed)
        value = cost / scale + MISSED_SPEED * missed**2
        return value, by_cost / scale + 2.0 * MISSED_SPEED * missed * by_speed / swum

    start = np.clip(start, STEP, 1.0 - STEP)
    with contextlib.suppress(NoSteadySwim, StopIteration):
        scale = abs(found(start)[0][1])
        scipy.optimize.minimize(
            with_missed_speed,
            start,
            jac=True,
            method="SLSQP",
            bounds=[(STEP, 1.0 - STEP)] * len(start),
            constraints={
                "type": "eq",
                "fun": lambda place: np.log(found(place)[0][0] / speed),
                "jac": lambda place: found(place)[1][0] / found(place)[0][0],
            },
            options={"ftol": TOLERANCE},
        )
    met = [(measured[1], place) for measured, _, place in known.values() if abs(measured[0] / speed - 1.0) <= MET]
    return met[-1] if met else None


def _ended(measured: list[np.ndarray], speed: float) -> bool:
    """Whether the last two gaits have the wanted speed, and the same cost."""
    if len(measured) < 2:
        return False
    (before, cost), (after, last) = measured[-2:]
    return bool(
        max(abs(before / speed - 1.0), abs(after / speed - 1.0)) <= MET and abs(last - cost) <= TOLERANCE * abs(last)
    )


def by_cma(problem: GaitProblem, starts: np.ndarray, speed: float, seed: int) -> np.ndarray | None:
    """Covariance matrix adaptation from the first of the `starts` (S, P), from speeds and costs without derivatives.

    `ImportError` without the package cma.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its import warns of missing matplotlib
        cma = needed("cma", "method 'cma' of optimise")
    options = {"bounds": [0.0, 1.0], "maxiter": GENERATIONS, "tolfun": 5e-4, "tolx": 2e-3, "verbose": -9}
    options["seed"] = seed + 1  # 0 is the clock
    strategy = cma.CMAEvolutionStrategy(starts[0], SPREAD, options)
    best = np.inf, None
    while not strategy.stop():
        places = np.array(strategy.ask())
        measured = np.maximum(problem.measured(places, speed), np.finfo(float).tiny)
        missed = np.abs(np.log(measured[:, 0] / speed))
        worth = np.log(measured[:, 1]) + PENALTY * missed
        worth = np.where(np.isfinite(worth), worth, WORST)
        strategy.tell(list(places), worth.tolist())
        first = int(np.argmin(worth))
        if missed[first] <= MET and worth[first] < best[0]:
            best = worth[first], places[first]
    return best[1]


METHODS = {"gradient": by_gradients, "cma": by_cma}
