# SPDX-License-Identifier: Apache-2.0
"""Checks of a run's samples before they are returned: all are finite, and the energy ledger closes.

A fixed step that is too long does not fail by itself: the motion grows, but every number stays finite. The ledger (eq.
60 times the head's twist) shows the error: the energy gains more than the integral of the powers. Where this
excess is more than a share of all energy that was there or passed, the motion is not that of the model. A motion below
`floor`, too small on the body's scale to need steps of its own, passes: its error is relative to the body's length.
"""

import math

import numpy as np

OPEN = 0.2  # share of the energy; at twice the longest useful step of the robot's gaits it is 0.03, then grows at once


def first_bad_sample(
    out, works: np.ndarray, done: int, start: float, floor: float, robot: np.ndarray | None = None
) -> tuple[int, str, float] | None:
    """The first bad sample of the first `done` ones: its index, the quantity and its value. None where all are good.

    out: `Observations`. works (T, 4) [J]. start [J]: the energy at the start. floor [J]: energy that counts as
    none; where it is infinite, the ledger is not checked. robot (T, 3): as of `EnergyLedger.of`.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        failures = []
        if not math.isfinite(np.add.reduce(out.whole) + np.add.reduce(works, axis=None)):
            arrays = out.arrays() | {"works": works}
            failures = [_not_finite(name, array[:done]) for name, array in arrays.items()]
        if done and np.isfinite(floor):
            energies, works = out.energies[:done], works[:done]
            if robot is not None:
                energies = np.column_stack((energies, robot[:done, 0]))
                works = np.column_stack((works, robot[:done, 2]))
            failures.append(_open(energies, works, start, floor))
    return min((each for each in failures if each), default=None, key=lambda each: each[0])


def _not_finite(name: str, array: np.ndarray):
    if not array.size or np.isfinite(np.add.reduce(array, axis=None)):
        return None
    bad = ~np.isfinite(array.reshape(len(array), -1))
    if not bad.any():
        return None  # the sum alone was too large
    sample = int(np.argmax(bad.any(axis=1)))
    value = float(array[sample].ravel()[np.argmax(bad[sample])])
    return sample, f"{name.replace('_', ' ')} is not finite", value


def _open(energies: np.ndarray, works: np.ndarray, start: float, floor: float):
    residual = np.abs(energies.sum(axis=1) - start - works.sum(axis=1))
    there = np.maximum(np.abs(energies).sum(axis=1) + np.abs(works).sum(axis=1), start)
    passed = np.maximum.accumulate(there) + floor
    bad = residual > OPEN * passed
    if not bad.any():
        return None
    sample = int(np.argmax(bad))
    return sample, "energy from nowhere, as a share of all that passed", float(residual[sample] / passed[sample])
