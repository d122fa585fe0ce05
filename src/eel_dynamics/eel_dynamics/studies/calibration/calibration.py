"""Calibration of the targets of accuracy: measures which settings deliver which error, over gaits, bodies and scenes.

Each case is simulated once as a reference, with far more points and far smaller steps than any setting. The error of a
setting is the greater of two errors: of the head's position at the end, and of the torque (`relative_errors`). Points
along the body and steps in time are varied separately, since their errors add. For each target the table gets the
cheapest settings whose worst error over all cases stays below the target. This is checked with points and steps
combined. Cases that stay in a plane have rows of their own.

Errors are relative to the difficulty of the run (`difficulty.py`), and so are targets when their settings are looked
up. The cost is counted in evaluations of the head's dynamics. For runs with torque the cost of the ledger is added: a
number of evaluations per step, measured here. The kinks of the drag are located where that is cheaper than more points
and more steps. Without it the drag is also less smooth in time. The settings found are then fitted to many more laws
(`fitting`).
"""

import csv
import os
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from eel_gaits.law import Law, Ramp, Term
from eel_gaits.output_file import replacing

from eel_dynamics.accuracy.accuracy import (
    ANY,
    CHOSEN,
    FIELDS,
    FINEST,
    KINKS,
    LOOSEST_TOLERANCE,
    TABLE_FILE,
    TURBULENT,
    Accuracy,
)
from eel_dynamics.curvature.difficulty import difficulty_of
from eel_dynamics.model.body import Body
from eel_dynamics.model.panels import panels_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.error_estimate import relative_errors
from eel_dynamics.runs.run import Run, simulate
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.studies.calibration.fitting import Fitting
from eel_gaits import falling, gait

TARGETS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 1e-9, 1e-10)
RESOLUTIONS = (
    *(2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.5, 13.0, 15.0, 17.0, 19.0, 22.0, 26.0, 30.0, 35.0, 40.0, 47.0),
    *(55.0, 65.0, 75.0, 100.0, 140.0, 200.0),
)
TOLERANCES = tuple(10.0 ** (-k / 6.0) for k in range(12, 79))
METHODS = (("adams", 4), ("adams", 5), ("adams", 6), ("dormand_prince", 5))
FIXED_STEPS = tuple(float(round(8.0 * 10.0 ** (0.1 * k))) for k in range(21))  # per period, classical Runge-Kutta
ADAMS_LEAST = 1e-9  # tolerance below which Adams' method is never the cheaper one
REFERENCE = Accuracy(name="reference of the calibration", resolution=300.0, tolerance=1e-13)
DENSE, EXACT = 140.0, 1e-12  # resolution or tolerance while the other one is varied
SHARE = 0.7  # of the target, allowed for the worst case: other laws and scenes may be worse than the cases
PART_OF_SPACE = 0.25  # of `SHARE`, allowed for the points along the body
CHECKED = 0.85  # of the target, allowed for the worst case with points and steps combined
FITTED = 0.7  # of the target, allowed for the gaits and most of the many laws that the settings are fitted to
MANY = range(6, 66)  # seeds of these laws
LONG = ("falling", "kern_fast"), 60.0  # gaits among the many laws, and their duration [s]: the most sensitive to it
WAIVED = 0.05  # fraction of the laws that may exceed it, up to the target
WAIVED_FREE = 3  # laws that may miss the target where nothing damps the motion in space: `simulate` verifies such runs
FINEST_IN_SPACE = 1e-8  # finest target with drag: below it, laws differ too much
BESIDES = 22  # cost of an evaluation and its step without the nodes, in nodes of equal cost
COARSE = 1e-4  # At this target and above, points, steps and the kinks to locate are chosen together. Below it, their
# errors differ too much from law to law.
FINER_STEPS, MOST_STEPS = 3, 10  # tolerances tried at these targets: finer ones per method, and in all
# Cost of locating the drag's kinks, in nodes of equal cost: in space, and where the motion stays in a plane.
COST_OF_KINKS = {"none": 0, "jumps": 5, "all": 13}, {"none": 0, "jumps": 15, "all": 30}
# Least and greatest decadic logarithms for the random laws: of the factors on the curvature and the pace of
# `random_law`, and of the duration [s] before it is divided by the pace.
BENDS, PACES, SECONDS = (-0.7, 0.3), (-0.4, 0.4), (0.4, 1.2)
PRICED = 10  # laws on which the cost of settings is measured
TURNS = 15  # rounds of timing runs with and without the ledger


