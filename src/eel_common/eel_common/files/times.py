# SPDX-License-Identifier: Apache-2.0
"""The times of a table's rows, in the forms that occur in practice.

Times are numbers in the unit of the column's name; numbers since 1970 in s, ms, us or ns, told by their size; ISO 8601
stamps; times of day; or two columns, whole seconds and fractions.
"""

import math
import re
from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from eel_common.files.table import UNITS, Table, split_name
from eel_common.wording import shown

WORD = (  # a word in the name of a time, between separators
    r"(?:date|wall|sys|ros|sim|run)?time(?:stamp|code)?|date|stamp|clock|elapsed"
    r"|(?:mess|uhr)?zeit(?:stempel|punkt)?|temps|tiempo"
)
CALLED = re.compile(rf"(?:.*[^a-z])?(?:{WORD})(?:[^a-z].*)?|(?:.*[_./])?(?:t|ts)")
PLAINLY = "time", "t", "stamp", "timestamp"  # preferred names
NOT_ALONE = "min", "ns", "h"  # units of time that are ambiguous as a column's whole name
EPOCH = 9.5e8, 4.1e9  # s since 1970: the years 2000 to 2099
PARTS = {1.0: "s", 1e-3: "ms", 1e-6: "us", 1e-9: "ns"}  # units of times since 1970
DAY = 86400.0  # s
RISING, MOVING = 0.95, 0.5  # of a time's steps, the fractions that do not fall, and that rise


def time_of(table: Table, column: str = "", besides: Sequence[int] = (), *, missing: bool = False) -> np.ndarray:
    """The times (rows,) [s] of a `table`, counted from the first where they are dates. Guesses go into its notes.

    column: its name or number. "": a column called time, or the first such one that varies, or the only rising column
    that is not among `besides`.
    missing: NaN for a cell that is no time, instead of a `ValueError`.
    """
    place = _place_of_time(table, column, besides)
    values, factor, told = _stamps(table, place) if not table.has_numbers(place) else _numbers(table, place)
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad) == len(values) or (len(bad) and not missing):
        raise table.error(f"{table.label(place)} must be a time, got {shown(table.texts(place)[bad[0]])}", bad[0])
    dates = factor * np.nanmedian(values) > EPOCH[0]
    seconds = factor * (values - (values[np.isfinite(values)][0] if dates else 0.0))
    if factor == 1.0 and (part := _part_of(table, place, values)) is not None:
        seconds, told = seconds + part[1], f"{told}, and {table.label(part[0])}"
    about = f"time from {table.label(place)}, {told}"
    plain = not column and table.head[place] in ("time", "time_s", "t_s") and told == "s"
    table.notes += [] if plain or about in table.notes else [about]
    return np.asarray(seconds)


def _place_of_time(table: Table, column: str, besides: Sequence[int]) -> int:
    if column:
        if len(found := table.chosen(column, "the time")) > 1:
            raise table.error(f"the time must be one column, got {shown([table.head[place] for place in found])}")
        return found[0]
    places = [place for place in range(len(table.head)) if place not in besides]
    called = [place for place in places if is_time(table.head[place])]
    varied = [place for place in called if _varies(table, place)]
    if varied := varied or [place for place in places if _is_dated(table, place)]:
        return max(varied, key=lambda place: split_name(table.head[place])[0] in PLAINLY)  # the first of several
    rising = [place for place in places if _rises(table.raw(place))]
    if len(rising) != 1 and called:
        return called[0]
    if len(rising) != 1:
        raise table.error(f"its time is not plain from {shown(table.head)}: say which column it is (--time)")
    return rising[0]


def is_time(name: str) -> bool:
    """Whether a column's name is that of a time."""
    base, unit = split_name(name)
    return CALLED.fullmatch(base) is not None or (not base and unit not in ("", *NOT_ALONE) and UNITS[unit][0] == "s")


