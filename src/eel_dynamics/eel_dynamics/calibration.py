"""Calibration of the targets of accuracy: what settings deliver which error, measured over gaits, bodies and scenes.

Every case is swum once with far more points and far smaller steps than any setting has; the error of a setting is the
greater of the head's position at the end and of the torque (`errors`). Points along the body and steps in time are
varied apart, since their errors add. For each target the table gets the cheapest settings whose worst error over all
cases stays below it.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from eel_gaits.law import Law, Ramp, Term

from eel_gaits import gait

from .accuracy import FIELDS, FINEST, TABLE_FILE, Accuracy
from .body import Body
from .errors import errors
from .run import Run, simulate
from .scene import Scene

TARGETS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
RESOLUTIONS = (4.0, 6.0, 8.0, 10.0, 13.0, 17.0, 22.0, 30.0, 40.0, 55.0, 75.0, 100.0, 140.0, 200.0)
TOLERANCES = tuple(10.0 ** (-0.5 * k) for k in range(5, 27))
METHODS = (("adams", 3), ("adams", 4), ("adams", 5), ("dormand_prince", 5))
ADAMS_LEAST = 1e-9  # tolerance below which Adams' steps are never the cheaper ones
REFERENCE = Accuracy(name="reference of the calibration", resolution=300.0, tolerance=1e-13)
DENSE, EXACT = 140.0, 1e-12  # resolution and tolerance of what is not varied
SHARE = 0.7  # of the target for the worst case: laws and scenes that are not among the cases may be worse
PART_OF_SPACE = 0.3  # of that, for the points along the body


@dataclass(frozen=True, kw_only=True)
class Case:
    """What is swum: a law by a body in a scene, for a time [s]."""

    name: str
    law: Law
    body: Body
    scene: Scene
    duration: float = 4.0


def random_law(seed: int, length: float, planar: bool = False) -> Law:
    """A law with waves in yaw and pitch and a bend, begun over a time of its own."""
    rng = np.random.default_rng(seed)
    terms = []
    for axis in ("yaw",) if planar else ("yaw", "pitch"):
        size = (1.0 if axis == "yaw" else 0.5) / length
        amplitude = tuple(size * rng.uniform(-1.0, 1.0, 3) * (1.5, 1.0 / length, 2.0 / length**2))
        terms.append(
            Term(
                axis=axis,
                amplitude=amplitude,
                wavelength=length * rng.uniform(0.7, 2.0),
                period=rng.uniform(0.7, 1.5),
                phase=rng.uniform(0.0, 6.0),
                envelope=(Ramp(0.0, rng.uniform(0.5, 1.5), 1.0),),
            )
        )
        bend = Ramp(rng.uniform(0.5, 1.5), rng.uniform(2.0, 3.0), 1.0)
        terms.append(Term(axis=axis, amplitude=(0.7 * size,), phase=np.pi / 2.0, envelope=(bend,)))
    return Law(*terms, name=f"random {seed}")


def cases(drag: bool = True, seeds=range(3)) -> list[Case]:
    """The library's gaits and random laws, on both bodies, in the scenes that differ most; with or without drag."""
    boyer, kern = Body.boyer2010(), Body.kern2006()
    names = ("falling", "straight", "turning", "rolling", "helix", "kern_fast", "backward")
    swimming = [(name, gait(name), boyer if "kern" not in name else kern) for name in names]
    swimming += [(f"random {seed}", random_law(seed, 1.0), (boyer, kern)[seed % 2]) for seed in seeds]
    scenes = {"laminar": Scene(friction="laminar", ledger=False), "printed": Scene(ledger=False)}
    if not drag:
        scenes = {"no drag": Scene(resistive=False, ledger=False)}
    found = [
        Case(name=f"{name}, {scene}", law=law, body=body, scene=scenes[scene], duration=_duration(name, drag))
        for name, law, body in swimming
        for scene in scenes
        if scene != "printed" or name in ("falling", "kern_fast")
    ]
    plane = Scene(planar=True, friction="laminar", resistive=drag, ledger=False)
    return [*found, Case(name="straight, planar", law=gait("straight"), body=boyer, scene=plane)]