@dataclass(frozen=True, kw_only=True)
class Case:
    """One case to simulate: a law on a body in a scene, for `duration` [s]."""

    name: str
    law: Law
    body: Body
    scene: Scene
    duration: float = 4.0

    @property
    def plane(self) -> bool:
        """Whether the motion stays in a plane."""
        return self.law.in_plane

    def error_scale(self, torque: bool) -> float:
        """Scale that relative errors are divided by: of position, or with `torque` of position and torque."""
        difficulty = difficulty_of(self.law, self.body.length, self.duration)
        return difficulty.error_scale(self.scene.resistive, torque, self.plane)


def random_law(seed: int, length: float, planar: bool = False) -> Law:
    """A random law for a body of `length` [m]: per axis a wave and a constant bend, each with a random ramp.

    The axes are yaw and pitch, or yaw alone if `planar`.
    """
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
    return Law(*terms, name=f"random {seed}{' in the plane' if planar else ''}")


def cases(drag: bool = True, seeds=range(6), seconds: float | None = None) -> list[Case]:
    """Cases with or without `drag`: gaits and random laws, on both bodies, in the scenes that differ most.

    The gaits are the library's. seeds: of the random laws. seconds: duration of the gaits [s]; None: 10, or 4 without
    drag. Without drag, longer motions are too sensitive to represent others.
    """
    boyer, kern = Body.boyer2010(), Body.kern2006()
    names = ("falling", "straight", "turning", "rolling", "helix", "kern_fast", "backward")
    seconds = seconds or (10.0 if drag else 4.0)
    swimming = [(name, gait(name), boyer if "kern" not in name else kern, seconds) for name in names]
    swimming += [_of_seed(seed, drag) for seed in seeds]
    scenes = {"laminar": Scene(friction="laminar", ledger=False), "printed": Scene(ledger=False)}
    if not drag:
        scenes = {"no drag": Scene(resistive=False, ledger=False)}
    found = [
        Case(name=f"{name}, {scene}", law=law, body=body, scene=scenes[scene], duration=duration)
        for name, law, body, duration in swimming
        for scene in scenes
    ]
    flat = [
        Case(
            name=f"straight, planar, {name}",
            law=gait("straight"),
            body=boyer,
            scene=replace(scene, planar=True),
            duration=seconds,
        )
        for name, scene in scenes.items()
    ]
    return found + flat


def _long() -> list[Case]:
    """Cases of the gaits in `LONG`, of long duration."""
    names, seconds = LONG
    some = [case for case in cases(True, (), seconds) if case.name.split(",")[0] in names]
    return [replace(case, name=f"{case.name}, {seconds:g} s") for case in some]


def _of_seed(seed: int, drag: bool) -> tuple[str, Law, Body, float]:
    """Name, random law, body and duration [s] of a seed. Every third law is planar."""
    rng = np.random.default_rng(1000 + seed)
    bends, pace, seconds = 10.0 ** rng.uniform(*BENDS), 10.0 ** rng.uniform(*PACES), 10.0 ** rng.uniform(*SECONDS)
    law = varied(random_law(seed, 1.0, planar=seed % 3 == 2), bends, pace)
    return law.name, law, (Body.boyer2010(), Body.kern2006())[seed % 2], (seconds if drag else 4.0) / pace


def varied(law: Law, bends: float, pace: float) -> Law:
    """`law` with its curvature multiplied by `bends` and its pace by `pace`."""
    terms = [
        replace(
            term,
            amplitude=tuple(bends * value for value in term.amplitude),
            period=term.period / pace,
            envelope=tuple(replace(ramp, start=ramp.start / pace, end=ramp.end / pace) for ramp in term.envelope),
        )
        for term in law.terms
    ]
    return Law(*terms, name=law.name)


