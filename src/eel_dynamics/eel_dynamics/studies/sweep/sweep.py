"""Simulates a grid of parameters on many processes: `sweep`, with labelled results.

    data = sweep({"period": np.linspace(0.5, 2.0, 16), "scene.friction": ["laminar", "printed"]}, gait="straight",
                 duration=10.0, accuracy=1e-3, out="periods.nc")
    data.cruising_speed.sel({"scene.friction": "laminar"})       # an xarray of 16 speeds, with their periods

It runs on the cores of this machine, or on any Dask scheduler. Finished points are stored beside the output: an
interrupted sweep resumes when it is called again. It needs `pip install 'eel_dynamics[cluster]'`. In a script, call it
below `if __name__ == "__main__":`, since the workers import the script.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np
from eel_gaits.law import Law
from eel_gaits.registry import find
from eel_gaits.wording import one_line, shown

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.arguments import checked_number
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.batch import simulate_batch
from eel_dynamics.runs.run import checked_times
from eel_dynamics.simulation.step_bounds import MOST_EVALUATIONS
from eel_dynamics.studies.sweep.cluster import connected, needed, spread
from eel_dynamics.studies.sweep.measures import checked_point, described, measures_of
from eel_dynamics.studies.sweep.sweep_key import key_of
from eel_dynamics.studies.sweep.sweep_parts import Parts

LONGEST_CHUNK = 64  # points
MOST_POINTS = 1_000_000  # of a grid, which is built as a whole before the first run


class Point(NamedTuple):
    """One run of the grid."""

    index: int  # in the flattened grid; the last parameter varies fastest
    law: Law
    body: Body
    scene: Scene
    accuracy: Accuracy


def sweep(
    grid: dict,
    *,
    gait: "str | Callable[..., Law]" = "straight",
    numbers: dict | None = None,
    duration: float = 10.0,
    body: Body | None = None,
    scene: Scene | None = None,
    accuracy="standard",
    sample_period: float = 0.05,
    stations=51,
    measure: Callable = measures_of,
    out=None,
    scheduler=None,
    workers: int | None = None,
    chunk: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    overwrite: bool = False,
    most_evaluations: float = MOST_EVALUATIONS,
):
    """Simulate every combination of the values in `grid` and return an `xarray.Dataset` over its parameters.

    grid: name: values. A name is a number of the gait ("period"), "scene." and a field of `Scene`, "body" (`Body`s or
    names of the library), or "accuracy". gait: its name, or a function of `numbers` and the grid's that returns a law.
    numbers: of the gait, the same for all points. duration [s], body, scene, accuracy, sample_period [s], stations,
    most_evaluations: as in `simulate`. measure: run -> {name: number}; by default those of `measures`, over the later
    half of the run. out: .nc file for the result; its parts are stored in `out`.parts until it is complete. scheduler:
    address of a Dask scheduler, client or cluster; None: `workers` processes on this machine. chunk: points per task.
    progress(done, points): called after each chunk. overwrite: replace another sweep in `out` and its parts. A point
    that stops has NaN for its measures, `stopped` is true, and `error` is its message.

    `ValueError` names the point or the measure that is invalid. `ImportError`: a package is missing. `OSError`: the
    output cannot be written to its end. `RuntimeError`: points could not be computed; the others are kept.
    """
    xarray = needed()["xarray"]
    names, axes = _checked_grid(grid)
    checked_times(duration, sample_period)
    limit = checked_number("most_evaluations", most_evaluations, "per simulated second")
    _check_count("workers", workers)
    _check_count("chunk", chunk)
    base = Point(
        -1,
        None,
        Body.boyer2010() if body is None else body,
        Scene() if scene is None else scene,
        Accuracy.of(accuracy),
    )
    points = [
        _point(index, dict(zip(names, values, strict=True)), gait, numbers or {}, base)
        for index, values in enumerate(itertools.product(*axes))
    ]
    key = key_of(points, duration, sample_period, stations, measure, limit)
    parts = Parts(out, key, len(points), overwrite)
    complete = parts.complete()
    if complete is not None:
        return complete
    done = parts.load()
    left = [point for point in points if point.index not in done]
    if progress is not None:
        progress(len(done), len(points))
    failures = []
    if left:
        with connected(scheduler, workers) as client:
            size = chunk or min(LONGEST_CHUNK, max(1, math.ceil(len(left) / (8 * max(1, _threads_of(client))))))
            chunks = [left[start : start + size] for start in range(0, len(left), size)]
            how = duration, sample_period, stations, measure, limit
            for swum, result, error in spread(client, swim_points, chunks, *how):
                if error is not None:
                    failures.append((swum[0].index, error))
                    continue
                result = {index: checked_point(point) for index, point in result.items()}
                parts.keep(result)
                done |= result
                if progress is not None:
                    progress(len(done), len(points))
    if failures:
        raise RuntimeError(
            f"{len(points) - len(done)} of {len(points)} points could not be computed, the first at {failures[0][0]}: "
            f"{one_line(repr(failures[0][1]))}; "
            + (f"the others are kept in {parts.folder}" if out else "nothing was kept")
        )
    data = _dataset(xarray, names, axes, points, done, key, duration, sample_period, gait)
    parts.finish(data)
    return data


def swim_points(points: list[Point], duration, sample_period, stations, measure, most_evaluations) -> dict[int, dict]:
    """The task of a worker: simulate the points and measure each.

    Returns the measures of each point by its index, with "error": the message of a point that stopped, else empty.
    """
    batch = simulate_batch(
        [point.law for point in points],
        duration,
        bodies=[point.body for point in points],
        scenes=[point.scene for point in points],
        accuracy=[point.accuracy for point in points],
        sample_period=sample_period,
        stations=stations,
        threads=1,
        most_evaluations=most_evaluations,
    )
    result = {}
    for place, point in enumerate(points):
        error = batch.error[place]
        result[point.index] = {"error": "", **measure(batch[place])} if error is None else {"error": str(error)}
    return result


def _threads_of(client) -> int:
    return sum(client.nthreads().values())


def _checked_grid(grid) -> tuple[list[str], list[list]]:
    if not isinstance(grid, dict) or not grid:
        raise ValueError(f"grid must be a dict of parameters and their values, got {shown(grid)}")
    axes = []
    for name, values in grid.items():
        if isinstance(values, (str, bytes)) or not np.iterable(values):
            raise ValueError(f"grid {shown(name)} must have a sequence of values, got {shown(values)}")
        if hasattr(values, "__len__"):
            check_points(f"grid {shown(name)}", len(values))
        values = [value.item() if isinstance(value, np.generic) else value for value in values]
        labels = [_label(value) for value in values]
        if not values or len(set(labels)) < len(labels):
            raise ValueError(f"grid {shown(name)} must have one value or more, none twice, got {shown(labels)}")
        axes.append(values)
    check_points("grid", math.prod(len(values) for values in axes))
    return list(grid), axes


def _check_count(name: str, value):
    """`ValueError` unless `value` is a whole number >= 1, or None."""
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        raise ValueError(f"{name} must be a whole number >= 1, got {shown(value)}")


def check_points(name: str, count: int):
    """`ValueError` for more points than a grid can have."""
    if count > MOST_POINTS:
        raise ValueError(f"{name} must have at most {MOST_POINTS} points, got {count}")


def _label(value):
    """The label of a value on its axis."""
    if isinstance(value, (Body, Accuracy)):
        return value.name
    return value if isinstance(value, (bool, int, float, str)) else str(value)


def _point(index: int, values: dict, gait, numbers: dict, base: Point) -> Point:
    at = ", ".join(
        f"{name}={value.name if isinstance(value, (Body, Accuracy)) else shown(value)}"
        for name, value in values.items()
    )
    try:
        body, scene, accuracy, own = base.body, {}, base.accuracy, dict(numbers)
        for name, value in values.items():
            if name == "body":
                body = Body.named(value) if isinstance(value, str) else value
            elif name == "accuracy":
                accuracy = Accuracy.of(value)
            elif name.startswith("scene."):
                scene[name.removeprefix("scene.")] = value
            else:
                own[name] = value
        known = [item.name for item in fields(Scene)]
        for name in scene:
            if name not in known:
                raise ValueError(f"scene has no field {shown(name)}, it has: {', '.join(known)}")
        law = (find(gait) if isinstance(gait, str) else gait)(**own)
        return Point(index, law, body, replace(base.scene, **scene), accuracy)
    except (ValueError, TypeError) as error:
        raise ValueError(f"sweep at {at}: {error}") from None


def _dataset(xarray, names, axes, points, done, key, duration, sample_period, gait):
    shape = [len(values) for values in axes]
    measured = list(dict.fromkeys(name for index in sorted(done) for name in done[index] if name != "error"))
    variables = {
        name: (names, np.reshape([done[point.index].get(name, np.nan) for point in points], shape), described(name))
        for name in measured
    }
    errors = [done[point.index]["error"] for point in points]
    variables["stopped"] = names, np.reshape([bool(error) for error in errors], shape), {"long_name": "did not end"}
    variables["error"] = names, np.reshape(np.array(errors, dtype=object), shape), {"long_name": "what stopped it"}
    coordinates = {name: [_label(value) for value in values] for name, values in zip(names, axes, strict=True)}
    attributes = {
        "gait": gait if isinstance(gait, str) else getattr(gait, "__name__", "law"),
        "duration": float(duration),
        "sample_period": float(sample_period),
        "sweep": key,
    }
    for name in ("body", "scene", "accuracy"):
        values = {repr(getattr(point, name)) for point in points}
        if len(values) == 1:
            attributes[name] = values.pop()
    return xarray.Dataset(variables, coordinates, attributes)