def _varies(table: Table, place: int) -> bool:
    """Whether a column has more than one value."""
    if not table.has_numbers(place):
        return len(set(table.texts(place))) > 1
    values = table.raw(place)
    return bool(np.nanmin(values) < np.nanmax(values))


def _is_dated(table: Table, place: int) -> bool:
    """Whether most cells of a column are dates."""
    if not table.has_numbers(place):
        return math.isfinite(_seconds(table.texts(place)[len(table) // 2]))
    values = table.raw(place)
    return _of_epoch(values) is not None and bool(np.sum(np.diff(values) >= 0.0) >= RISING * (len(values) - 1))


def _of_epoch(values: np.ndarray) -> float | None:
    """The unit [s] in which most `values` are times since 1970, if any."""
    size = float(np.nanmedian(np.abs(values)))
    return next((by for by in PARTS if EPOCH[0] <= size * by <= EPOCH[1]), None)


def _rises(values: np.ndarray) -> bool:
    """Whether nearly all steps of the `values` rise, and the values are not a row count."""
    steps = np.diff(values)
    count = np.median(steps) == 1.0 if len(steps) else True
    return not count and bool(np.mean(steps >= 0.0) > RISING and np.mean(steps > 0.0) > MOVING)


def _numbers(table: Table, place: int) -> tuple[np.ndarray, float, str]:
    """The times in a column of numbers, their unit [s], and their kind in words."""
    values, unit = table.raw(place), table.unit(place)
    size = float(np.nanmedian(np.abs(values)))
    dimension, factor = UNITS.get(unit, ("s", _of_epoch(values) or 1.0))
    if dimension != "s" or size * factor > EPOCH[1]:
        rule = "must be a time before the year 2100 in s, or the unit of its name"
        raise table.error(f"{table.label(place)} {rule}, got {size:g} {unit or 's'}", 0)
    if size * factor < EPOCH[0]:
        return values, factor, unit or "s"
    return np.where(values == 0.0, np.nan, values), factor, f"{unit or PARTS[factor]} since 1970"  # 0: not set


def _stamps(table: Table, place: int) -> tuple[np.ndarray, float, str]:
    """The times in a column of texts, their unit [s], and their kind in words."""
    values = np.array([_seconds(text) for text in table.texts(place)])
    nights = np.cumsum(np.diff(values, prepend=values[:1]) < -0.5 * DAY) if np.nanmax(values, initial=0.0) < DAY else 0
    return values + DAY * nights, 1.0, "stamps"


def _seconds(text: str) -> float:
    """A text in s: ISO 8601 or 28.11.2026, since 1970, in UTC by default; or a time of day. NaN for anything else."""
    plain = re.sub(r"^(\d\d)\.(\d\d)\.(\d{4})", r"\3-\2-\1", text).replace(",", ".").replace("/", "-")
    if re.match(r"\d{1,2}:", plain):
        plain = f"1970-01-01T{plain if plain[2] == ':' else f'0{plain}'}"
    try:
        stamp = datetime.fromisoformat(plain)
    except ValueError:
        return math.nan
    return (stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)).timestamp()


def _part_of(table: Table, place: int, values: np.ndarray) -> tuple[int, np.ndarray] | None:
    """The column with the fractions of whole seconds, of the same name and another unit, and its values [s]."""
    if np.any(values[np.isfinite(values)] % 1.0):
        return None
    base, _ = split_name(table.head[place])
    for other, each in enumerate(table.head):
        name, unit = split_name(each)
        dimension, by = UNITS.get(unit, ("s", 1.0))
        if other == place + 1 and each.isdigit() and np.nanmedian(values) > EPOCH[0]:
            name, by = base, 1e-9  # without a header, as ROS 2 prints messages
        part = by * table.raw(other)
        fits = other != place and name == base and dimension == "s" and by < 1.0
        if fits and np.all((part >= 0.0) & (part < 1.0) | np.isnan(part)):
            return other, part
    return None