def _duration(name: str, drag: bool) -> float:
    """The paper's gait needs 10 s to be whole; without drag that is too sensitive to stand for others."""
    return 10.0 if name == "falling" and drag else 4.0


def swim(case: Case, accuracy) -> Run:
    """The run of a case that errors are measured on."""
    return simulate(
        case.law,
        case.duration,
        body=case.body,
        scene=case.scene,
        accuracy=accuracy,
        sample_period=0.05,
        stations=31,
        verify=False,
    )


def calibrate(path: Path | str | None = None, say=lambda text: None) -> list[dict]:
    """Measure the table of targets anew and write it to `path` (by default the library's own). Returns its rows."""
    rows = []
    for drag in (True, False):
        found = [_measure(case, say) for case in cases(drag)]
        space = np.array([each[0] for each in found])  # (cases, resolutions, 2)
        time = np.array([each[1] for each in found])  # (cases, methods, tolerances, 3): errors, evaluations
        for torque in (True, False):
            worst_space = np.max(space if torque else space[..., :1], axis=(0, 2))
            worst_time = np.max(time[..., :2] if torque else time[..., :1], axis=(0, 3))
            evaluations = np.mean(time[..., 2], axis=0)
            for target in TARGETS:
                row = _cheapest(target, worst_space, worst_time, evaluations)
                if row is not None:
                    rows.append({"drag": int(drag), "torque": int(torque), "target": target} | row)
                    say(f"drag {drag}, torque {torque}: {rows[-1]}")
    with open(TABLE_FILE if path is None else path, "w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        writer.writerows(rows)
    return rows


def _measure(case: Case, say):
    reference = swim(case, REFERENCE)
    space = [
        _pair(swim(case, Accuracy(name="calibration", resolution=resolution, tolerance=EXACT)), reference)
        for resolution in RESOLUTIONS
    ]
    time = [[_of_tolerance(case, reference, *method, tolerance) for tolerance in TOLERANCES] for method in METHODS]
    say(f"{case.name}: measured")
    return space, time


def _pair(run: Run, reference: Run) -> tuple[float, float]:
    found = errors(run, reference)
    return found.position, found.torque


def _of_tolerance(case: Case, reference: Run, method: str, order: int, tolerance: float):
    if method == "adams" and tolerance < ADAMS_LEAST:
        return np.inf, np.inf, np.inf
    accuracy = Accuracy(name="calibration", resolution=DENSE, tolerance=tolerance, method=method, order=order)
    run = swim(case, accuracy)
    return *_pair(run, reference), run.evaluations


def _cheapest(target: float, space, time, evaluations) -> dict | None:
    """The cheapest settings with a worst error below the target; None where none of those measured has it."""
    allowed = SHARE * target
    enough = np.flatnonzero(_from_here_on(space) <= PART_OF_SPACE * allowed)
    choices = []
    for (method, order), worst, cost in zip(METHODS, time, evaluations, strict=True):
        good = np.flatnonzero(_from_here_on(worst) <= (1.0 - PART_OF_SPACE) * allowed)
        if len(good):
            choices.append((cost[good[0]], method, order, TOLERANCES[good[0]]))
    if not len(enough) or not choices or target < FINEST:
        return None
    _, method, order, tolerance = min(choices)
    return {
        "resolution": RESOLUTIONS[enough[0]],
        "tolerance": float(f"{tolerance:.2e}"),
        "method": method,
        "order": order,
    }


def _from_here_on(errors) -> np.ndarray:
    """The worst of this and all finer settings that were measured: a lucky one does not count."""
    finite = np.where(np.isfinite(errors), errors, 0.0)
    worst = np.maximum.accumulate(finite[::-1])[::-1]
    return np.where(np.isfinite(errors), worst, np.inf)
