# SPDX-License-Identifier: Apache-2.0
"""Measurements from a file: a path or steady speeds in a table, a saved run, or a bag.

    time, x, y, perhaps z      a path: a row for each instant, [s, m]
    time, joint_1, ...         angles of a robot's joints by their names: a row for each instant, [s, rad]
    speed, other columns       steady speeds: a row for each swim, [m/s]; other columns are numbers of it, as period

Tables are text with a header, or .npz archives of columns. A run (.nc) or a bag gives the path of a point of the
backbone, or the joint angles; and the law and the body. A run also gives the scene and the robot.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from eel_common.attitude import heading
from eel_common.files.input_file import reading
from eel_common.files.table import Table
from eel_common.files.tables import is_table, read_table
from eel_common.files.times import time_of
from eel_common.wording import shown
from eel_gaits.sources.frames import check_rising

from eel_dynamics import Body, Robot, Run, Scene
from eel_gaits import Law
from eel_studies.identification.measurements import MeasuredAngles, MeasuredPath, MeasuredSpeed
from eel_studies.points import VELOCITIES

LEVEL = 1e-6  # rad, about: a head whose quaternion has a smaller x and y is level
NEAR = 1e-6  # part of the body's length: tolerance for the requested station of a run


class MeasuredFile(NamedTuple):
    """The measurements in a file, and its information on the swim."""

    measured: list[Any]  # MeasuredPath, MeasuredAngles or MeasuredSpeed
    law: Law | None = None
    body: Body | None = None
    scene: Scene | None = None  # with motion only
    robot: Robot | None = None


def read_measured(
    path: str,
    *,
    station: float = 0.0,
    namespace: str | None = None,
    robot: Robot | None = None,
    angles: bool = False,
) -> MeasuredFile:
    """The content of the file or bag at `path`. station: [m], X of a path's point. namespace: of a bag's swimmer.

    robot: the robot that swims. angles: read the angles of its joints, not a path.

    `ValueError` in one line names the file, and the line or column of a table, at fault.
    """
    if is_table(path, ".npz"):
        table = read_table(path)
        measured_there = [_angles_of_table(table, robot)] if angles else _of_table(table, station)
        table.tell()
        return MeasuredFile(measured_there)
    run = (
        Run.load(path) if Path(path).suffix == ".nc" else Run.from_bag(path, namespace, robot=robot if angles else None)
    )
    if not isinstance(run.law, Law) or not run.law.terms:
        raise ValueError(f"{shown(path)}: it holds no law of terms, whose swim could be simulated")
    if run.time[0] == 0.0 and np.abs(run.orientation[0, :2]).max() > LEVEL:
        raise ValueError(f"{shown(path)}: its head must be level at the start, got a lean that no parameter gives")
    turned = abs(heading(run.orientation[0])) > LEVEL
    if run.time[0] == 0.0 and turned and np.any(run.scene.current[:2]):
        raise ValueError(
            f"{shown(path)}: in a current its head must point along x at the start, "
            f"got a heading of {np.degrees(heading(run.orientation[0])):g} deg that no parameter gives"
        )
    twist = dict(zip(VELOCITIES, run.twist[0].tolist(), strict=True)) if run.time[0] == 0.0 else {}
    numbers = {f"initial.{name}": value for name, value in twist.items() if value}
    scene = replace(run.scene, internal_wrench=False, ledger=False) if Path(path).suffix == ".nc" else None
    measured: MeasuredAngles | MeasuredPath
    with reading(shown(path)):
        if not angles:
            measured = MeasuredPath(run.time, _tracked(run, station), station, numbers)
        elif run.joint_angle is None:
            raise ValueError("it holds no joints: --robot must be given with a bag, or --path")
        else:
            measured = MeasuredAngles(run.time, run.joint_angle, numbers)
    return MeasuredFile([measured], run.law, run.body, scene, run.robot)


def _angles_of_table(table: Table, robot: Robot | None) -> MeasuredAngles:
    if robot is None:
        raise ValueError("--robot must be given: its joints name the columns of angles")
    names = [joint.name for joint in robot.joints]
    if missing := [name for name in names if name not in table]:
        raise table.error(f"its columns must be time and the robot's joints, got none of {', '.join(missing)}")
    angles = np.concatenate([table.numbers(table.places(name), "rad") for name in names], axis=1)
    with reading(shown(str(table.path))):
        return MeasuredAngles(time_of(table), angles)


def _of_table(table: Table, station: float) -> list[Any]:
    if "x" in table and "y" in table:
        position = np.stack([table.column(name, "m") for name in ("x", "y", "z") if name in table], axis=1)
        time = time_of(table)
        check_rising(table, time, np.arange(len(time)))
        with reading(shown(str(table.path))):
            return [MeasuredPath(time, position, station)]
    if "speed" not in table:
        raise table.error(f"its columns must be time, x, y (a path), or speed, got {shown(table.head)}")
    speeds = table.column("speed", "m/s")
    if len(low := np.flatnonzero(speeds <= 0.0)):
        raise table.error(f"speed must be > 0 m/s, got {speeds[low[0]]:g}", low[0])
    others = {name: table.column(name) for name in table.head if table.places(name) != table.places("speed")}
    return [
        MeasuredSpeed(speed, {name: float(values[row]) for name, values in others.items()})
        for row, speed in enumerate(speeds.tolist())
    ]


def _tracked(run: Run, station: float) -> np.ndarray:
    """The path (T, 3) [m] of the run's point at the `station` [m]."""
    if run.backbone is None:
        if station != 0.0:
            raise ValueError(f"it holds no backbone, --station must be 0, got {station:g}")
        return run.position
    place = int(np.argmin(np.abs(run.x - station)))
    if abs(run.x[place] - station) > NEAR * run.body.length:
        nearest = f"the nearest are {', '.join(f'{x:g}' for x in run.x[max(place - 1, 0) : place + 2])} m"
        raise ValueError(f"--station must be one of its {len(run.x)} stations, {nearest}, got {station:g}")
    return run.backbone[:, place]
