"""Second part of the calibration: fits settings found with a few laws to many laws.

At the same setting, the errors of different laws differ by a factor of thirty and more. The settings found with the
gaits and a few random laws are therefore tried on many others. First, steps are shortened or points added until all
errors keep within the target. Then steps are lengthened and points removed for as long as the errors do. Last, other
methods and still fewer points are tried where they are cheaper.
"""

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

from eel_dynamics.accuracy.accuracy import LOOSEST, Accuracy

STEP = 10.0 ** (1.0 / 6.0)  # factor between tolerances
SHORTER = 2, 6  # of these factors, tried at once: with few, a loose tolerance may leave the steps at their longest
MOST_FINER = 14  # settings tried in place of one that is too coarse
GRIDS_BELOW, MOST_LONGER, MOST_SHORTER = 2, 6, 3  # grids and tolerances tried for a cheaper setting
AT_ONCE = 8  # runs between two checks for a failure


@dataclass
class Fitting:
    """Fits settings to many swimmers.

    error(swimmer, setting): the error of one of the `swimmers`. grids: resolutions [points per body length] that differ
    in their nodes, ascending. may_miss(swimmer): whether it may exceed the allowed error. waived: number of swimmers
    that may exceed it in one setting, by no more than the factor `at_most`.
    """

    swimmers: list
    error: Callable
    grids: tuple[float, ...]
    pool: ThreadPoolExecutor
    waived: int = 0
    at_most: float = math.inf
    may_miss: Callable = lambda swimmer: True

    def fitted(self, setting: Accuracy, allowed: float) -> Accuracy | None:
        """A setting near `setting` whose errors are within `allowed`, and that cannot be loosened further.

        None where none of the settings tried is fine enough.
        """
        for _ in range(MOST_FINER):
            if self._holds(setting, allowed):
                return self._loosened(setting, allowed)
            # the swimmer that failed is first: its errors show which change helps most
            choices = [self._shorter(setting, steps) for steps in SHORTER]
            choices += [each for each in (self._finer(setting), self._looking(setting)) if each]
            errors = list(self.pool.map(lambda choice: self.error(self.swimmers[0], choice), choices))
            setting = choices[errors.index(min(errors))]
        return None

    def cheapest(self, setting: Accuracy, allowed: float, cost: Callable, methods) -> Accuracy:
        """`setting`, or one of lower `cost(setting)` that keeps within `allowed`, also at the next finer tolerance.

        Tries other `methods` (method, order), other tolerances, coarser grids, and all kinks located.
        """
        grids = [each for each in self.grids if each <= setting.resolution][-GRIDS_BELOW - 1 :]
        found, least = setting, cost(setting)
        for kinks in dict.fromkeys((setting.kinks, "all")):
            for method, order in methods:
                for resolution in reversed(grids):
                    other = replace(setting, method=method, order=order, resolution=resolution, kinks=kinks)
                    for steps in range(-MOST_LONGER, MOST_SHORTER + 1):
                        trial = self._shorter(other, steps)
                        if trial.tolerance > LOOSEST[method] * 1.01:
                            continue
                        price = cost(trial)
                        if price >= least:
                            break
                        if self._holds(trial, allowed) and self._holds(self._shorter(trial, 1), allowed):
                            found, least = trial, price
                            break
        return found

    def fewest(self, setting: Accuracy, numbers: tuple[float, ...], allowed: float) -> float | None:
        """The first of the `numbers` of fixed steps within `allowed` on the grid of `setting`; None where none is."""
        for number in numbers:
            fixed = Accuracy(name=setting.name, resolution=setting.resolution, kinks=setting.kinks, fixed=number)
            if self._holds(fixed, allowed):
                return number
        return None

    def _loosened(self, setting: Accuracy, allowed: float) -> Accuracy:
        for loosen in (self._coarser, self._longer, self._coarser):
            looser = loosen(setting)
            while looser is not None and self._holds(looser, allowed):
                setting, looser = looser, loosen(looser)
        return setting

    def _holds(self, setting: Accuracy, allowed: float) -> bool:
        """Whether all errors are within `allowed`, except the waived ones. A swimmer that fails moves to the front."""
        missed = 0
        for begin in range(0, len(self.swimmers), AT_ONCE):
            some = self.swimmers[begin : begin + AT_ONCE]
            for index, error in enumerate(self.pool.map(lambda swimmer: self.error(swimmer, setting), some)):
                if error <= allowed:
                    continue
                missed += 1
                if missed > self.waived or error > self.at_most * allowed or not self.may_miss(some[index]):
                    self.swimmers.insert(0, self.swimmers.pop(begin + index))
                    return False
        return True

    @staticmethod
    def _longer(setting: Accuracy) -> Accuracy | None:
        tolerance = float(f"{setting.tolerance * STEP:.2e}")
        return replace(setting, tolerance=tolerance) if tolerance <= LOOSEST[setting.method] * 1.01 else None

    @staticmethod
    def _shorter(setting: Accuracy, steps: int) -> Accuracy:
        return replace(setting, tolerance=float(f"{setting.tolerance / STEP**steps:.2e}"))

    def _coarser(self, setting: Accuracy) -> Accuracy | None:
        below = [each for each in self.grids if each < setting.resolution]
        return replace(setting, resolution=below[-1]) if below else None

    def _finer(self, setting: Accuracy) -> Accuracy | None:
        above = [each for each in self.grids if each > setting.resolution]
        return replace(setting, resolution=above[0]) if above else None

    @staticmethod
    def _looking(setting: Accuracy) -> Accuracy | None:
        return replace(setting, kinks="all") if setting.kinks != "all" else None