def swim(case: Case, accuracy) -> Run:
    """Simulate a case for the measurement of errors: samples every 0.05 s, 31 stations.

    `SimulationStopped` where the run cannot go on.
    """
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


def calibrate(path: Path | str | None = None, say: Callable = lambda text: None) -> list[dict]:
    """Measure the table of targets again and write it to `path` (None: the library's own table). Returns its rows.

    say(text): called with a line of progress. `OSError` where the file cannot be written.
    """
    rows, ledger = [], ledger_of_a_step()
    say(f"the ledger of a step costs {ledger:.2f} evaluations")
    with ThreadPoolExecutor(os.cpu_count()) as pool:  # the loops release Python's lock
        for drag in (True, False):
            found = list(pool.map(lambda case: _measure(case, say), cases(drag)))
            many = cases(drag, MANY) + (_long() if drag else [])
            say(f"{len(many)} runs to compare with")
            many = list(zip(many, pool.map(lambda case: swim(case, REFERENCE), many), strict=True))
            for key in sorted({_key(each.case) for each in found}, reverse=True):
                for torque in (True, False):
                    some = [measured for measured in found if _key(measured.case) == key]
                    same = [each for each in many if _key(each[0]) == key]
                    fitting, price = _fitting(same, torque, pool), _price(same, torque, ledger, pool)
                    for row in _rows(some, torque, ledger if torque else 0.0, fitting, price):
                        kind = {"drag": int(drag), "turbulent": key[0], "torque": int(torque), "plane": key[1]}
                        rows.append(kind | row)
                        say(f"{rows[-1]}")
    with replacing(TABLE_FILE if path is None else path) as draft, draft.open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        writer.writerows(rows)
    return rows


def _key(case: Case) -> tuple[int, int]:
    """(turbulent friction, motion in a plane), each 1 or 0. Each key has rows of its own."""
    return int(case.scene.resistive and case.scene.friction in TURBULENT), int(case.plane)


def _fitting(many: list[tuple[Case, Run]], torque: bool, pool: ThreadPoolExecutor) -> Fitting:
    """The `Fitting` to `many` cases, each with its reference run."""

    def error(swimmer: tuple[Case, Run], setting: Accuracy) -> float:
        case, reference = swimmer
        found = _of(case if torque else _without_torque(case), reference, setting)
        return max(found[: 2 if torque else 1]) / case.error_scale(torque)

    grids = tuple(dict.fromkeys(_filled(each, torque) for each in RESOLUTIONS))
    free = not (many[0][0].scene.resistive or many[0][0].plane)
    gaits = {case.name for drag in (True, False) for case in cases(drag, ())}
    return Fitting(
        list(many),
        error,
        grids,
        pool,
        waived=WAIVED_FREE if free else int(WAIVED * len(many)),
        at_most=np.inf if free else 1.0 / FITTED,
        may_miss=lambda swimmer: swimmer[0].name not in gaits,
    )


def ledger_of_a_step(turns: int = TURNS) -> float:
    """Cost of the energy ledger per step, in evaluations of the head's dynamics.

    Measured from the CPU times of the same run with and without the ledger, as the median of `turns` rounds.
    """
    accuracy = Accuracy(name="timed", resolution=22.0, tolerance=1e-6)
    swimmers = [
        Simulation(scene=Scene(ledger=ledger), accuracy=accuracy, stations=2, law=falling()) for ledger in (False, True)
    ]
    costs = []
    for turn in range(turns + 1):
        seconds = []
        for swimmer in swimmers:
            swimmer.reset()
            start = time.thread_time()
            swimmer.advance(10.0)
            seconds.append(time.thread_time() - start)
        steps, _, evaluations = swimmers[0].evaluations
        if turn:
            costs.append((seconds[1] - seconds[0]) / steps / (seconds[0] / evaluations))
    return statistics.median(costs)


@dataclass(frozen=True)
class MeasuredErrors:
    """Errors of position and torque of one case; for the steps in time also their cost."""

    case: Case
    reference: Run
    space: np.ndarray  # (kinds of kinks, resolutions, 2)
    alone: np.ndarray  # (kinds of kinks, resolutions, 1): position, on the coarser grids of runs without torque
    time: np.ndarray  # (methods, tolerances, 4): errors of position and torque, evaluations, steps


