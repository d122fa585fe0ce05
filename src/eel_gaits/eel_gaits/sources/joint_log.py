# SPDX-License-Identifier: Apache-2.0
"""Joint angles as robots log them, and the law of a chain of links whose joints lie where they lie.

A log is a .csv file with or without a header, perhaps with lines before it, in degrees or radians. Rows that do not fit
and readings that jump are left out, and told. The links are rigid, so all bending is at the joints. Joint j at X_j is
spread over a width w_j to either side, the mean distance to its neighbours, or less near an end:

    K(t, X) = sum_j phi_j(t) (1 + cos(pi (X - X_j) / w_j)) / (2 w_j),   |X - X_j| < w_j

So each angle is kept exactly, and at equal distances the angles add up smoothly. phi > 0 bends the tail to the right.
"""

import fnmatch
import itertools
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_base.files.input_file import reading
from eel_base.quantity import checked_row
from eel_base.wording import shown

from eel_gaits.sources.period import long_gap
from eel_gaits.sources.sampled_law import SampledLaw
from eel_gaits.sources.smoothing import smoothed_in_time
from eel_gaits.sources.tables import csv_rows

KNOWN = (  # names of columns of joints, the best first; a number in the name orders them
    r"yaw_(\d+)", r"(\d+)FbckPosition.*", r".*position[\[._/](\d+)\]?", r"pos(?:ition)?_?(\d+)",
    r"(?:joint|q)_?(\d+).*",
)  # fmt: skip
TIME = re.compile(r".*(?:time|stamp|_ts|^t$|^t[_\[]|^t \[).*", re.IGNORECASE)
PARTS = {"[us]": 1e-6, "[ms]": 1e-3, "[ns]": 1e-9}  # of a second, in a second column of time
DEGREES = re.compile(r".*(?:\[deg\]|_deg)$", re.IGNORECASE)
FEWEST_JOINTS, FEWEST_ROWS = 2, 16
SPREADS, FINEST = 6.0, 2e-3  # robust spreads beyond which a reading has jumped, and the least spread [rad]
PASSES = 3
LARGEST = 3.2  # rad, of a joint: beyond it the file is in degrees
BY_WIDTH = 8  # points of the law in a joint's width


class JointLog(NamedTuple):
    """Angles of n joints from head to tail at N instants."""

    name: str
    time: np.ndarray  # (N,) s, from 0
    angles: np.ndarray  # (N, n) rad
    joints: tuple[str, ...]  # their names
    notes: tuple[str, ...]  # what was done, in words


def read_joint_log(path: Path, *, columns: str = "", unit: str = "", tail_first: bool = False) -> JointLog:
    """The log in a .csv file. `ValueError` names the file and what does not fit.

    columns: which hold joints: numbers from 1 ("8-13"), names with commas between them, or a pattern ("*Fbck*"); "":
    those that look like it. unit: rad or deg; "": as the columns' names say, else rad.
    """
    with reading(shown(str(path))):
        head, rows, skipped = _rows(path)
        chosen = _joint_columns(head, columns)
        names = tuple(head[index] for index in chosen)
        time = _time(head, rows)
        return joint_log(path.name, time, rows[:, chosen], names, unit=unit, tail_first=tail_first, notes=skipped)


def joint_log(
    name: str,
    time: np.ndarray,
    angles: np.ndarray,
    joints: tuple[str, ...],
    *,
    unit: str = "",
    tail_first: bool = False,
    notes: tuple[str, ...] = (),
) -> JointLog:
    """The checked log of `angles` (N, n), in `unit`, at `time` (N,) [s]."""
    if unit not in ("", "rad", "deg"):
        raise ValueError(f"units of angles must be rad or deg, got {shown(unit)}")
    later = np.concatenate(([True], time[1:] > np.maximum.accumulate(time)[:-1]))
    if not later.all():
        notes = (*notes, f"{np.count_nonzero(~later)} rows left out: time does not rise")
    time, angles = time[later], angles[later]
    if len(time) < FEWEST_ROWS or len(joints) < FEWEST_JOINTS:
        raise ValueError(
            f"there must be {FEWEST_JOINTS} joints in {FEWEST_ROWS} rows or more, got {len(joints)} in {len(time)}"
        )
    if unit == "deg" or (not unit and all(DEGREES.match(each) for each in joints)):
        angles = np.radians(angles)
    elif np.max(np.abs(angles)) > LARGEST:
        raise ValueError(f"an angle must be at most {LARGEST} rad, got {np.max(np.abs(angles)):.4g}: give --units deg")
    angles, jumps = _without_jumps(time, angles)
    if jumps:
        notes = (*notes, f"{jumps} of {angles.size} readings have jumped: replaced by their neighbours")
    if tail_first:
        angles, joints = angles[:, ::-1], joints[::-1]
    return JointLog(name, time - time[0], angles, joints, notes)


