# SPDX-License-Identifier: Apache-2.0
"""The state of a run in a few lines of Markdown.

The path comes from head_pose, the torque from internal_wrench, the rest from diagnostics. Topics come in any order. The
text always describes one stamp: the last for which both topics have come.
"""

import math
import re
from typing import NamedTuple

import numpy as np

from eel_viz.limit import RecentPeak
from eel_viz.messages import Body, Status
from eel_viz.same_stamp import SameStamp

MAXIMUM_AGE = 2_000_000_000  # ns: older diagnostics are not shown as the present state
LABELS = {  # key of the diagnostics: its label
    "warnings": "**warnings:**",
    "accuracy": "accuracy",
    "error_position": "estimated error of the position",
    "error_torque": "of the torque",
    "real_time_factor": "pace [times real time]",
    "at_torque_limit": "**at their torque limits:**",
    "closure_torque_relative": "closure",
    "energy_residual_worst": "worst residual [J]",
}
COMPARED = (
    "accuracy",
    "error_position",
    "real_time_factor",
    "energy_residual_worst",
)  # keys shown in the comparison of two runs
LONGEST_NAME, LONGEST_TEXT = 60, 400  # characters
MOST_WAITING = 100  # statuses, the earliest ones
PREFIXES = (("", 1.0), ("m", 1e-3), ("µ", 1e-6))
DIGITS = 3  # of a number
VOLATILE = ("warnings", "real_time_factor")  # keys that are shown only while they are fresh
UNKNOWN_AT_0 = ("error_position", "error_torque", "real_time_factor")  # 0: not known so far
WAITING = "waiting"  # message of a node that has not begun


class Path(NamedTuple):
    """The path of the head up to a stamp: its length [m], and its duration [s]."""

    length: float
    seconds: float

    @property
    def speed(self) -> float:
        """The mean [m/s]; 0 at the start."""
        return self.length / self.seconds if self.seconds > 0 else 0.0


class Torque(NamedTuple):
    """C3 at its greatest magnitude [N m], its place [m] and stamp [ns]."""

    value: float = 0.0
    x: float = 0.0
    stamp: int = 0


class Torques(NamedTuple):
    """The greatest C3 of one sample, of the last seconds, and since the start."""

    now: Torque = Torque()
    recent: Torque = Torque()
    peak: Torque = Torque()


