# SPDX-License-Identifier: Apache-2.0
"""Drag of a filmed robot, fitted on some of its films and judged by the speeds of the others.

Each film gives a motion and a speed. `numbers` of the body are fitted to the speeds of each choice of films, by least
squares of their logarithms; the mean error of the films that are left out is the leave-out error. It says what a
prediction is worth; the error of the films that were fitted does not.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_gaits.film.beat import Beat

from eel_dynamics import Batch, Body, Scene, simulate_batch

PLANAR = Scene(planar=True, friction="blended", internal_wrench=False, ledger=False)
BEATS = 16  # of a swim that begins at the measured speed; the later half counts
LEAST, MOST = 1e-3, 1e3  # of a coefficient
STEP = 0.1  # of its logarithm, for derivatives


@dataclass(frozen=True)
class Choice:
    """What the films of one choice give."""

    fitted: tuple[int, ...]  # films
    values: dict[str, float]  # of the body
    speeds: np.ndarray  # (F,) m/s, computed with these values

    def left_out(self, measured: np.ndarray) -> np.ndarray:
        """Errors [m/s] of the films that were not fitted."""
        rest = [film for film in range(len(measured)) if film not in self.fitted]
        return np.asarray((self.speeds - measured)[rest])


def computed(beats: Sequence[Beat], body: Body, scene: Scene = PLANAR, **numbers: float) -> np.ndarray:
    """Mean speed [m/s] of each of the `beats` on the `body` with these `numbers`; NaN where a swim stops."""
    batches = [swum(beat, body.changed(**numbers), scene) for beat in beats]
    return np.array([np.nan if each.stopped[0] else each[0].mean_speed for each in batches])


def swum(beat: Beat, body: Body, scene: Scene = PLANAR) -> Batch:
    """The swim of a `beat`, from the measured speed on, with its midlines."""
    return simulate_batch(
        [beat.law(body.length)], BEATS * beat.period, bodies=body, scenes=scene, accuracy=1e-2, estimate=False,
        twists=(0.0, 0.0, 0.0, beat.measured.speed, 0.0, 0.0), sample_period=beat.period / 20.0, stations=51,
    )  # fmt: skip


def choices(
    beats: Sequence[Beat], body: Body, first: dict[str, float], count: int, scene: Scene = PLANAR
) -> list[Choice]:
    """The fit of each choice of `count` of the `beats`, from the `first` guesses of numbers of the body."""
    from scipy.optimize import least_squares

    measured, found = np.array([beat.measured.speed for beat in beats]), []
    guess = np.log(list(first.values()))
    for fitted in itertools.combinations(range(len(beats)), count):
        mine = [beats[film] for film in fitted]

        def errors(logs: np.ndarray, mine: list[Beat] = mine, fitted: tuple[int, ...] = fitted) -> np.ndarray:
            speeds = computed(mine, body, scene, **_numbers(first, logs))
            apart: np.ndarray = np.nan_to_num(np.log(np.maximum(speeds, 1e-6) / measured[list(fitted)]), nan=10.0)
            return apart

        def slopes(logs: np.ndarray, errors: Any = errors) -> np.ndarray:
            steps = STEP * np.eye(len(logs))
            return np.stack([(errors(logs + each) - errors(logs - each)) / (2.0 * STEP) for each in steps], axis=1)

        fit = least_squares(
            errors, guess, slopes, bounds=(np.log(LEAST), np.log(MOST)), xtol=1e-3, ftol=1e-3, max_nfev=15
        )
        values = _numbers(first, fit.x)
        found.append(Choice(fitted, values, computed(beats, body, scene, **values)))
    return found


def _numbers(first: dict[str, float], logs: np.ndarray) -> dict[str, float]:
    return dict(zip(first, np.exp(logs).tolist(), strict=True))
