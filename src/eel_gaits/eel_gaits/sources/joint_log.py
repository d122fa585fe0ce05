# SPDX-License-Identifier: Apache-2.0
"""Joint angles as robots log them, and the law of a chain of links with these joints.

A log is a table with or without a header, perhaps after other lines, in degrees or radians. Unusable rows and readings
that jump are left out, with a note. The links are rigid, so all bending is at the joints. Joint j at X_j is
spread over a width w_j to either side, the mean distance to its neighbours, or less near an end:

    K(t, X) = sum_j phi_j(t) (1 + cos(pi (X - X_j) / w_j)) / (2 w_j),   |X - X_j| < w_j

So each angle is kept exactly, and equally spaced joints add up smoothly. phi > 0 bends the tail to the right.
"""

import itertools
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from eel_common.files.input_file import reading
from eel_common.files.table import LARGEST_ANGLE, UNITS, Table
from eel_common.files.tables import read_table
from eel_common.files.times import time_of
from eel_common.quantity import checked_row, positive
from eel_common.wording import shown

from eel_gaits.sources.period import long_gap
from eel_gaits.sources.sampled_law import SampledLaw
from eel_gaits.sources.smoothing import smoothed_in_time

KNOWN = (  # names of numbered columns of joints, the best first; # stands for the number
    r"yaw[ _.]?#.*",
    r".*(?:pos|angle|winkel|theta|phi|fbck|encoder|present|actual|measured).*",
    r".*(?:joint|gelenk|servo|motor|module|link|\b[jq]_?#).*",
)
OTHER = re.compile(  # columns of joints other than measured angles
    r"vel|speed|rate|effort|torque|force|curr|volt|temp|load|pwm|goal|cmd|command|desired|target|ref|set_?point|err|acc"
)
FEWEST_JOINTS, FEWEST_ROWS = 2, 16
SPREADS, FINEST = 6.0, 2e-3  # a reading beyond these robust spreads has jumped; least spread [rad]
PASSES = 3
MOST_LOST, MOST_SETS = 0.1, 5  # most rows left out, as a part; most times that a clock is set back
RARE = 0.5  # a column filled in fewer of the joints' rows belongs to another topic
SINGLE = 0.75  # of a step, left between its neighbours by a row with a bad stamp
SEAM = 3.0  # greatest steps of the angles: allowed difference where the clock is set back
FASTEST, SLOWEST, LONGEST = 50.0, 0.05, 0.5  # rad/s (RMS) of joints; s, a step: outside these limits time is not in s
BY_WIDTH = 8  # points of the law per joint width


class JointLog(NamedTuple):
    """Angles of n joints from head to tail at N instants."""

    name: str
    time: np.ndarray  # (N,) s, from 0
    angles: np.ndarray  # (N, n) rad
    joints: tuple[str, ...]  # their names
    notes: tuple[str, ...]  # what was done, in words
    read: str = ""  # what was guessed of the file's form, in words


def read_joint_log(
    source: Path | Table,
    *,
    columns: str = "",
    time: str = "",
    unit: str = "",
    tail_first: bool = False,
    clock: float = 1.0,
) -> JointLog:
    """The log in a table, or in a file of one. `ValueError` names the file and the fault.

    columns: those of the joints: numbers from 1 ("8-13"), names with commas between them, or a pattern ("*Fbck*"); "":
    recognised by name. time: the column of times. unit: rad or deg; "": from the columns' names, or else rad.
    clock: true time divided by the log's.
    """
    path = source.path if isinstance(source, Table) else source
    with reading(shown(str(path))):
        table = source if isinstance(source, Table) else read_table(source, lenient=True)
        clock = positive("clock", clock)
        chosen = table.chosen(columns, "columns") if columns else _joint_columns(table)
        times = time_of(table, time, besides=chosen, missing=True)
        joints, units = tuple(table.head[place] for place in chosen), {table.unit(place) for place in chosen} - {""}
        factors = [table.factor(place, "rad") for place in chosen]
        if unit not in ("", "rad", "deg"):
            raise ValueError(f"units of angles must be rad or deg, got {shown(unit)}")
        if unit and any(UNITS[each][1] != UNITS[unit][1] for each in units):
            raise ValueError(f"its columns are in {', '.join(sorted(units))}, the units given are {unit}")
        if not unit:
            table.check_units(chosen)
        angles = np.stack([table.raw(place) for place in chosen], axis=1) * (UNITS[unit][1] if unit else factors)
        told = unit or ", ".join(sorted(units)) or "rad"
        read = [*table.notes, f"joints {joints[0]} to {joints[-1]}, {told}"]
        mine = np.isfinite(angles).any(axis=1)
        if not np.isfinite(angles).all(axis=1).any():
            angles = _in_one_row(times, angles)
            mine = np.isfinite(angles[:, 0])
            read.append("joints of several topics brought to the times of the first")
        filled = [table.filled(place) for place in range(len(table.head))]
        rare = [each for each in filled if np.mean(each[mine]) < RARE]  # columns of other topics, if any
        if others := int(np.sum(~(mine := mine | ~np.any(rare, axis=0)))):
            read.append(f"{others} rows of other topics")
        seconds, angles, notes = _mended(times[mine], angles[mine], table.lines[mine], table)
        if len(seconds) < FEWEST_ROWS or len(joints) < FEWEST_JOINTS:
            rule = f"{FEWEST_JOINTS} joints in {FEWEST_ROWS} rows or more"
            raise ValueError(f"there must be {rule}, got {len(joints)} in {len(seconds)}")
        if told == "rad":
            _check_size(angles, ": give --units deg")
        seconds = clock * (seconds - seconds[0])
        _check_pace(seconds, angles)
        angles, jumps = _without_jumps(seconds, angles)
        _check_size(angles, f": is it in {told}?")
    if jumps:
        notes.append(f"{jumps} of {angles.size} readings have jumped: replaced by their neighbours")
    if tail_first:
        angles, joints = angles[:, ::-1], joints[::-1]
    return JointLog(path.name, seconds, angles, joints, tuple(notes), ", ".join(read))


