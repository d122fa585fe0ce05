# SPDX-License-Identifier: Apache-2.0
"""The accuracy of a run: one word or one number gives the nodes along the body, the method and the steps in time.

A target is a relative error. The error of the head's position is relative to the length of its path, or to the length
of the body if that is longer. The error of the torque field is relative to its own maximum.

These rules lead from a target to settings, and `simulate` measures the resulting error (`companion.py`):

- The tolerance per step is the target divided by `STEPS_ERRORS`. A swim takes hundreds of steps, whose errors add up.
- The points per body length grow by `POINTS_PER_DECADE` for each decade of the target. Gauss points in panels without
  kinks converge exponentially, so a further decade costs a fixed number of points.
- Runs with the ledger march with the embedded pair: each step costs a quadrature of the works, so few long steps are
  cheaper. So do runs with the internal wrench at fine targets. Others use Adams' method, with one evaluation per step.
- The number of fixed steps of the classical method, of order 4, grows with the fourth root of the target's inverse.
"""

import dataclasses
import math
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any

import numpy as np
from eel_common.quantity import checked_choice, is_finite, number, positive
from eel_common.wording import did_you_mean, shown

from eel_dynamics.model.scene import ROUGH_FRICTION, Scene
from eel_dynamics.model.section_data import WATCHED

PRESETS = {"draft": 1e-2, "standard": 1e-4, "fine": 1e-6, "reference": 1e-8}
STANDARD = "standard"  # the default
COARSEST, FINEST = 0.1, 1e-10
# Number of step errors that add up in a swim: in a run that measures its error and is refined if that is too large; and
# in one that cannot be refined, such as a node's, with a margin for sensitive motions.
STEPS_ERRORS, SAFE_STEPS_ERRORS = 400.0, 1000.0
# The same at a target of 1e-4 where the third derivative of the curvature jumps at each control step. The pair takes
# one or two steps between two jumps, and more with the fifth root of the target. Adams' method, a multistep method,
# takes 10 to 20.
CONTROL_STEPS_ERRORS = 300.0
# The same for a robot's steps, of order 3: errors were 0.2 to 6 times the tolerance (18 for a tail with little
# damping), at any tolerance.
ROBOT_STEPS = 20.0
# A further factor with series springs: they ring after each command, and the torque's error is 50 times the tolerance.
RINGING = 4.0
POINTS_PER_DECADE = 8.0  # per body length: one block of nodes, processed together
COARSE_POINTS = 7.0, -3.0  # per decade, and at a target of 1, if that gives fewer: for runs that are refined
# The pair's output between steps is of order 4 and Adams' is a cubic: below this target its torque needs shorter steps.
CUBIC_TARGET = 5e-4
LEAST_POINTS = 4.0  # per body length
FIXED_STEPS = 12.0  # per period, of the classical method at a target of 1e-2
FIXED = "fixed steps"
ROBOTS = "rosenbrock"  # the method of robots, for any requested method
KINKS = tuple(WATCHED)
ORDERS = {"adams": (1, 2, 3, 4, 5, 6), "dormand_prince": (5,), "classical": (4,), ROBOTS: (3,)}
FINEST_TOLERANCE = 1e-13  # below, round-off
LONGEST_STEP = 0.1  # of the shortest time over which the shape changes. The works are integrals over it
ANY = 30.0  # placeholder for the resolution until the scene is known
OTHER_GRIDS = 4  # attempts at adding points until the grid changes: a robot has many panels
FURTHER_POINTS = 9.0  # added points per length that refine any grid: nodes come in blocks of eight
WAVES_POWER = 0.85  # points grow with this power of the number of waves on the body
SPARED = 8.0  # of the spare points per length in the panels, those that also grow with the waves
# The companion of a run, which measures its error: about ten times the error, at about a third of the cost.
# Half of the points show the error of the grid even if it falls only with the first power of the points. With
# less than `FEW_POINTS` per length 60 % remain: nodes come in blocks, and at a target of 1e-3 the companion of a
# run of 40 nodes had 24, whose own error was above the target.
# The longest step differs too, because it alone may limit the steps of both. With ten times the tolerance Adams' method
# often takes the same steps: 9 of 277 random swims then had an error above its estimate, with 30 times 3.
# A tolerance below `FINE` needs no more than 20 times; above, two runs of long steps may agree by chance (1 of 239
# sensitive swims at a target of 1e-2).
LOOSER, FEWER_POINTS, LONGER_STEPS = 30.0, 0.5, 1.5
FEW_POINTS, FEWER_OF_FEW = 22.0, 0.6
FINE, LOOSER_THAN_FINE = 1e-6, 20.0
# The errors of a robot's steps are proportional to the tolerance, so the distance to a companion with ten times the
# tolerance is about nine times the error. The estimate is all of it, not a part: at the limits of motors and stops
# a companion may be as exact as the run by chance. With half of it, 4 of 3,500 robots exceeded their target unnoticed.
# Steps that only growth bounds, as the first ones, have ten times the error too if they are longer by the cube root
# of ten.
ROBOT_LOOSER, ROBOT_LONGER_STEPS = 10.0, 2.15
LEAST_ROBOT_TIGHTER = 1.0 / 4.0
ADAMS_ERROR = 3.0  # times the error of the embedded pair at the same tolerance
# Changes of a tightened run, with the ratio r < 1 of the wanted error to the measured one: the tolerance by r^1.2,
# the points by r^-0.2, the longest steps by r^0.2. With orders 5 to 6 each of these reduces the error by r or more.
TIGHTER, DENSER, SHORTER = 1.2, 0.2, 0.2
LEAST_TIGHTER, LEAST_DENSER = 1.0 / 8.0, 1.4  # the previous run becomes the companion of the tightened one
LEAST_TIGHTENED = 0.02  # least ratio at a time: a saturated error tells little about the settings


