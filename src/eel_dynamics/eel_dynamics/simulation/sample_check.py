"""Checks the samples of a run before they are returned: all are finite, and the energy ledger closes.

A step of fixed length that is too long does not fail by itself: the motion grows, and every number looks like one. The
ledger (eq. 60 times the head's twist) knows: what the kinetic energy gained beyond the powers' integral came from
nowhere. Where that is more than a share of all energy that was there or passed, the motion is not the model's. A motion
too small for the body's scale to ask steps for (`floor`) is let go: its error counts by the length of the body.
"""

import math

import numpy as np

OPEN = 0.2  # share of the energy; at twice the longest useful step of the robot's gaits it is 0.03, then grows at once


def first_bad_sample(out, works: np.ndarray, done: int, start: float, floor: float) -> tuple[int, str, float] | None:
    """The first of the `done` samples of `out` (`Observations`) and `works` (T, 4) [J] that cannot be handed out: its
    index, the quantity and its value. start: kinetic energy at the start [J]; floor: energy that counts as none [J],
    infinite: the ledger is not looked at. None: all are good."""
    with np.errstate(over="ignore", invalid="ignore"):
        failures = []
        if not math.isfinite(np.add.reduce(out.whole) + np.add.reduce(works, axis=None)):
            arrays = {**out._asdict(), "works": works}
            del arrays["whole"]
            failures = [_not_finite(name, array[:done]) for name, array in arrays.items()]
        failures += [_open(out.kinetic[:done], works[:done], start, floor)] if done and np.isfinite(floor) else []
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


def _open(kinetic: np.ndarray, works: np.ndarray, start: float, floor: float):
    residual = np.abs(kinetic.sum(axis=1) - start - works.sum(axis=1))
    there = np.maximum(kinetic.sum(axis=1) + np.abs(works).sum(axis=1), start)
    passed = np.maximum.accumulate(there) + floor
    bad = residual > OPEN * passed
    if not bad.any():
        return None
    sample = int(np.argmax(bad))
    return sample, "energy from nowhere, as a share of all that passed", float(residual[sample] / passed[sample])


__all__ = ["first_bad_sample"]
