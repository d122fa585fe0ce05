"""The accuracy of a run: one word or one number gives the nodes along the body, the method and the steps in time.

A target is a relative error. The error of the head's position at the end is relative to the length of its path, or to
the length of the body if that is longer. The error of the torque field is relative to its own maximum.

The settings that deliver a target were measured. They stand in `accuracy_table.csv`, which `calibration.calibrate`
writes. The table has separate rows for:

- scenes with and without drag (free motion in space is sensitive: errors grow);
- friction laws with and without a turbulent part (the printed law jumps);
- runs with the internal wrench or the ledger, and runs without;
- motions that stay in a plane (they are smoother and need fewer steps), and others.

The table holds for a swim of nominal difficulty (`difficulty.py`). A harder swim takes the settings of a finer target.
An easier swim takes those of a coarser target.
"""

import csv
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_gaits.quantity import is_finite
from eel_gaits.wording import shown

from eel_dynamics.accuracy.budget import Budget
from eel_dynamics.curvature.difficulty import NOMINAL, Difficulty
from eel_dynamics.model.section_data import WATCHED


class Key(NamedTuple):
    """A case that has its own rows in the `table`."""

    drag: bool
    turbulent: bool  # friction
    torque: bool  # the internal wrench or the ledger
    plane: bool


PRESETS = {"draft": 1e-2, "standard": 1e-4, "fine": 1e-6, "reference": 1e-8}
COARSEST, FINEST = 0.1, 1e-10
TABLE_FILE = Path(__file__).with_name("accuracy_table.csv")
FIELDS = (*Key._fields, "target", "resolution", "kinks", "tolerance", "method", "order", "fixed")
CHOSEN = "kinks", "tolerance", "method", "order"  # for steps that are not fixed
TURBULENT = "printed", "blended"  # laws of friction
FIXED = "fixed steps"
KINKS = tuple(WATCHED)
ORDERS = {"adams": (1, 2, 3, 4, 5, 6), "dormand_prince": (5,), "classical": (4,)}
FINEST_TOLERANCE = 1e-13  # below, round-off
# The loosest tolerance of the embedded pair, and of the run that an error estimate compares with. With a looser one, a
# gait's longest step limits the steps. The tolerance alone limits those of a light body that the water stops.
LOOSEST_TOLERANCE = 1e-4
LOOSEST = {"adams": 1e-2, "dormand_prince": LOOSEST_TOLERANCE}
# For a target looser than a row's, the row's tolerance grows with this power of their ratio. Errors may grow faster.
LOOSENED = 0.8
# Below this target an easier swim takes no coarser settings. The errors are then those of the places of kinks and of
# round-off, which gentle swims have too.
LEAST_SCALED = 3e-8
# Beyond the finest row, points and fixed steps grow with these powers of the ratio of the targets.
MORE_POINTS, MORE_STEPS = 0.2, 0.25
BEST = {"resolution": 200.0, "tolerance": 1e-11}  # of the preset reference, where its target cannot be promised
ANY = {"resolution": 30.0}  # until the scene is known
FURTHER_POINTS = 9.0  # more points per length, which make any grid finer: the last eight nodes are always filled
WAVES_POWER = 0.85  # points grow with this power of the number of waves on the body
BENT = 1.5  # waves on the body; every law of the table has fewer
# Above BENT waves, the tolerance falls with this power of their number, but not below this factor.
BENT_POWER, BENT_LEAST = 1.5, 0.01
SPARED = 8.0  # points per length that grow with the waves too, of those that the panels have to spare


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Settings of a run. `ValueError` names a setting that does not fit.

    Attributes:
        name: what messages call the settings.
        resolution: points per body length, 1 to 1000.
        tolerance: relative error per adaptive step.
        step: [s]; where given, the steps are those of the classical Runge-Kutta method (order 4), of this length.
        method: "dormand_prince" (order 5) or "adams" (order 1 to 6), or "classical" where the steps are fixed.
        order: of the method; 5 where none is given ("classical": 4).
        target: the relative error that the settings are for; None where they were given one by one.
        fixed: where given, so many steps of the classical method per shortest period of the law (or per second).
        kinks: which kinks of the drag along the body are found and integrated exactly: "all", the "jumps" alone, or
            "none". V|V| has a kink where cross flow or roll change their sign; the printed friction law jumps.
    """

    name: str
    resolution: float
    tolerance: float = 1e-6
    step: float | None = None
    method: str = "dormand_prince"
    order: int | None = None
    target: float | None = None
    fixed: float | None = None
    kinks: str = "all"

    def __post_init__(self):
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
        if not (is_finite(self.resolution) and 1.0 <= self.resolution <= 1000.0):
            raise ValueError(
                f"accuracy resolution must lie in 1 to 1000 points per body length, got {shown(self.resolution)}"
            )
        if not isinstance(self.kinks, str) or self.kinks not in KINKS:
            raise ValueError(f"accuracy kinks must be one of {', '.join(KINKS)}, got {shown(self.kinks)}")
        if not (is_finite(self.tolerance) and self.tolerance > 0.0):
            raise ValueError(f"accuracy tolerance must be > 0, got {shown(self.tolerance)}")
        if self.step is not None and not (is_finite(self.step) and self.step > 0.0):
            raise ValueError(f"accuracy step must be > 0 s, got {shown(self.step)}")
        unknown = self.fixed == 0.0 and self.target is not None  # until the scene is known
        if self.fixed is not None and (
            self.step is not None or not (unknown or (is_finite(self.fixed) and self.fixed > 0.0))
        ):
            raise ValueError(f"accuracy fixed must be > 0 steps by period, and no step given, got {shown(self.fixed)}")

    def points_per_length(self, waves: float) -> float:
        """Points per body length for `waves` waves on the body. One wave or less needs `resolution`."""
        return min(1000.0, (self.resolution + SPARED) * max(1.0, waves) ** WAVES_POWER - SPARED)

    def in_scene(self, scene, plane: bool = False, difficulty: Difficulty = NOMINAL) -> "Accuracy":
        """The settings that deliver the target in `scene`, in a swim of this `difficulty`.

        plane: the motion stays in a plane. Settings that were given one by one stay the same. `ValueError` where the
        table has no settings for the target.
        """
        if self.target is None:
            return self
        key = key_of(scene, plane)
        target_scale = difficulty.target_scale(key.drag, key.torque, key.plane)
        return _from_target(self.name, self.target, key, self.fixed is not None, target_scale)

    def for_waves(self, waves: float) -> "Accuracy":
        """The settings for the same target with `waves` waves on the body.

        They differ where the waves are more than the laws of the table have. A rolled-up body carries its head about:
        the error limits its steps, not the longest step.
        """
        if self.target is None or self.fixed is not None or waves <= BENT:
            return self
        return replace(self, tolerance=self.tolerance * max(BENT_LEAST, (BENT / waves) ** BENT_POWER))

    def for_fast_start(self) -> "Accuracy":
        """The settings for the same target with a large initial velocity.

        The table was measured with gaits that start from rest. In a fast spin the errors of Adams' steps add up to ten
        times more. Those of the embedded pair do not.
        """
        if self.target is None:
            return self
        exact = replace(self, kinks="all")
        if self.method != "adams":
            return exact
        return replace(exact, method="dormand_prince", order=5, tolerance=min(self.tolerance, LOOSEST_TOLERANCE))

    def as_it_is(self) -> "Accuracy":
        """The same settings without a target. No scene and no motion changes them."""
        return replace(self, target=None)

    def finer(self) -> "Accuracy":
        """Settings that are at least some ten times as exact. An estimate of the error compares with them."""
        resolution = min(1000.0, max(1.4 * self.resolution + 2.0, self.resolution + FURTHER_POINTS))
        in_space = {"resolution": resolution, "kinks": "all", "target": None}
        if self.step is not None:
            return replace(self, **in_space, step=0.5 * self.step)
        if self.fixed is not None:
            return replace(self, **in_space, fixed=2.0 * self.fixed)
        tolerance = max(self.tolerance / 30.0, min(self.tolerance, FINEST_TOLERANCE))
        return replace(self, **in_space, tolerance=min(tolerance, LOOSEST_TOLERANCE))

    @staticmethod
    def of(value: "str | float | Accuracy") -> "Accuracy":
        """The settings, or the `Budget`, that `value` asks for.

        value: a preset's name or a target relative error, either with ", fixed steps" behind it; or a budget of time
        such as "fastest within 5 ms per second". Settings and budgets are returned as they are. `ValueError` says what
        is possible.
        """
        if isinstance(value, Accuracy):
            return value
        return _of_number(value) if type(value) is float else Accuracy._of(value)

    @staticmethod
    def _of(value) -> "Accuracy":
        if isinstance(value, Budget):
            return value
        if isinstance(value, str):
            name = value.strip()
            if name in PRESETS:
                return Accuracy(name=name, target=PRESETS[name], **ANY)
            if name.startswith("fastest"):
                return Budget.of(name)
            if name.endswith(FIXED):
                wanted = Accuracy.of(name.removesuffix(FIXED).rstrip(" ,"))
                return replace(wanted, name=name, method="classical", order=4, fixed=0.0)
        try:
            target = np.nan if isinstance(value, bool) else float(value)
        except (TypeError, ValueError, OverflowError):
            target = np.nan
        if np.isnan(target):
            raise ValueError(
                f"accuracy must be one of {', '.join(PRESETS)}, a target relative error, or a budget such as 'fastest "
                f"within 5 ms per second' (a name or number may have ', {FIXED}' behind it), got {shown(value)}"
            )
        if not FINEST <= target <= COARSEST:
            raise ValueError(
                f"accuracy must be a target relative error from {FINEST:g} to {COARSEST:g} (double precision carries a "
                f"run no further than that), got {shown(value)}"
            )
        return Accuracy(name=f"{target:g}", target=target, **ANY)


_of_number = lru_cache(maxsize=64)(Accuracy._of)


def within_budget(
    budget: Budget, scene, plane: bool, difficulty: Difficulty, swim_time: Callable[[object, float], float]
) -> Accuracy:
    """The finest settings of the table that keep within the `budget` in `scene`. `ValueError` where none do.

    plane: the motion stays in a plane. Their target is what they deliver in a swim of this `difficulty`.
    swim_time(scene, target): wall time [s] per simulated second.
    """
    targets = [row["target"] for row in table()[key_of(scene)]]
    best = budget.finest(targets, lambda target: swim_time(scene, target))
    key = key_of(scene, plane)
    target_scale = difficulty.target_scale(key.drag, key.torque, key.plane)
    return replace(Accuracy.of(best).in_scene(scene, plane), name=budget.name, target=best / target_scale)


def key_of(scene, plane: bool = False) -> Key:
    """The key of the `table` for `scene`. plane: the motion stays in a plane."""
    drag = bool(scene.resistive)
    turbulent = drag and scene.friction in TURBULENT
    return Key(drag, turbulent, bool(scene.internal_wrench or scene.ledger), bool(scene.planar or plane))


@cache
def table() -> dict[Key, tuple[dict, ...]]:
    """The rows of the table for each key, from the coarsest target to the finest.

    fixed: steps of the classical method per period; None where no number of them delivers the target.
    """
    with open(TABLE_FILE, newline="") as file:
        rows = [
            {"target": float(row["target"])}
            | {name: row[name] == "1" for name in Key._fields}
            | {"resolution": float(row["resolution"]), "tolerance": float(row["tolerance"])}
            | {"method": row["method"], "order": int(row["order"]), "kinks": row["kinks"]}
            | {"fixed": float(row["fixed"]) if row["fixed"] else None}
            for row in csv.DictReader(file)
        ]
    found = {}
    for row in sorted(rows, key=lambda row: -row["target"]):
        found.setdefault(Key(*(row[name] for name in Key._fields)), []).append(row)
    return {key: tuple(rows) for key, rows in found.items()}


@cache
def _from_target(name: str, target: float, key: Key, fixed: bool, target_scale: float) -> Accuracy:
    rows = [row for row in table()[key] if not fixed or row["fixed"] is not None]
    if rows[-1]["target"] > target * (1.0 + 1e-9):
        if name == "reference":
            return Accuracy(name=name, **BEST)
        drag = ("with drag and turbulent friction" if key.turbulent else "with drag") if key.drag else "without drag"
        finest = rows[-1]["target"]
        raise ValueError(
            f"accuracy {name} cannot be had {drag}: the finest that was measured to be delivered is {finest:g}"
        )
    target_scale = min(target_scale, 1.0) if target < LEAST_SCALED else target_scale
    fitting = [row for row in rows if row["target"] <= target * target_scale * (1.0 + 1e-9)]
    row = fitting[0] if fitting else rows[-1]
    coarser = rows[max(0, len(rows) - len(fitting) - 1)]
    return _scaled(row, coarser, target * target_scale / row["target"], fixed, name=name, target=target)


def _scaled(row: dict, coarser: dict, by: float, fixed: bool, **named) -> Accuracy:
    """The settings for `by` times the target of a `row` of the table.

    Where `by` is more than 1, the tolerance is looser than the row's, but no looser than that of the `coarser` row.
    Where `by` is less than 1, the row is the finest of the table, and the settings are finer than the row's.
    """
    resolution = min(1000.0, row["resolution"] * max(1.0, by**-MORE_POINTS))
    if fixed:
        return Accuracy(resolution=resolution, fixed=row["fixed"] * max(1.0, by**-MORE_STEPS), **named)
    chosen = {each: row[each] for each in CHOSEN}
    alike = all(row[each] == coarser[each] for each in ("method", "order")) and coarser is not row
    loosest = coarser["tolerance"] if alike else LOOSEST[row["method"]]
    tolerance = row["tolerance"] * (by**LOOSENED if by > 1.0 else by)
    chosen["tolerance"] = max(min(tolerance, loosest), FINEST_TOLERANCE)
    return Accuracy(resolution=resolution, **chosen, **named)