def _measure(case: Case, say) -> MeasuredErrors:
    reference = swim(case, REFERENCE)
    setting = Accuracy(name="calibration", resolution=DENSE, tolerance=EXACT)
    space = _in_space(case, reference, setting, 2)
    alone = _in_space(_without_torque(case), reference, setting, 1)
    time = [
        [
            _of(case, reference, replace(setting, tolerance=tolerance, method=method, order=order))
            if (tolerance >= ADAMS_LEAST if method == "adams" else tolerance <= LOOSEST_TOLERANCE)
            else (np.inf,) * 4
            for tolerance in TOLERANCES
        ]
        for method, order in METHODS
    ]
    say(f"{case.name}: measured")
    return MeasuredErrors(case, reference, space, alone, np.array(time))


def _in_space(case: Case, reference: Run, setting: Accuracy, counted: int) -> np.ndarray:
    """Errors (kinds of kinks, resolutions, `counted`) of position and torque, against the points along the body."""
    found = [
        [
            _of(case, reference, replace(setting, resolution=resolution, kinks=kinks))[:counted]
            for resolution in RESOLUTIONS
        ]
        for kinks in KINKS
    ]
    return np.array(found)


def _of(case: Case, reference: Run, accuracy: Accuracy) -> tuple[float, float, float, float]:
    try:
        run = swim(case, accuracy)
    except SimulationStopped:
        return (np.inf,) * 4
    found = relative_errors(run, run if reference is None else reference)
    return found.position, found.torque, run.evaluations, run.steps


def _without_torque(case: Case) -> Case:
    return replace(case, scene=replace(case.scene, internal_wrench=False))


def _rows(found: list[MeasuredErrors], torque: bool, ledger: float, fitting: Fitting, price: Callable):
    """Yield the rows of a table. ledger: cost of the ledger per step, in evaluations."""
    counted = slice(0, 2 if torque else 1)
    by = [each.case.error_scale(torque) for each in found]
    space = np.max(
        [(each.space if torque else each.alone) / hard for each, hard in zip(found, by, strict=True)], axis=(0, 3)
    )
    time = np.max([each.time[..., counted] / hard for each, hard in zip(found, by, strict=True)], axis=(0, 3))
    cost = np.mean([each.time[..., 2] + ledger * each.time[..., 3] for each in found], axis=0)
    if torque:  # the ledger integrates works over steps: with Adams' longest steps they are off by some hundredths
        cost[[method == "adams" for method, _ in METHODS]] = np.inf
    numbers = FIXED_STEPS
    for target in TARGETS:
        for_space, for_time = PART_OF_SPACE * SHARE * target, (1.0 - PART_OF_SPACE) * SHARE * target
        coarse = target >= COARSE
        kinds = KINKS if coarse else KINKS[:1]
        grids = _grids(space[: len(kinds)], kinds, for_space, torque)
        steps = _steps(time, cost, SHARE * target, FINER_STEPS) if coarse else _steps(time, cost, for_time)[:1]
        settings = [
            replace(step, resolution=resolution, kinks=kinks)
            for step in steps[:MOST_STEPS]
            for resolution, kinks in grids
        ]
        resistive = found[0].case.scene.resistive
        if not settings or target < (FINEST_IN_SPACE if resistive and not found[0].case.plane else FINEST):
            continue
        setting = _cheapest(found, torque, (SHARE if coarse else CHECKED) * target, ledger, settings)
        setting = fitting.fitted(setting, FITTED * target)
        if setting is not None:
            setting = fitting.cheapest(setting, FITTED * target, price, METHODS[-1:] if torque else METHODS)
            row = {name: getattr(setting, name) for name in ("resolution", *CHOSEN)}
            number = fitting.fewest(setting, numbers, FITTED * target)
            numbers = tuple(each for each in numbers if number is None or each >= number)
            yield {"target": target} | row | {"fixed": number or ""}