def _check_size(angles: np.ndarray, hint: str) -> None:
    """`ValueError` if one of the `angles` (N, n) [rad] is too large for a joint."""
    if (most := np.max(np.abs(angles))) > LARGEST_ANGLE:
        raise ValueError(f"an angle must be at most {LARGEST_ANGLE} rad, got {most:.4g}{hint}")


def _check_pace(time: np.ndarray, angles: np.ndarray) -> None:
    """`ValueError` if no joint could move like the `angles` (N, n) [rad] at the `time` (N,) [s]."""
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
    """The columns of joints, recognised by names that differ in one number."""
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
        joints = [each for key in found for each in sorted(groups[key].items())]
        if found and len({number for number, _ in joints}) == len(joints):  # perhaps of several topics
            return [place for _, place in sorted(joints)]
        if found:
            raise ValueError(f"its joints may be any of {shown(found)}: give --columns {found[0].replace('#', '*')!r}")
    raise ValueError(f"its joints are not plain from {shown(table.head)}: give --columns, such as 8-13, or names")


def _in_one_row(time: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """The angles (N, n) of joints that each have rows of their own, interpolated at the times of the first joint."""
    from scipy.interpolate import CubicSpline

    found = np.full_like(angles, np.nan)
    first = np.isfinite(angles[:, 0])
    for joint, each in enumerate(angles.T):
        own = np.isfinite(each) & np.isfinite(time)
        if np.sum(own) < FEWEST_ROWS or np.any(np.diff(time[own]) <= 0.0):
            raise ValueError("its joints have rows of their own: the time of each must rise")
        found[first, joint] = CubicSpline(time[own], each[own], extrapolate=False)(time[first])
    return found


def _mended(
    time: np.ndarray, angles: np.ndarray, lines: np.ndarray, table: Table
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Times (N,) that rise, their angles, and notes of the repairs. `ValueError` if too much would be left out.

    A row is left out if only its stamp is bad. If a clock is set back and the angles go on, time goes on too.
    """
    notes, count = list[str](), len(time) + len(table.lost)

    def keep(good: np.ndarray, why: str) -> None:
        nonlocal time, angles, lines
        if not good.all():
            notes.append(f"{np.sum(~good)} rows left out, the first in {table.word} {lines[~good][0]}: {why}")
            time, angles, lines = time[good], angles[good], lines[good]

    if table.lost:
        notes.append(
            f"{len(table.lost)} rows left out, the first in line {table.lost[0]}: they have another number of cells"
        )
    keep(np.isfinite(time) & np.isfinite(angles).all(axis=1), "a time or an angle is missing or no number")
    twice = (np.diff(time) == 0.0) & np.all(np.diff(angles, axis=0) == 0.0, axis=1)
    keep(np.append(True, ~twice)[: len(time)], "they stand there twice")
    rises = np.diff(time)[np.diff(time) > 0.0]
    step = float(np.median(rises)) if len(rises) else 0.0
    before, after = np.append(-np.inf, time[:-1]), np.append(time[1:], np.inf)
    alone = (time <= before) | (time > after)
    keep(~(alone & ((after - before > SINGLE * step) | (time == before))), "their stamps alone do not rise")
    if len(time) < count - np.sum(twice) - MOST_LOST * count:
        raise ValueError(f"only {len(time)} of its {count} rows can be read: {'; '.join(notes)}")
    moves = np.max(np.abs(np.diff(angles, axis=0)), axis=1, initial=0.0)
    back = np.flatnonzero(np.diff(time) <= 0.0)
    for place in back:
        told = f"the clock is set back by {time[place] - time[place + 1]:.4g} s in {table.word} {lines[place + 1]}"
        if moves[place] > SEAM * np.percentile(moves, 99.0) + FINEST or len(back) > MOST_SETS:
            raise ValueError(f"{told}: two logs in one file?")
        notes.append(f"{told}: time goes on by a step there; if these are two logs, cut the file there")
    steps = np.diff(time, prepend=time[:1])
    steps[back + 1] = step
    return (time[0] + np.cumsum(steps) if len(back) else time), angles, notes


def _without_jumps(time: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, int]:
    """The angles, with single readings far from the cubic through their four neighbours replaced, and their number."""
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