def law_of_links(log: JointLog, places: np.ndarray, length: float) -> SampledLaw:
    """The law of a body of `length` [m], whose joints lie at the `places` (n,) [m] from the nose."""
    places = checked_row("joints", places, None)
    if len(places) != log.angles.shape[1]:
        raise ValueError(f"joints must be {log.angles.shape[1]} places, as the log has, got {len(places)}")
    if np.any(np.diff(places) <= 0.0) or places[0] <= 0.0 or places[-1] >= length:
        raise ValueError(f"joints must rise between 0 and the length {length:g} m, got {shown(places.tolist())}")
    apart = np.diff(places)
    widths = np.concatenate((apart[:1], 0.5 * (apart[1:] + apart[:-1]), apart[-1:]))
    widths = np.minimum(widths, np.minimum(places, length - places))
    x = np.linspace(0.0, length, 1 + int(np.ceil(BY_WIDTH * length / widths.min())))
    off = (x - places[:, None]) / widths[:, None]  # (n, m)
    shapes = np.where(np.abs(off) < 1.0, (1.0 + np.cos(np.pi * off)) / (2.0 * widths[:, None]), 0.0)
    found = smoothed_in_time(log.time, log.angles)
    if gap := long_gap(log.time, np.asarray(found.spline(log.time))):
        raise ValueError(f"{log.name}: {gap[1]}")
    values = np.zeros((len(log.time), 2, 3, len(x)))
    values[:, 1] = np.stack([found.spline(log.time, order) @ shapes for order in range(3)], axis=1)
    residual = np.degrees(np.sqrt(np.mean((found.spline(log.time) - log.angles) ** 2)))
    about = (
        f"angles of {len(places)} joints of {shown(log.name)}, {len(log.time)} instants, smoothed by quintic splines "
        f"with generalised cross-validation; residual (RMS) {residual:.2g} deg"
    )
    return SampledLaw(log.time, x, values, name=Path(log.name).stem or "log", about=about)


def _rows(path: Path) -> tuple[list[str], np.ndarray, tuple[str, ...]]:
    """Names of the columns, the rows of numbers (N, columns), and what was left out."""
    cells = [[cell.strip() for cell in row] for _, row in csv_rows(path, strict=False) if any(map(str.strip, row))]
    numbers = [_numbers(row) for row in cells]
    widths = [len(row) for row in numbers if row is not None]
    if not widths:
        raise ValueError("it has no row of numbers")
    count = max(set(widths), key=widths.count)
    good = [place for place, row in enumerate(numbers) if row is not None and len(row) == count]
    heads = [row for row in cells[: good[0]] if len(row) == count]
    head = heads[-1] if heads else [str(number) for number in range(1, count + 1)]
    lost = len(cells) - good[0] - len(good)
    notes = (f"{lost} rows left out: they are no {count} numbers",) if lost else ()
    return head, np.array([numbers[place] for place in good]), notes


def _numbers(row: list[str]) -> list[float] | None:
    """The numbers of a row, without an empty cell at its end; None where it has others."""
    try:
        found = [float(cell) for cell in (row[:-1] if row[-1] == "" else row)]
    except ValueError:
        return None
    return found if np.all(np.isfinite(found)) else None


def _joint_columns(head: list[str], columns: str) -> list[int]:
    if columns:
        if span := re.fullmatch(r"(\d+)-(\d+)", columns):
            found = list(range(int(span[1]) - 1, int(span[2])))
        else:
            found = [
                index
                for part in columns.split(",")
                for index, name in enumerate(head)
                if fnmatch.fnmatchcase(name, part) or part == name or (part.isdigit() and int(part) == index + 1)
            ]
        if not found or max(found) >= len(head) or min(found) < 0 or len(set(found)) < len(found):
            raise ValueError(f"columns must name joints among the {len(head)} of the file, got {shown(columns)}")
        return found
    for pattern in KNOWN:
        marked = [(int(m[1]), index) for index, name in enumerate(head) if (m := re.fullmatch(pattern, name))]
        if len(marked) >= FEWEST_JOINTS:
            return [index for _, index in sorted(marked)]
    raise ValueError(f"its joints are not plain from {shown(head)}: give --columns, such as 8-13, or names")


def _time(head: list[str], rows: np.ndarray) -> np.ndarray:
    """Time [s]: the first column that looks like it, with a second one of its parts; else the first column."""
    found = next((index for index, name in enumerate(head) if TIME.match(name)), 0)
    time = rows[:, found]
    unit = next((factor for mark, factor in PARTS.items() if head[found].endswith(mark)), 1.0)
    after = head[found + 1] if found + 1 < len(head) else ""
    part = next((factor for mark, factor in PARTS.items() if after.endswith(mark) and TIME.match(after)), None)
    if part is not None and head[found].endswith("[s]"):
        return np.asarray((time - time[0]) + part * rows[:, found + 1])
    return np.asarray((time - time[0]) * unit)


def _without_jumps(time: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, int]:
    """Single readings far from the cubic through their four neighbours, replaced by it, and their number."""
    others = np.stack([time[shift : len(time) - 4 + shift] for shift in (0, 1, 3, 4)])  # (4, N - 4)
    weights = np.ones_like(others)
    for one, other in itertools.permutations(range(4), 2):  # Lagrange
        weights[one] *= (time[2:-2] - others[other]) / (others[one] - others[other])
    found, count = angles.copy(), 0
    for _ in range(PASSES):
        inner = sum(
            weight[:, None] * found[shift : len(time) - 4 + shift]
            for weight, shift in zip(weights, (0, 1, 3, 4), strict=True)
        )
        apart = np.abs(found[2:-2] - inner)
        limit = SPREADS * np.maximum(1.4826 * np.median(apart, axis=0), FINEST)
        around = np.max([np.roll(apart, shift, axis=0) for shift in (-2, -1, 1, 2)], axis=0)  # a jump shows there too
        bad = (apart > limit) & (apart > around)
        found[2:-2] = np.where(bad, inner, found[2:-2])
        count += int(np.count_nonzero(bad))
    return found, count
