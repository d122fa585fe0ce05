# SPDX-License-Identifier: Apache-2.0
"""The paper's own scheme (`peers/paper_scheme.py`, in numba) against the library, at equal error."""

from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from eel_studies.tradeoff.measuring import REFERENCE
from measuring import REPEATS, Lines, times_in_turn

from eel_dynamics import Body, Run, Scene, Simulation, simulate
from eel_gaits import Law, falling
from others.environments import environment, measured

BODY, LAW, DURATION = Body.boyer2010(), falling(), 10.0  # s
STEP = 0.01  # s, of the paper's scheme
CELLS = (50, 100, 200)  # of the paper's scheme
COMMON = 50  # cells whose ends all share, where torques are compared
TARGETS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7)


def paper_scheme() -> Lines:
    """Runge-Kutta 4 in space (cells) and time (steps of 0.01 s), as in section 7.1 of the paper, in numba, against the
    library at no greater error; falling gait, 10 s, laminar friction. Errors of the head's position at the end by its
    path, and of the torque by its maximum. CPU times; set-up is the tabulation of body and law, theirs never
    counted."""
    python = environment("numba")
    if python is None:
        yield "skipped, numba could not be installed", None, ""
        return
    for internal in (False, True):
        scene = Scene(friction="laminar", ledger=False, internal_wrench=internal)
        period = STEP if internal else DURATION
        ours = partial(simulate, LAW, DURATION, body=BODY, scene=scene, estimate=False)
        finest = ours(accuracy=REFERENCE, sample_period=STEP, stations=COMMON + 1).in_axes("paper")
        errors = {}
        for target in TARGETS:
            run = ours(accuracy=target, sample_period=period, stations=COMMON + 1).in_axes("paper")
            errors[target] = _errors(run.position, run.torque, finest)
        yield "with the internal torque at each step" if internal else "motion alone", None, ""
        for count in CELLS:
            theirs = swum(python, LAW, BODY, DURATION, STEP, count, wrench=internal, repeats=REPEATS)
            error = _errors(theirs["position"], theirs["torque"] if internal else None, finest)
            target = next(target for target, own in errors.items() if all(np.array(own) <= error))
            swimmer = Simulation(body=BODY, scene=scene, accuracy=target, stations=count + 1)
            swimmer.adopt(LAW)
            marched = partial(swimmer.record, np.arange(round(DURATION / period) + 1) * period, internal, False)
            whole = partial(ours, accuracy=target, sample_period=period, stations=count + 1)
            times = times_in_turn({"ours": (swimmer.reset, marched), "with set-up": whole})
            seconds = {name: median(values) for name, values in times.items()}
            yield f"  {count} cells", DURATION / theirs["seconds"], f"s per CPU second, error {_text(error)}"
            said = f"s per CPU second, error {_text(errors[target])}, target {target:g}"
            yield "    ours", DURATION / seconds["ours"], said
            yield "    ours is cheaper", theirs["seconds"] / seconds["ours"], "times, both without set-up"
            yield "    its set-up counted", theirs["seconds"] / seconds["with set-up"], "times"


def _errors(position: np.ndarray, torque: np.ndarray | None, finest: Run) -> tuple[float, ...]:
    error = float(np.linalg.norm(position[-1] - finest.position[-1]) / finest.path_length)
    if torque is None or finest.torque is None:
        return (error,)
    return error, float(np.max(np.abs(torque - finest.torque)) / np.max(np.linalg.norm(finest.torque, axis=2)))


def _text(errors: tuple[float, ...]) -> str:
    return " and ".join(f"{error:.1e}" for error in errors)


def swum(
    python: Path, law: Law, body: Body, duration: float, step: float, count: int, *, wrench: bool, repeats: int = 1
) -> dict[str, Any]:
    """The paper's scheme in `count` cells, by the interpreter `python`: head's position (T, 3) [m] at all steps, the
    internal torque (T, COMMON + 1, 3) [N m], and the median CPU time of the repeats, seconds [s]."""
    theirs = measured(
        python,
        "paper_scheme.py",
        **cells_of(body, count),
        shapes=curvatures(law, duration, step, count, body.length),
        step=step,
        wrench=wrench,
        every=count // COMMON,
        repeats=repeats,
    )
    return theirs | {name: np.array(theirs[name]) for name in ("position", "torque")}


def cells_of(body: Body, count: int) -> dict[str, Any]:
    """`body`, as heavy as water, cut into `count` equal cells: what the scheme's `Cells` hold."""
    density, viscosity = 1000.0, 1e-6  # kg/m^3, m^2/s
    x = np.linspace(0.0, body.length, 2 * count + 1)
    a, b = body.half_height(x), body.half_width(x)
    area, behind = np.pi * a * b, np.maximum(x, 1e-9 * body.length)  # at the nose c_f P has a limit
    c, d = body.half_height(behind), body.half_width(behind)
    perimeter = np.pi * (1.5 * (c + d) - np.sqrt(c * d))
    roll = density * np.pi / 8.0 * (a**2 - b**2) ** 2
    inertia2, inertia3 = density * area * a**2 / 4.0, density * area * b**2 / 4.0
    nose_area = np.pi * body.nose[0] * body.nose[1]
    return {
        "width": body.length / count,
        "mass": density * area,
        "added2": density * np.pi * a**2,
        "added3": density * np.pi * b**2,
        "inertia1": inertia2 + inertia3 + roll,
        "inertia2": inertia2,
        "inertia3": inertia3,
        "added_roll": roll,
        "friction": 0.5 * density * perimeter * 0.664 * np.sqrt(viscosity / behind),
        "drag2": density * body.lateral_drag * a,
        "drag3": density * body.vertical_drag * b,
        "drag_roll": 0.5 * density * body.roll_drag * np.pi * (a**2 - b**2) ** 2,
        "nose_mass": density * nose_area * body.nose_added_mass * body.nose[2],
        "nose_drag": 0.5 * density * nose_area * body.nose_drag,
    }


def curvatures(law: Law, duration: float, step: float, count: int, length: float = 1.0) -> np.ndarray:
    """Pitch and yaw curvature, rate, acceleration (stages, 2 n + 1, 6) at each half step in time."""
    x = np.linspace(0.0, length, 2 * count + 1)
    times = np.arange(2 * round(duration / step) + 1) * 0.5 * step
    return np.array([np.concatenate([field[:, 1:] for field in law.curvature(t, x)], axis=1) for t in times])
