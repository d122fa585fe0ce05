# SPDX-License-Identifier: Apache-2.0
"""A robot swims by the log of its joints on bodies that differ in what is uncertain: drag, half-axes, added mass.

Each number counts as anywhere between its two factors. A quasi-random sample of all of them at once (Sobol) gives the
band; each end alone shows what the number does.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_common.wording import shown
from eel_dynamics.analysis.analysis import Analysis

from eel_dynamics import Body, Run, Scene, simulate_batch
from eel_gaits import SampledLaw

UNCERTAIN: dict[str, tuple[float, float]] = {  # factors, and why
    "lateral_drag": (1.0, 1.65),  # a circle across steady flow, to one in oscillating flow with KC about 10 (Sarpkaya)
    "friction_factor": (1.0, 4.0),  # a smooth plate at rest, to Lighthill's greatest for a body that beats
    "nose_drag": (0.5, 1.5),  # both ends 0.4 (AmphiBot coasting, turbulent friction) to 0.8 (Hoerner, less friction)
    "lateral_added_mass": (0.8, 1.2),  # gaps between links, to flat sides
    "half_height": (0.9, 1.1),
    "half_width": (0.9, 1.1),
}
STATIONS = 41  # along the body, beside the joints
SEED = 1


@dataclass(frozen=True)
class Replayed:
    """A swim: its path, speed and torques."""

    run: Run
    joints: np.ndarray  # (n,) m

    @property
    def speed(self) -> float:
        """Mean speed [m/s] in the later half: of whole periods, or else from end to end."""
        try:
            return Analysis(self.run).mean_speed
        except ValueError:  # the motion does not repeat
            half = len(self.run.time) // 2
            way = np.linalg.norm(self.run.center_of_mass[-1] - self.run.center_of_mass[half])
            return float(way / (self.run.time[-1] - self.run.time[half]))

    @property
    def torque(self) -> np.ndarray:
        """(T, n) N m, of the motors."""
        from scipy.interpolate import CubicSpline

        assert self.run.torque is not None  # the scene has it on
        return np.asarray(-CubicSpline(self.run.x, self.run.torque[:, :, 2], axis=1)(self.joints))

    @property
    def figures(self) -> dict[str, float]:
        """The figures of the table, by name."""
        run, torque = self.run, self.torque
        later = run.time >= 0.5 * run.time[-1]
        way = run.center_of_mass[-1] - run.center_of_mass[0]
        along = run.center_of_mass[-1] - run.center_of_mass[np.argmax(later)]
        return {
            "mean speed, later half [m/s]": self.speed,
            "way of the centre of mass, start to end [m]": float(np.linalg.norm(way)),
            "direction of the way, later half [deg]": float(np.degrees(np.arctan2(along[1], along[0]))),
            "greatest torque of a joint, later half [N m]": float(np.max(np.abs(torque[later]))),
            "RMS torque of the joints, later half [N m]": float(np.sqrt(np.mean(torque[later] ** 2))),
        }


def with_factors(body: Body, factors: dict[str, float]) -> Body:
    """The `body` with these of its numbers and half-axes times factors; its mass stays the same."""

    across = {"lateral_drag": 0, "vertical_drag": 1}

    def times(name: str, factor: float) -> Any:
        given = body.arguments[name]
        if isinstance(given, str):  # by shape
            return lambda x: factor * body.cross_flow(x)[across[name]]
        return (lambda x: factor * given(x)) if callable(given) else factor * given

    changed = body.changed(**{name: times(name, factor) for name, factor in factors.items()})
    return changed.changed(density=body.mass / changed.volume)


def replay(
    law: SampledLaw,
    body: Body,
    joints: np.ndarray,
    scene: Scene,
    *,
    uncertain: dict[str, tuple[float, float]] | None = None,
    samples: int = 32,
    duration: float | None = None,
    accuracy: float | str = 1e-3,
) -> tuple[Replayed, dict[str, tuple[Replayed | None, Replayed | None]], list[Replayed]]:
    """The swim on the `body`; with each uncertain number at its ends; and `samples` swims with all numbers drawn.

    A swim that stops is None, and is left out of the samples. `ValueError` where the first one stops, or a number is
    not known.
    """
    from scipy.stats import qmc

    ranges = UNCERTAIN if uncertain is None else uncertain
    for name, (low, high) in ranges.items():
        if name not in body.arguments or name in ("x", "length", "kinks", "nose", "name"):
            raise ValueError(f"an uncertain number must be one of the body's, got {shown(name)}")
        if not 0.0 <= low <= high:
            raise ValueError(f"factors of {name} must rise from 0 on, got {low:g} and {high:g}")
    ends = [{name: factor} for name, pair in ranges.items() for factor in pair]
    draws: list[dict[str, float]] = []
    if ranges and samples:
        low, high = np.array(list(ranges.values())).T
        drawn = low + qmc.Sobol(len(ranges), seed=SEED).random(samples) * (high - low)
        draws = [dict(zip(ranges, row, strict=True)) for row in drawn.tolist()]
    bodies = [with_factors(body, each) for each in ({}, *ends, *draws)]
    along = np.unique(np.concatenate((np.linspace(0.0, body.length, STATIONS), joints)))
    batch = simulate_batch(
        [law] * len(bodies), duration or law.duration, bodies=bodies, scenes=scene, accuracy=accuracy,
        stations=along, estimate=False,
    )  # fmt: skip
    if batch.stopped[0]:
        raise ValueError(f"the swim stops: {batch.error[0]}")
    swims = [None if batch.stopped[i] else Replayed(batch[i], joints) for i in range(len(bodies))]
    first, rest = swims[0], swims[1:]
    assert first is not None
    alone = {name: (rest[2 * place], rest[2 * place + 1]) for place, name in enumerate(ranges)}
    return first, alone, [each for each in rest[len(ends) :] if each is not None]
