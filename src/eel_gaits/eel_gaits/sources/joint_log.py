# SPDX-License-Identifier: Apache-2.0
"""Joint angles as robots log them, and the law of a chain of links whose joints lie where they lie.

A log is a .csv file with or without a header, perhaps with lines before it, in degrees or radians. Rows that do not fit
and readings that jump are left out, and told. The links are rigid, so all bending is at the joints. Joint j at X_j is
spread over a width w_j to either side, the mean distance to its neighbours, or less near an end:

    K(t, X) = sum_j phi_j(t) (1 + cos(pi (X - X_j) / w_j)) / (2 w_j),   |X - X_j| < w_j

So each angle is kept exactly, and at equal distances the angles add up smoothly. phi > 0 bends the tail to the right.
"""

import itertools
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_base.files.input_file import reading
from eel_base.files.table import Table
from eel_base.files.tables import read_table
from eel_base.files.times import time_of
from eel_base.quantity import checked_row
from eel_base.wording import shown

from eel_gaits.sources.period import long_gap
from eel_gaits.sources.sampled_law import SampledLaw
from eel_gaits.sources.smoothing import smoothed_in_time

KNOWN = (  # what numbered columns of joints are called, the best first; # stands for the number
    r"yaw_?#", r".*(?:pos|angle|theta|phi|fbck|encoder|present|actual|measured).*", r".*(?:joint|servo|motor|\bq_?#).*",
)  # fmt: skip
OTHER = re.compile(  # columns of joints that are no angles, or not measured
    r"vel|speed|rate|effort|torque|force|curr|volt|temp|load|pwm|goal|cmd|command|desired|target|ref|set_?point|err|acc"
)
FEWEST_JOINTS, FEWEST_ROWS = 2, 16
SPREADS, FINEST = 6.0, 2e-3  # robust spreads beyond which a reading has jumped, and the least spread [rad]
PASSES = 3
LARGEST = 3.2  # rad, of a joint: beyond it the file is in degrees
MOST_LOST, MOST_SETS = 0.1, 5  # part of the rows that may be left out; times that a clock may be set back
SINGLE = 0.75  # of a step, that is left without a row whose stamp alone is bad
SEAM = 3.0  # greatest steps of the angles by which they may differ where the clock is set back
FASTEST, SLOWEST, LONGEST = 50.0, 0.05, 0.5  # rad/s (RMS), of joints; s, of a step: beyond them time is not in s
BY_WIDTH = 8  # points of the law in a joint's width


class JointLog(NamedTuple):
    """Angles of n joints from head to tail at N instants."""

    name: str
    time: np.ndarray  # (N,) s, from 0
    angles: np.ndarray  # (N, n) rad
    joints: tuple[str, ...]  # their names
    notes: tuple[str, ...]  # what was done, in words
    read: str = ""  # what was guessed of the file's form, in words


def read_joint_log(
    path: Path,
    *,
    columns: str = "",
    time: str = "",
    unit: str = "",
    tail_first: bool = False,
    clock: float = 1.0,
) -> JointLog:
    """The log in a table of text. `ValueError` names the file and what does not fit.

    columns: which hold joints: numbers from 1 ("8-13"), names with commas between them, or a pattern ("*Fbck*"); "":
    those that look like it. time: the column of times. unit: rad or deg; "": as the columns' names say, else rad.
    clock: true time by that of the log.
    """
    with reading(shown(str(path))):
        table = read_table(path, lenient=True)
        chosen = table.chosen(columns, "columns") if columns else _joint_columns(table)
        times = time_of(table, time, besides=chosen, missing=True)
        names = tuple(table.head[place] for place in chosen)
        factors = np.array([table.factor(place, "rad") for place in chosen])
        said = {word for word in map(table.unit, chosen) if word}
        if unit and said and np.any(factors != (1.0 if unit == "rad" else np.radians(1.0))):
            raise ValueError(f"its columns are in {', '.join(sorted(said))}, the units given are {unit}")
        angles = np.stack([table.raw(place) for place in chosen], axis=1) * (1.0 if unit else factors)
        mine = np.asarray(np.isfinite(angles).any(axis=1))
        read = [
            *table.notes,
            times.about,
            f"joints {names[0]} to {names[-1]}, {unit or ', '.join(sorted(said)) or 'rad'}",
        ]
        if not mine.all():
            read.append(f"{np.sum(~mine)} rows without any of them")
        log = joint_log(
            path.name,
            times.seconds[mine],
            angles[mine],
            names,
            unit=unit,
            tail_first=tail_first,
            clock=clock,
            lines=table.lines[mine],
            lost=table.lost,
        )
        return log._replace(read=", ".join(read))


