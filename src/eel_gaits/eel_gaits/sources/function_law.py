# SPDX-License-Identifier: Apache-2.0
"""A law from a function K(t, X): rows at instants and points that are close enough to represent the function.

The function is evaluated all along the body at one random instant in each `step` of time. So nothing that lasts two
steps is missed, however long the motion is. Points along the body and rows are added until interpolation between them
agrees with all these evaluations ("looks") to a part `tolerance` of the greatest curvature.
"""

import math
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from eel_common.quantity import numbers, positive
from eel_common.wording import shown

from eel_gaits.laws.spline import natural_spline
from eel_gaits.sources.refinement import refined
from eel_gaits.sources.sampled_law import SampledLaw, points_for

TOLERANCE = 1e-5
STEP = 0.005  # s: there is one look in each step
MOST_LOOKS = 1_000_000
SEED = 1  # seed of the random looks
CLOSEST = 1.0 / 64.0  # least distance of rows, in steps, or in `STEP` if that is less
INSTANTS = 24  # instants for choosing the points along the body, and number added at a time
PLACES, SETS = 4096, 32  # random X along the body, and sets of them, which the looks use in turn


def sampled(
    function: Callable[..., Any],
    duration: float,
    *,
    length: float = 1.0,
    tolerance: float = TOLERANCE,
    step: float = STEP,
    name: str | None = None,
) -> SampledLaw:
    """The law of `function` from t = 0 to `duration` [s], for a body of `length` [m].

    function(t, X): curvature [rad/m] at the time t [s] and the points X (n,) [m], which rise. It returns yaw (n,), or
    pitch and yaw (2, n); or with rate [rad/m/s] and acceleration [rad/m/s^2] in time (3, 2, n); or (3, n, 3) like
    `Law.curvature`. step: [s]; a bend that lasts two steps or longer is certainly seen, a shorter one by chance. name:
    by default the function's.

    `ValueError` names t and X where the function returns anything else, or jumps. A warning says where its rate jumps.
    """
    duration, length = positive("duration", duration, "s"), positive("length", length, "m")
    tolerance, step = positive("tolerance", tolerance), positive("step", step, "s")
    if not duration <= MOST_LOOKS * step:
        raise ValueError(
            f"step must be {duration / MOST_LOOKS:g} s or more for a duration of {duration:g} s, got {step:g} s"
        )
    if not callable(function):
        raise ValueError(f"function must be one of t and X, got {shown(function)}")
    curvature = CheckedFunction(function)
    x, looks, seen = _points(curvature, duration, length, tolerance, step)

    def evaluated(instants: np.ndarray) -> np.ndarray:
        return np.array([curvature(t, x) for t in instants]).swapaxes(1, 2)  # (N, 2, 1 or 3, n)

    rows = refined(evaluated, duration, looks, seen, tolerance, CLOSEST * min(step, STEP))
    name = getattr(function, "__name__", type(function).__name__) if name is None else name
    if rows.jump is not None:
        warnings.warn(
            f"the rate of the curvature's function {shown(name)} seems to jump near t = {rows.jump:.4g} s: the torque "
            "is infinite there",
            stacklevel=2,
        )
    about = (
        f"a function in {len(rows.time)} rows of {len(x)} points, which miss it by {rows.missed:.1g} of its greatest "
        f"value; it was looked at every {duration / len(looks):.2g} s"
    )
    return SampledLaw(rows.time, x, rows.values, name=name, about=about)


class CheckedFunction:
    """Calls a user's function, and checks its result. `given`: whether it returns derivatives too."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self.given: bool | None = None

    def __call__(self, time: float, x: np.ndarray) -> np.ndarray:
        """Curvature (1, 2, n), or with derivatives (3, 2, n), at `time` [s] and `x` (n,) [m]."""
        count, where = len(x), f"at t = {time:g} s"
        returned = self._function(float(time), x.copy())
        try:
            found = numbers("", returned)
        except ValueError:
            found = None
        if found is not None and found.shape == (3, count, 3):
            found = found[:, :, 1:].swapaxes(1, 2)
        elif found is not None and found.shape in ((count,), (2, count)):
            found = np.stack((np.zeros(count), found))[None] if found.ndim == 1 else found[None]
        if found is None or found.shape not in ((1, 2, count), (3, 2, count)):
            got = shown(returned) if found is None else f"the shape {found.shape}"
            raise ValueError(
                f"the curvature's function must return numbers of the shape ({count},), (2, {count}), (3, 2, {count}) "
                f"or (3, {count}, 3) for {count} points X, got {got} {where}"
            )
        if not np.all(np.isfinite(found)):
            _, axis, point = np.argwhere(~np.isfinite(found))[0]
            bad = found[:, axis, point][~np.isfinite(found[:, axis, point])][0]
            raise ValueError(
                f"the curvature's function must be finite, got {bad} in {('pitch', 'yaw')[axis]} {where}, "
                f"X = {x[point]:g} m"
            )
        if self.given is None:
            self.given = len(found) == 3
        if self.given != (len(found) == 3):
            raise ValueError(f"the curvature's function must give derivatives always or never, got another way {where}")
        return found

    def over(self, instants: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Only the curvature (N, 2, n), at `instants` (N,) [s] and `x` (n,) [m]."""
        return np.array([self(time, x)[0] for time in instants])


def _points(
    curvature: CheckedFunction, duration: float, length: float, tolerance: float, step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points x (n,) [m], the looks (M,) [s], and the curvature (M, 2, n) of the looks at these points.

    Each look also has X of its own. If interpolation is wrong there, the points are chosen again with that look among
    the instants.
    """
    draw, count = np.random.default_rng(SEED), math.ceil(duration / step)
    looks = duration / count * (np.arange(count) + draw.random(count))
    places = length / PLACES * (np.arange(PLACES) + draw.random(PLACES))
    sets, instants, check = places.reshape(-1, SETS).T, np.linspace(0.0, duration, INSTANTS), np.empty(0)
    while True:
        x = points_for(partial(curvature.over, instants), length, tolerance, check)
        seen, apart = np.empty((count, 2, len(x))), np.empty(count)
        for index, others in enumerate(sets):
            both = np.sort(np.concatenate((x, others)))
            own, other = np.searchsorted(both, x), np.searchsorted(both, others)
            weight = natural_spline(x, np.eye(len(x)), others)
            for look in range(index, count, SETS):
                found = curvature(looks[look], both)[0]
                seen[look] = found[:, own]
                apart[look] = np.max(np.abs(seen[look] @ weight - found[:, other]))
        missed = np.flatnonzero(apart > tolerance * max(np.max(np.abs(seen)), np.max(apart)))
        if not len(missed):
            return x, looks, seen
        worst = missed[np.argsort(apart[missed])[-INSTANTS:]]
        instants = np.union1d(instants, looks[worst])
        check = np.union1d(check, sets[np.unique(worst % SETS)])