def _steps(time: np.ndarray, cost: np.ndarray, allowed: float, finer: int = 0) -> list[Accuracy]:
    """Methods and tolerances whose errors stay at or below `allowed`, the cheapest first.

    Each method contributes its loosest tolerance and the next `finer` ones.
    """
    choices = []
    for (method, order), worst, costs in zip(METHODS, time, cost, strict=True):
        good = _first(worst, allowed)
        for each in () if good is None else range(good, min(good + finer + 1, len(costs))):
            if np.isfinite(costs[each]):
                choices.append((costs[each], method, order, float(f"{TOLERANCES[each]:.2e}")))
    return [
        Accuracy(name="calibration", method=method, order=order, tolerance=tolerance, **ANY)
        for _, method, order, tolerance in sorted(choices)
    ]


def _grids(space: np.ndarray, kinds, allowed: float, torque: bool) -> list[tuple[float, str]]:
    """Coarsest resolutions whose errors stay at or below `allowed`, one for each kind of kinks that are located."""
    points = [_first(worst, allowed) for worst in space]
    found = zip(points, kinds, strict=True)
    return [(_filled(RESOLUTIONS[point], torque), kinks) for point, kinks in found if point is not None]


def _nodes(resolution: float, torque: bool) -> int:
    """Number of nodes of the paper's robot."""
    return sum(panel.points for panel in panels_of(Body.boyer2010(), resolution, (), torque))


def _filled(resolution: float, torque: bool) -> float:
    """The finest resolution with no more nodes on the paper's robot: a margin for laws of more waves."""
    most = _nodes(resolution, torque)
    return max(each for each in (resolution, *RESOLUTIONS) if _nodes(each, torque) <= most)


def _price(many: list[tuple[Case, Run]], torque: bool, ledger: float, pool: ThreadPoolExecutor) -> Callable:
    """A function: cost of a setting over some of the `many` cases.

    The cost is the number of evaluations, those for the ledger included, times the cost of one, in nodes.
    """
    some = [case if torque else _without_torque(case) for case, _ in many[:: max(1, len(many) // PRICED)]]
    plane = some[0].plane

    def price(setting: Accuracy) -> float:
        runs = list(pool.map(lambda case: _of(case, None, setting), some))
        nodes = BESIDES + _nodes(setting.resolution, torque) + COST_OF_KINKS[plane][setting.kinks]
        return nodes * sum(evaluations + (ledger if torque else 0.0) * steps for *_, evaluations, steps in runs)

    return price


def _swum(found: list[MeasuredErrors], torque: bool, setting: Accuracy, ledger: float) -> tuple[float, float]:
    """Greatest error of all cases with a `setting`, and the mean cost in evaluations."""
    lean = [each.case if torque else _without_torque(each.case) for each in found]
    swum = [_of(case, each.reference, setting) for case, each in zip(lean, found, strict=True)]
    counted = 2 if torque else 1
    worst = max(max(each[:counted]) / case.error_scale(torque) for each, case in zip(swum, lean, strict=True))
    return worst, float(np.mean([evaluations + ledger * steps for *_, evaluations, steps in swum]))


def _cheapest(
    found: list[MeasuredErrors], torque: bool, allowed: float, ledger: float, settings: list[Accuracy]
) -> Accuracy:
    """The cheapest of the `settings` whose errors stay at or below `allowed` in all cases.

    Where there is none: the last setting, with all kinks located.
    """
    good = []
    for setting in settings:
        worst, evaluations = _swum(found, torque, setting, ledger)
        if worst <= allowed:
            cost = BESIDES + _nodes(setting.resolution, torque) + COST_OF_KINKS[found[0].case.plane][setting.kinks]
            good.append((evaluations * cost, len(good), setting))
    return min(good)[-1] if good else replace(settings[-1], kinks="all")


def _first(errors, allowed: float) -> int | None:
    """Index of the first setting from which on all `errors` are at or below `allowed`; None where the finest is above.

    errors: from the coarsest setting to the finest; inf at one end where not measured. A single small error among
    greater ones does not count.
    """
    finite = np.where(np.isfinite(errors), errors, 0.0)
    worst = np.where(np.isfinite(errors), np.maximum.accumulate(finite[::-1])[::-1], np.inf)
    good = np.flatnonzero(worst <= allowed)
    return int(good[0]) if len(good) else None
