"""How exact a run is: one word or one number, turned into nodes along the body and steps in time.

A target is a relative error: of the head's position at the end by the length of its path (or of the body, if longer),
and of the torque field by its own maximum.
"""

from dataclasses import dataclass

import numpy as np

PRESETS = {"draft": 1e-2, "standard": 1e-4, "fine": 1e-6, "reference": 1e-8}
COARSEST, FINEST = 0.1, 1e-10
# target: (points per body length, error per step), as measured over the library's gaits and bodies; between the rows by
# interpolation of logarithms. The torque asks for the points: the drag V|V| has kinks inside panels.
TABLE = {
    1e-1: (8.0, 5e-4),
    1e-2: (10.0, 5e-5),
    1e-3: (16.0, 1e-5),
    1e-4: (36.0, 1e-6),
    1e-5: (70.0, 1e-7),
    1e-6: (150.0, 1e-8),
    1e-8: (220.0, 1e-10),
    1e-10: (260.0, 1e-12),
}
WAVES_POWER = 0.85  # points grow with this power of the number of waves on the body


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Settings of a run. `resolution`: points per body length; `tolerance`: relative error per adaptive step; `step`
    [s]: where given, steps of the classical Runge-Kutta method of this length instead."""

    name: str
    resolution: float
    tolerance: float = 1e-6
    step: float | None = None

    def __post_init__(self):
        if not (np.isfinite(self.resolution) and 1.0 <= self.resolution <= 1000.0):
            raise ValueError(
                f"accuracy resolution must lie in 1 to 1000 points per body length, got {self.resolution!r}"
            )
        if not (np.isfinite(self.tolerance) and self.tolerance > 0.0):
            raise ValueError(f"accuracy tolerance must be > 0, got {self.tolerance!r}")
        if self.step is not None and not (np.isfinite(self.step) and self.step > 0.0):
            raise ValueError(f"accuracy step must be > 0 s, got {self.step!r}")

    def points_per_length(self, waves: float) -> float:
        """Points per body length for a shape of `waves` waves on the body; one wave or less needs `resolution`."""
        return min(1000.0, self.resolution * max(1.0, waves) ** WAVES_POWER)

    @staticmethod
    def of(value: "str | float | Accuracy") -> "Accuracy":
        """The settings for a preset's name or a target relative error. `ValueError` says what is possible."""
        if isinstance(value, Accuracy):
            return value
        target = value
        if isinstance(value, str):
            name = value.strip()
            if name in PRESETS:
                return _from_target(name, PRESETS[name])
            try:
                target = float(name)
            except ValueError:
                raise ValueError(
                    f"accuracy must be one of {', '.join(PRESETS)} or a target relative error, got {value!r}"
                ) from None
        try:
            target = float(target)
        except (TypeError, ValueError):
            raise ValueError(
                f"accuracy must be one of {', '.join(PRESETS)} or a target relative error, got {value!r}"
            ) from None
        if not FINEST <= target <= COARSEST:
            raise ValueError(f"accuracy must be a target relative error from {FINEST:g} to {COARSEST:g}, got {value!r}")
        return _from_target(f"{target:g}", target)


def _from_target(name: str, target: float) -> Accuracy:
    targets = np.log(sorted(TABLE))
    rows = np.array([TABLE[key] for key in sorted(TABLE)])
    resolution = np.exp(np.interp(np.log(target), targets, np.log(rows[:, 0])))
    tolerance = np.exp(np.interp(np.log(target), targets, np.log(rows[:, 1])))
    return Accuracy(name=name, resolution=float(resolution), tolerance=float(tolerance))
