# SPDX-License-Identifier: Apache-2.0
"""Simulates a grid of parameters: `sweep`, with labelled results.

    data = sweep({"period": np.linspace(0.5, 2.0, 16), "scene.friction": ["laminar", "printed"]}, gait="straight",
                 duration=10.0, accuracy=1e-3, out="periods.nc")
    data.mean_speed.sel({"scene.friction": "laminar"})       # an xarray of 16 speeds, with their periods

It runs in threads, one per core, or on a Dask scheduler. Finished points are stored beside the output, so an
interrupted sweep resumes when it is called again. It needs `pip install './src/eel_dynamics[data]'`; with a scheduler
also `'./src/eel_studies[cluster]'`.
"""

import itertools
import math
from collections.abc import Sized
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.command.progress import progress_of
from eel_common.quantity import checked_instance
from eel_common.wording import WorkStopped, one_line, shown
from eel_dynamics.analysis.measures import checked_measures, described
from eel_dynamics.analysis.settling import tell_unsettled
from eel_dynamics.batches.simulate_batch import available_cores
from eel_dynamics.model.axes import REP103
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.sampling import checked_times, default_sample_period
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED, period_of, until_settled
from eel_dynamics.runs.storage.tables import needed
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

from eel_studies.points import (
    AccuracyLike,
    Gait,
    Measure,
    Numbers,
    Progress,
    Stations,
    base_of,
    label_of,
    measured,
    point_at,
    run_of_point,
)
from eel_studies.sweeps.sweep_key import key_of
from eel_studies.sweeps.sweep_parts import Parts, Results, checked_point
from eel_studies.sweeps.sweep_recordings import SweepRecordings
from eel_studies.workers import workers_of

LONGEST_CHUNK = 64  # points
MOST_POINTS = 1_000_000  # of a grid, which is built before the first run


class PointsMissing(WorkStopped):
    """Points of a sweep could not be computed; the others are kept."""

    exit_status = 4


def sweep(
    grid: Numbers,
    *,
    gait: Gait = "straight",
    numbers: Numbers | None = None,
    duration: float | str | None = None,
    body: Body | None = None,
    scene: Scene | None = None,
    robot: Robot | str | None = None,
    accuracy: AccuracyLike | None = None,
    sample_period: float | None = None,
    stations: Stations | None = None,
    estimate: bool | None = None,
    measure: Measure | tuple[str, ...] | None = None,
    out: str | Path | None = None,
    scheduler: Any = None,
    workers: int | None = None,
    chunk: int | None = None,
    progress: Progress = None,
    overwrite: bool = False,
    recordings: str | Path | None = None,
    most_evaluations: float | None = None,
) -> Any:
    """Simulate every combination of the values in `grid`.

    Returns an `xarray.Dataset` over the parameters of the grid. For a point that stops, the measures are NaN, `stopped`
    is true, and `error` is its message. An `Unsettled` warning counts the points that have not settled.

    Args:
        grid: values by name, with the names of `studies.points`: numbers of the gait ("period"), of scene, body or
            initial state ("scene.friction", "body.lateral_drag", "initial.v_x"), of flow and fins ("fins.area",
            "fins.k_p"), of a robot ("robot.kp", "robot.tails.bending_stiffness", "robot.joint_3.stiffness"), "robot",
            "body" and "accuracy".
        gait: its name, a function of `numbers` and the grid's that returns a law, or a whole `Swim`, as from
            `load_scene`, whose settings are the defaults.
        numbers: for all points, by the same names, such as those of the gait, or "fins".
        duration: [s], or "settled" (the default without a `Swim`): until the gait has settled, as in `simulate`.
        body, scene, robot, accuracy: as in `simulate`, for all points; a robot may be a name or a file.
        sample_period: [s], as in `simulate`.
        stations: as in `simulate`.
        estimate: estimate each run's error, as in `simulate`.
        measure: names of `analysis.measures.MEASURES` (None: all), to which "settled" is added, or a function
            run -> {name: number}.
        out: .nc file for the result; its parts are stored in `out`.parts until it is complete.
        scheduler: None for `workers` threads; "processes" for as many processes on this machine; the address of a Dask
            scheduler, a client or a cluster. With "processes", a script must call `sweep` below
            `if __name__ == "__main__":`.
        workers: threads, or processes; None: one per core.
        chunk: points per task.
        progress: progress(done, points) is called after each chunk; True: a bar; None: a bar on a terminal.
        overwrite: replace another sweep in `out` and its parts.
        recordings: folder, created if missing, for a Rerun recording of each point: 000000.rrd ..., with the values of
            the grid as the properties `numbers`, its figures as others, and without the water's forces.
        most_evaluations: per point, as in `simulate`.

    `ValueError` names an invalid point or measure. `ImportError`: a package is missing. `OSError`: the output cannot be
    completed. `PointsMissing`: points could not be computed; the others are kept.
    """
    xarray = needed("xarray", "a sweep")
    names, axes = _checked_grid(grid)
    if duration is None and not isinstance(gait, Swim):
        duration = UNTIL_SETTLED
    base = base_of(
        gait,
        body=body,
        scene=scene,
        robot=robot,
        accuracy=accuracy,
        duration=duration,
        sample_period=sample_period,
        stations=stations,
        estimate=estimate,
        most_evaluations=most_evaluations,
    )
    duration, sample_period = base.duration, base.sample_period
    if not until_settled(duration):
        checked_times(duration, default_sample_period([], duration) if sample_period is None else sample_period)
    if not callable(measure):
        measure = tuple(dict.fromkeys([*checked_measures("measure", measure, base.estimate), "settled"]))
    _check_count("workers", workers)
    _check_count("chunk", chunk)
    try:
        points = [
            point_at(dict(zip(names, values, strict=True)), gait, numbers or {}, base).unchecked(gait=None)
            for values in itertools.product(*axes)
        ]
        for point in points if until_settled(duration) else ():
            period_of(point.law, point.body.length)
    except ValueError as error:
        raise ValueError(f"sweep {error}") from None
    record = None if recordings is None else SweepRecordings(recordings, dict(zip(names, axes, strict=True)))
    key = "" if out is None else key_of(points, measure)
    parts = Parts(out, key, len(points), overwrite)
    complete = parts.complete()
    if complete is not None:
        return _warned(complete)
    done = parts.load()
    left = [(index, point) for index, point in enumerate(points) if index not in done]
    tell = progress_of(progress)
    tell(len(done), len(points))
    failures = []
    if left:
        with workers_of(scheduler, workers or available_cores()) as found:
            size = chunk or min(LONGEST_CHUNK, max(1, math.ceil(len(left) / (8 * max(1, found.parallel)))))
            chunks = [left[start : start + size] for start in range(0, len(left), size)]
            task = partial(swim_points, measure=measure, record=record)
            for swum, result, failure in found.results(task, chunks):
                if result is None:
                    failures.append((swum[0][0], failure))
                    continue
                result = {index: checked_point(point) for index, point in result.items()}
                parts.keep(result)
                done |= result
                tell(len(done), len(points))
    if failures:
        raise PointsMissing(
            f"{len(points) - len(done)} of {len(points)} points could not be computed, the first at {failures[0][0]}: "
            f"{one_line(repr(failures[0][1]))}; "
            + (f"the others are kept in {parts.folder}" if out else "nothing was kept")
        )
    data = _dataset(xarray, names, axes, points, done, gait)
    if key:
        data.attrs["sweep"] = key
    parts.finish(data)
    return _warned(data)