def joint_log(
    name: str,
    time: np.ndarray,
    angles: np.ndarray,
    joints: tuple[str, ...],
    *,
    unit: str = "",
    tail_first: bool = False,
    clock: float = 1.0,
    lines: np.ndarray | None = None,
    lost: Sequence[int] = (),
) -> JointLog:
    """The checked log of `angles` (N, n), in `unit`, at `time` (N,) [s]. NaN for what is missing.

    lines (N,): of the file, for messages. lost: those of rows that were left out.
    """
    if unit not in ("", "rad", "deg"):
        raise ValueError(f"units of angles must be rad or deg, got {shown(unit)}")
    time, angles, notes = _mended(time, angles, np.arange(1, len(time) + 1) if lines is None else lines, lost)
    if len(time) < FEWEST_ROWS or len(joints) < FEWEST_JOINTS:
        raise ValueError(
            f"there must be {FEWEST_JOINTS} joints in {FEWEST_ROWS} rows or more, got {len(joints)} in {len(time)}"
        )
    time = clock * (time - time[0])
    if unit == "deg":
        angles = np.radians(angles)
    elif np.max(np.abs(angles)) > LARGEST:
        raise ValueError(f"an angle must be at most {LARGEST} rad, got {np.max(np.abs(angles)):.4g}: give --units deg")
    _check_pace(time, angles)
    angles, jumps = _without_jumps(time, angles)
    if jumps:
        notes.append(f"{jumps} of {angles.size} readings have jumped: replaced by their neighbours")
    if tail_first:
        angles, joints = angles[:, ::-1], joints[::-1]
    return JointLog(name, time, angles, joints, tuple(notes))


def _check_pace(time: np.ndarray, angles: np.ndarray) -> None:
    """`ValueError` where no joint moves as the `angles` (N, n) [rad] would at the `time` (N,) [s]."""
    rate = float(np.sqrt(np.mean((np.diff(angles, axis=0) / np.diff(time)[:, None]) ** 2)))
    step = float(np.median(np.diff(time)))
    if rate > FASTEST or (0.0 < rate < SLOWEST and step > LONGEST):
        hint = f"if it is in other units, give --clock {'1000' if rate > FASTEST else '0.001'}, or time_ms as its name"
        raise ValueError(f"its joints turn by {rate:.3g} rad/s (RMS) in steps of {step:.3g} s: time in s? {hint}")


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


def _joint_columns(table: Table) -> list[int]:
    """The columns of joints, by their names: those that differ in one number."""
    groups: dict[str, dict[int, int]] = {}
    for place, name in enumerate(table.head):
        for number in re.finditer(r"\d+", name):
            key = f"{name[: number.start()]}#{name[number.end() :]}"
            if len(key) > 1 and not OTHER.search(key.lower()) and table.has_numbers(place):
                groups.setdefault(key, {})[int(number[0])] = place
    for pattern in KNOWN:
        found = [
            key for key, each in groups.items() if len(each) >= FEWEST_JOINTS and re.fullmatch(pattern, key.lower())
        ]
        if len(found) == 1:
            return [place for _, place in sorted(groups[found[0]].items())]
        if found:
            raise ValueError(f"its joints may be any of {shown(found)}: give --columns {found[0].replace('#', '*')!r}")
    raise ValueError(f"its joints are not plain from {shown(table.head)}: give --columns, such as 8-13, or names")


def _mended(
    time: np.ndarray, angles: np.ndarray, lines: np.ndarray, lost: Sequence[int]
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Times that rise, and their angles, and what was done. `ValueError` where that would leave out much."""
    whole, notes = np.isfinite(time) & np.isfinite(angles).all(axis=1), list[str]()
    if lost:
        notes.append(f"{len(lost)} rows left out, the first in line {lost[0]}: they have another number of cells")

    def keep(good: np.ndarray, why: str) -> None:
        nonlocal time, angles, lines
        if not good.all():
            notes.append(f"{np.sum(~good)} rows left out, the first in line {lines[~good][0]}: {why}")
            time, angles, lines = time[good], angles[good], lines[good]

    keep(whole, "a time or an angle is missing or no number")
    again = np.concatenate(([False], (np.diff(time) == 0.0) & np.all(np.diff(angles, axis=0) == 0.0, axis=1)))
    count = len(time) - np.sum(again) + len(lost) + np.sum(~whole)
    keep(~again, "they stand there twice")
    good, time, sets = _rising(time.copy(), angles, lines)
    notes += sets
    keep(good, "time does not rise")
    if count - len(time) > MOST_LOST * count:
        raise ValueError(f"only {len(time)} of its {count} rows can be read: {'; '.join(notes)}")
    return time, angles, notes


def _rising(time: np.ndarray, angles: np.ndarray, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Rows to keep, so that `time` rises; the time, that goes on where the clock was set back; and notes of that."""
    good, notes = np.ones(len(time), dtype=bool), list[str]()
    steps = np.diff(time)
    step = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 0.0
    most = np.percentile(np.abs(np.diff(angles, axis=0)), 99.0) if len(steps) else 0.0
    before, last = -1, 0  # the last two rows that are kept
    for row in range(1, len(time)):
        if time[row] > time[last]:
            before, last = last, row
            continue
        spike = time[row] - time[before] if before >= 0 else 2.0 * step  # without the row `last`
        dip = time[row + 1] - time[last] if row + 1 < len(time) else 2.0 * step  # without this one
        if spike > SINGLE * step and abs(spike - 2.0 * step) < abs(dip - 2.0 * step):
            good[last], last = False, row
        elif dip > SINGLE * step or time[row] == time[last]:
            good[row] = False
        else:
            back = time[last] - time[row]
            if np.max(np.abs(angles[row] - angles[last])) > SEAM * most + FINEST or len(notes) == MOST_SETS:
                raise ValueError(f"its clock is set back by {back:.4g} s in line {lines[row]}: two logs in one file?")
            time[row:] += back + step
            notes.append(f"the clock is set back by {back:.4g} s in line {lines[row]}: time goes on by a step there")
            before, last = last, row
    return good, time, notes


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