@lru_cache(maxsize=256)
def variant(settings: "Accuracy", **changes: Any) -> "Accuracy":
    """The `settings` with these `changes`, cached for the points of a sweep."""
    return dataclasses.replace(settings, **changes)


@dataclass(frozen=True, kw_only=True, repr=False)
class Accuracy:
    """Settings of a run. `ValueError` names a bad setting.

    Attributes:
        name: of the settings, in messages.
        resolution: points per body length, 1 to 1000.
        tolerance: relative error per adaptive step.
        step: [s]; if given, the steps are those of the classical Runge-Kutta method (order 4), of this length.
        method: "dormand_prince" (order 5) or "adams" (order 1 to 6), or "classical" for fixed steps. Robots always use
            "rosenbrock" (order 3).
        order: of the method; 5 by default ("classical": 4).
        target: the relative error for which the settings are made, 1e-10 to 0.1; None if they were given one by one.
            With a target, resolution, tolerance, method and order are chosen when the scene is known.
        fixed: if given, the number of steps of the classical method per shortest period of the law (or per second).
        kinks: which kinks of the drag along the body are found and integrated exactly: "all", only the "jumps", or
            "none". V|V| has a kink where cross flow or roll changes its sign; the printed friction law jumps.
        longest_step: of adaptive steps, relative to the shortest time over which the shape changes; up to 1.
        waves: number of waves on the body that the points must resolve; None: those of law and flow.
        refinable: whether the run is refined if its measured error exceeds the target, as by `simulate`: then the
            settings chosen for a target are cheaper.
    """

    name: str
    resolution: float
    tolerance: float = 1e-6
    step: float | None = None
    method: str = "dormand_prince"
    order: Any = None  # an int after construction
    target: float | None = None
    fixed: float | None = None
    kinks: str = "all"
    longest_step: float = LONGEST_STEP
    refinable: bool = False
    waves: float | None = None

    def __post_init__(self) -> None:
        if self.step is not None or self.fixed is not None:
            object.__setattr__(self, "method", "classical")
        if (
            not isinstance(self.method, str)
            or self.method not in ORDERS
            or (self.method == "classical" and self.step is None and self.fixed is None)
        ):
            raise ValueError(
                f"accuracy method must be adams, dormand_prince or (with a step) classical, got {shown(self.method)}"
            )
        orders = ORDERS[self.method]
        if self.order is None:
            object.__setattr__(self, "order", 5 if 5 in orders else orders[0])
        if isinstance(self.order, bool) or self.order not in orders:
            possible = f"{orders[0]} to {orders[-1]}" if len(orders) > 1 else f"{orders[0]}"
            raise ValueError(f"accuracy order of the method {self.method} must be {possible}, got {shown(self.order)}")
        object.__setattr__(self, "order", int(self.order))
        number("accuracy resolution", self.resolution, "points per body length", minimum=1.0, maximum=1000.0)
        checked_choice("accuracy kinks", self.kinks, KINKS)
        if self.target is not None:
            number("accuracy target", self.target, minimum=FINEST, maximum=COARSEST)
            if self.step is not None:
                raise ValueError(f"accuracy step cannot be given beside a target, got {shown(self.step)} s")
        positive("accuracy tolerance", self.tolerance)
        number("accuracy longest_step", self.longest_step, minimum=0.0, maximum=1.0, exclusive=True)
        if self.step is not None:
            positive("accuracy step", self.step, "s")
        if self.waves is not None:
            positive("accuracy waves", self.waves)
        unknown = self.fixed == 0.0 and self.target is not None  # until the scene is known
        if self.fixed is not None and (
            self.step is not None or not (unknown or (is_finite(self.fixed) and self.fixed > 0.0))
        ):
            raise ValueError(f"accuracy fixed must be > 0 steps by period, and no step given, got {shown(self.fixed)}")

    def __repr__(self) -> str:
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        others = [item.name for item in fields(self) if values[item.name] != item.default]
        return f"Accuracy({', '.join(f'{name}={values[name]!r}' for name in others)})"

    def points_per_length(self, waves: float) -> float:
        """Points per body length for `waves` waves on the body. One wave or less needs `resolution`."""
        waves = waves if self.waves is None else self.waves
        return float(min(1000.0, (self.resolution + SPARED) * max(1.0, waves) ** WAVES_POWER - SPARED))

    def in_scene(self, scene: Scene) -> "Accuracy":
        """The settings for the target in `scene`. Settings given one by one stay the same."""
        if self.target is None:
            return self
        decades = math.log10(1.0 / self.target)
        points = POINTS_PER_DECADE * decades
        if self.refinable and scene.friction not in ROUGH_FRICTION:
            points = min(points, COARSE_POINTS[0] * decades + COARSE_POINTS[1])
        resolution = max(LEAST_POINTS, points)
        if self.fixed is not None:
            return variant(self, resolution=resolution, fixed=FIXED_STEPS * (1e-2 / self.target) ** 0.25)
        pair = scene.ledger or (scene.internal_wrench and not (self.refinable and self.target > CUBIC_TARGET))
        method = "dormand_prince" if pair else "adams"
        steps = STEPS_ERRORS if self.refinable else SAFE_STEPS_ERRORS
        tolerance = max(FINEST_TOLERANCE, self.target / steps)
        return variant(self, resolution=resolution, tolerance=tolerance, method=method, order=5)

    def for_control_steps(self) -> "Accuracy":
        """These settings in a scene, without a target, for a curvature that changes at each of many short control
        steps.

        Settings given one by one stay the same.
        """
        if self.target is None or self.fixed is not None:
            return self.as_it_is()
        steps = CONTROL_STEPS_ERRORS * (1e-4 / self.target) ** 0.2
        tolerance = max(FINEST_TOLERANCE, self.target / steps)
        return variant(self.as_it_is(), tolerance=tolerance, method="dormand_prince", order=5)

    def for_robot(self, rings: bool = False) -> "Accuracy":
        """These settings in a scene, for the steps of a robot. Fixed steps stay the same.

        rings: whether the robot has series springs.
        """
        if self.method in ("classical", ROBOTS):
            return self
        steps = ROBOT_STEPS * (RINGING if rings else 1.0)
        tolerance = self.tolerance if self.target is None else max(FINEST_TOLERANCE, self.target / steps)
        return variant(self, tolerance=tolerance, method=ROBOTS, order=3)

    def as_it_is(self) -> "Accuracy":
        """The same settings without a target. No scene and no motion changes them."""
        return variant(self, target=None)

    def coarser(self) -> "Accuracy":
        """Settings with about ten times the error, for the companion with which a run measures its own error."""
        looser = LOOSER if self.tolerance > FINE else LOOSER_THAN_FINE
        looser = ROBOT_LOOSER if self.method == ROBOTS else looser
        fewer = FEWER_POINTS if self.resolution >= FEW_POINTS else FEWER_OF_FEW
        return self._changed(looser, fewer, self._longer_steps)

    @property
    def _longer_steps(self) -> float:
        """The factor of a companion's longest step."""
        return ROBOT_LONGER_STEPS if self.method == ROBOTS else LONGER_STEPS

    def by_adams(self) -> "Accuracy":
        """Settings with about the same error with Adams' method, if these are for the embedded pair."""
        if self.method != "dormand_prince":
            return self
        return variant(self, method="adams", order=5, tolerance=max(FINEST_TOLERANCE, self.tolerance / ADAMS_ERROR))

    def tightened(self, ratio: float) -> "Accuracy":
        """Settings for an error of `ratio` (< 1) times the error with these. These settings suit their companion."""
        ratio = max(ratio, LEAST_TIGHTENED)
        looser, denser, longer = ratio**TIGHTER, ratio**-DENSER, ratio**SHORTER
        least = LEAST_ROBOT_TIGHTER if self.method == ROBOTS else LEAST_TIGHTER
        changes = min(looser, least), max(denser, LEAST_DENSER), min(longer, 1.0 / self._longer_steps)
        return variant(self._changed(*changes), kinks="all")

    def with_other_points(self) -> "Accuracy":
        """The same settings with enough additional points to change the grid."""
        return variant(self, resolution=min(1000.0, max(1.4 * self.resolution + 2.0, self.resolution + FURTHER_POINTS)))

    def _changed(self, looser: float, denser: float, longer: float) -> "Accuracy":
        tolerance = max(self.tolerance * looser, min(self.tolerance, FINEST_TOLERANCE))
        resolution, longest = self.resolution * denser, self.longest_step * longer
        return variant(
            self,
            resolution=min(max(resolution, 1.0), 1000.0),
            tolerance=min(tolerance, 1.0),
            longest_step=min(longest, 1.0),
            step=self.step and self.step * longer,
            fixed=self.fixed and self.fixed / longer,
            target=None,
        )

    @staticmethod
    def of(value: "str | float | Accuracy") -> "Accuracy":
        """The settings for `value`.

        value: a preset's name or a target relative error, either followed by ", fixed steps" if wanted. Settings are
        returned unchanged. `ValueError` lists the possible values.
        """
        if isinstance(value, Accuracy):
            return value
        return _of_number(value) if type(value) is float else _settings_of(value)


def _settings_of(value: Any) -> Accuracy:
    if isinstance(value, str):
        name = value.strip()
        if name in PRESETS:
            return Accuracy(name=name, target=PRESETS[name], resolution=ANY)
        if name.endswith(FIXED):
            wanted = Accuracy.of(name.removesuffix(FIXED).rstrip(" ,"))
            return variant(wanted, name=name, method="classical", order=4, fixed=0.0)
    try:
        target = np.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        target = np.nan
    if np.isnan(target):
        raise ValueError(
            f"accuracy must be one of {', '.join(PRESETS)}, or a target relative error "
            f"(either may have ', {FIXED}' behind it), got {shown(value)}"
            f"{did_you_mean(value, PRESETS) if isinstance(value, str) else ''}"
        )
    if not FINEST <= target <= COARSEST:
        raise ValueError(
            f"accuracy must be a target relative error from {FINEST:g} to {COARSEST:g} (double precision carries a "
            f"run no further than that), got {shown(value)}"
        )
    return Accuracy(name=f"{target:g}", target=target, resolution=ANY)


_of_number = lru_cache(maxsize=64)(_settings_of)