def _warned(data: Any) -> Any:
    """Return `data`, with an `Unsettled` warning that counts the points that have not settled."""
    if "settled" in data:
        tell_unsettled(data.settled, "points", stacklevel=4)
    return data


def swim_points(
    points: list[tuple[int, Swim]], measure: Measure | tuple[str, ...], record: SweepRecordings | None = None
) -> Results:
    """A worker's task: simulate the points, given with their indices, measure and `record` each.

    Returns the measures of each point by its index, with "error": the message of a stopped point, else empty.
    """
    result = {}
    for index, point in points:
        try:
            run = run_of_point(point)
        except SimulationStopped as stopped:
            result[index] = {"error": str(stopped)}
            continue
        result[index] = {"error": ""} | measured(run, measure)
        if record is not None:
            record.record(index, run)
    return result


def _checked_grid(grid: Any) -> tuple[list[str], list[list[Any]]]:
    if not isinstance(grid, dict) or not grid:
        raise ValueError(f"grid must be a dict of parameters and their values, got {shown(grid)}")
    axes = []
    for name, values in grid.items():
        checked_instance("grid name", name, str)
        if isinstance(values, (str, bytes)) or not np.iterable(values):
            raise ValueError(f"grid {shown(name)} must have a sequence of values, got {shown(values)}")
        if isinstance(values, Sized):
            check_points(f"grid {shown(name)}", len(values))
        values = [value.item() if isinstance(value, np.generic) else value for value in values]
        labels = [label_of(value) for value in values]
        if not values or len(set(labels)) < len(labels):
            raise ValueError(f"grid {shown(name)} must have one value or more, none twice, got {shown(labels)}")
        axes.append(values)
    check_points("grid", math.prod(len(values) for values in axes))
    return list(grid), axes


def _check_count(name: str, value: Any) -> None:
    """`ValueError` unless `value` is a whole number >= 1, or None."""
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        raise ValueError(f"{name} must be a whole number >= 1, got {shown(value)}")


def check_points(name: str, count: int) -> None:
    """`ValueError` for more points than a grid may have."""
    if count > MOST_POINTS:
        raise ValueError(f"{name} must have at most {MOST_POINTS} points, got {count}")


def _dataset(
    xarray: Any,
    names: list[str],
    axes: list[list[Any]],
    points: list[Swim],
    done: Results,
    gait: Gait,
) -> Any:
    shape, first = [len(values) for values in axes], points[0]
    measured = list(dict.fromkeys(name for index in sorted(done) for name in done[index] if name != "error"))
    found = [done[index] for index in range(len(points))]
    variables = {
        name: (names, np.reshape([point.get(name, np.nan) for point in found], shape), described(name))
        for name in measured
    }
    errors = [point["error"] for point in found]
    variables["stopped"] = names, np.reshape([bool(error) for error in errors], shape), {"long_name": "did not end"}
    variables["error"] = names, np.reshape(np.array(errors, dtype=object), shape), {"long_name": "what stopped it"}
    coordinates = {name: [label_of(value) for value in values] for name, values in zip(names, axes, strict=True)}
    attributes = {
        "gait": gait
        if isinstance(gait, str)
        else getattr(gait, "__name__", None) or getattr(first.law, "name", shown(first.law)),
        "duration": first.duration if until_settled(first.duration) else float(first.duration),
        "estimate": int(first.estimate),
        "axes": REP103,
    }
    if first.sample_period is not None:
        attributes["sample_period"] = float(first.sample_period)
    for name in ("body", "scene", "robot", "accuracy"):
        values = {repr(getattr(point, name)) for point in points}
        if len(values) == 1:
            attributes[name] = values.pop()
    return xarray.Dataset(variables, coordinates, attributes)