class Summary:
    """Collects the state of a run, partly through the methods of topics, and writes it as Markdown.

    Attributes:
        stamp: of the text [ns]. values: of the diagnostics, by key.
    """

    def __init__(self) -> None:
        self._law: str | None = None
        self._body: Body | None = None
        self._state: tuple[int, str] = (0, "")  # ns, message of the diagnostics
        self._statuses: list[tuple[int, str, dict[str, str]]] = []  # later than `stamp`
        self.values: dict[str, str] = {}
        self.stamp = 0
        self._begin = 0  # ns: start of the path
        self._head: np.ndarray | None = None  # its last position
        self._length = 0.0  # m: of its path
        self._peak, self._recent = Torque(), RecentPeak()
        self._path: Path | None = None  # this and the next: shown in the text
        self._torques = Torques()
        self._has_torque = False
        self._sample = SameStamp(self._complete)

    def body(self, stamp: int, body: Body) -> None:
        self._body = body

    def curvature_law(self, stamp: int, name: str) -> None:
        self._law = name

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Take message and values of each status. They apply once a sample has reached their stamp."""
        for status in statuses:
            self.add_status(stamp, status.message, status.values)

    def add_position(self, stamp: int, position: np.ndarray) -> bool:
        """Add the head's `position`, (3,) [m] in the world, at `stamp` [ns]. Returns whether a sample is complete."""
        if self._head is None:
            self._begin = stamp
        else:
            self._length += float(np.linalg.norm(position - self._head))
        self._head = np.array(position)
        path = Path(self._length, (stamp - self._begin) / 1e9)
        if not self._has_torque:
            self._complete(stamp, path, self._torques)
        self._sample.first(stamp, path)
        return self.stamp == stamp

    def add_torque(self, stamp: int, x: np.ndarray, torque: np.ndarray) -> bool:
        """Add the yaw torque C3, (M,) [N m], at stations `x` (M,) [m] and `stamp` [ns]. Returns as `add_position`."""
        self._has_torque = True
        k = int(np.argmax(np.abs(torque)))
        now = Torque(float(torque[k]), float(x[k]), stamp)
        self._recent.include(stamp, abs(now.value), now.x)
        if abs(now.value) > abs(self._peak.value):
            self._peak = now
        self._sample.second(stamp, Torques(now, Torque(self._recent.value, self._recent.place), self._peak))
        return self.stamp == stamp

    def _complete(self, stamp: int, path: Path, torques: Torques) -> None:
        self.stamp, self._path, self._torques = stamp, path, torques
        self._take_statuses()

    def add_status(self, stamp: int, state: str, values: dict[str, str]) -> bool:
        """Add message and values of a status at `stamp` [ns]. Returns whether they apply already."""
        self._statuses.append((stamp, state, values))
        self._statuses.sort(key=lambda status: status[0])
        del self._statuses[MOST_WAITING:]
        return self._take_statuses()

    def _take_statuses(self) -> bool:
        taken = False
        while self._statuses and self._path is not None and self._statuses[0][0] <= self.stamp:
            stamp, state, values = self._statuses.pop(0)
            self._state = (stamp, state)
            self.values.update(values)
            taken = True
        return taken

    def text(self) -> str:
        """The state as Markdown, one line per item."""
        law = "" if self._law is None else f"law **{plain(self._law)}**"
        fresh = self.stamp - self._state[0] <= MAXIMUM_AGE
        body = "" if self._body is None else f"body {self._body.length:.3g} m, {self._body.mass:.4g} kg"
        begun = self._state[1].startswith(WAITING) and self.stamp > self._state[0]
        state = plain(self._state[1], LONGEST_TEXT) if fresh and not begun else ""
        lines = [", ".join(part for part in (law, state, body) if part)]
        shown = [key for key in LABELS if self._known(key) and (fresh or key not in VOLATILE)]
        lines.append(", ".join(f"{LABELS[key]} {_shown(key, self.values[key])}" for key in shown))
        if self._path is not None:
            path = f"mean speed **{self._path.speed:.3f} m/s**, path {self._path.length:.2f} m"
            lines.append(f"until {self.stamp / 1e9:.2f} s: {path}")
        if self._torques.peak.value:
            now, recent, peak = self._torques
            lines.append(f"greatest torque |C3| in 3 s **{recent.value:.2g} N m** at X = {recent.x:.2f} m")
            lines.append(f"greatest C3 now {now.value:+.2g} N m at X = {now.x:.2f} m")
            most = f"**{peak.value:+.2g} N m** at X = {peak.x:.2f} m, {peak.stamp / 1e9:.2f} s"
            lines.append(f"greatest C3 since the start {most}")
        return "  \n".join(line for line in lines if line)

    def _known(self, key: str) -> bool:
        """Whether the diagnostics have told the value of `key`."""
        value = self.values.get(key, "")
        try:
            return bool(value) and not (key in UNKNOWN_AT_0 and float(value) == 0.0)
        except ValueError:
            return True

    def numbers(self) -> dict[str, float | str]:
        """The values of the diagnostics, converted to numbers if possible."""
        found: dict[str, float | str] = {}
        for name, value in self.values.items():
            try:
                found[name] = float(value)
            except ValueError:
                found[name] = value[:LONGEST_TEXT]
        return found

    def figures(self) -> dict[str, str]:
        """The main figures by name, for the comparison of two runs."""
        shown = {"law": plain(self._law or "")}
        shown |= {LABELS[key]: _shown(key, self.values[key]) for key in COMPARED if self._known(key)}
        if self._path is not None:
            shown["mean speed [m/s]"] = f"{self._path.speed:.4f}" if self._path.seconds > 0 else "0"
            shown["path [m]"] = f"{self._path.length:.3f}"
        shown["greatest C3 of the samples [N m]"] = f"{self._torques.peak.value:+.4f}"
        shown["warnings"] = str(len(self.values["warnings"].split("; "))) if self.values.get("warnings") else "none"
        return shown


def plain(name: str, longest: int = LONGEST_NAME) -> str:
    """A text from a message, escaped for Markdown, in one line of at most `longest` characters."""
    text = "".join(letter if letter.isprintable() else " " for letter in name[:longest])
    escaped = re.sub(r"([\\`*_{}\[\]<>#|~])", r"\\\1", text)
    return escaped + ("..." if len(name) > longest else "")


def _shown(key: str, value: str) -> str:
    """Numbers to three digits; other texts, such as the name of an accuracy, unchanged."""
    try:
        return plain(value) if key == "accuracy" else number(float(value))
    except ValueError:
        return plain(value, LONGEST_TEXT)


def number(value: float) -> str:
    """`value` to three digits: 0.0123, 1,740, 130; with a power of ten only below 0.0001 and from a million on."""
    if value == 0 or not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{DIGITS}g}"
    decimals = max(0, DIGITS - 1 - math.floor(math.log10(abs(value))))
    return f"{float(f'{value:.{DIGITS}g}'):,.{decimals}f}"


def quantity(value: float, unit: str) -> str:
    """`value` [unit] with the prefix (none, milli, micro) that makes the number at least 1, if one does."""
    prefix, size = next(
        (each for each in PREFIXES if abs(value) >= each[1]), PREFIXES[0] if value == 0 else PREFIXES[-1]
    )
    return f"{number(value / size)} {prefix}{unit}"
