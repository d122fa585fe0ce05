# SPDX-License-Identifier: Apache-2.0
"""The state of a run in a few lines of Markdown.

The path comes from head_pose, the torque from internal_wrench, the rest from diagnostics.
"""

import re

import numpy as np

from eel_viz.messages import Body
from eel_viz.plots.limit import RecentPeak
from eel_viz.plots.readable import number
from eel_viz.settings import Drawing

MAXIMUM_AGE = 2_000_000_000  # ns: older diagnostics are not shown as the present state
LABELS = {  # key of the diagnostics: its label
    "warnings": "**warnings:**",
    "accuracy": "accuracy",
    "error_position": "estimated error of the position",
    "error_torque": "of the torque",
    "real_time_factor": "real-time factor",
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
VOLATILE = ("warnings", "real_time_factor")  # keys that are shown only while they are fresh

RINGS = (
    "Rings are its **joints**: the whiter, the more of what it can does the motor give; thick and red at its limit. "
    "The tab *robot* has all motors over time."
)


class Summary:
    """Collects the state of a run, and writes it as Markdown."""

    def __init__(self) -> None:
        self.law: str | None = None
        self.body: Body | None = None
        self._state: tuple[int, str] = (0, "")  # ns, message of the diagnostics
        self._statuses: list[tuple[int, str, dict[str, str]]] = []  # later than the head's last stamp
        self.values: dict[str, str] = {}  # of the diagnostics
        self._first: tuple[int, np.ndarray] | None = None
        self._last: tuple[int, np.ndarray] | None = None
        self._path = 0.0  # m
        self._torque: tuple[float, float, int] = (0.0, 0.0, 0)  # N m, m, ns: the greatest of the last sample
        self._peak = self._torque  # the greatest so far
        self._recent = RecentPeak()

    def add_position(self, stamp: int, position: np.ndarray) -> None:
        """Add the head's `position`, (3,) [m] in the world, at `stamp` [ns]."""
        if self._last is not None:
            self._path += float(np.linalg.norm(position - self._last[1]))
        self._last = (stamp, np.array(position))
        self._first = self._first or self._last
        self._take_statuses()

    def add_torque(self, stamp: int, x: np.ndarray, torque: np.ndarray) -> None:
        """Add the yaw torque C3, (M,) [N m], at stations `x` (M,) [m] and `stamp` [ns]."""
        k = int(np.argmax(np.abs(torque)))
        self._torque = (float(torque[k]), float(x[k]), stamp)
        self._recent.include(stamp, abs(float(torque[k])), float(x[k]))
        if abs(torque[k]) > abs(self._peak[0]):
            self._peak = self._torque

    def add_status(self, stamp: int, state: str, values: dict[str, str]) -> bool:
        """Add message and values of the diagnostics at `stamp` [ns]; they apply once the head has reached that stamp.

        Returns whether they apply already.
        """
        self._statuses.append((stamp, state, values))
        self._statuses.sort(key=lambda status: status[0])
        del self._statuses[MOST_WAITING:]
        return self._take_statuses()

    def _take_statuses(self) -> bool:
        taken = False
        while self._statuses and self._last is not None and self._statuses[0][0] <= self._last[0]:
            stamp, state, values = self._statuses.pop(0)
            self._state = (stamp, state)
            self.values.update(values)
            taken = True
        return taken

    @property
    def stamp(self) -> int:
        """Time of the head's last position [ns]."""
        return 0 if self._last is None else self._last[0]

    def text(self) -> str:
        """The state as Markdown, one line per item."""
        law = "" if self.law is None else f"law **{plain(self.law)}**"
        fresh = self.stamp - self._state[0] <= MAXIMUM_AGE
        lines = [", ".join(part for part in (law, plain(self._state[1], LONGEST_TEXT) if fresh else "") if part)]
        shown = [key for key in LABELS if self.values.get(key) and (fresh or key not in VOLATILE)]
        lines.append(", ".join(f"{LABELS[key]} {_shown(key, self.values[key])}" for key in shown))
        if self._last is not None and self._first is not None:
            seconds = (self._last[0] - self._first[0]) / 1e9
            mean = self._path / seconds if seconds > 0 else 0.0
            lines.append(f"until {self._last[0] / 1e9:.1f} s: mean speed **{mean:.3f} m/s**, path {self._path:.2f} m")
        if self._peak[0]:
            (torque, x, _), (peak, peak_x, stamp), recent = self._torque, self._peak, self._recent
            lines.append(f"greatest torque C3 in 3 s **{recent.value:.2g} N m** at X = {recent.place:.2f} m")
            lines.append(f"now {torque:+.2g} N m at X = {x:.2f} m")
            lines.append(f"since the start {peak:+.2g} N m at X = {peak_x:.2f} m, {stamp / 1e9:.2f} s")
        if self.body is not None:
            lines.append(f"body {self.body.length:.3g} m, {self.body.mass:.4g} kg")
        return "  \n".join(line for line in lines if line)

    def numbers(self) -> dict[str, float | str]:
        """The values of the diagnostics, as numbers where they are some."""
        found: dict[str, float | str] = {}
        for name, value in self.values.items():
            try:
                found[name] = float(value)
            except ValueError:
                found[name] = value[:LONGEST_TEXT]
        return found

    def figures(self) -> dict[str, str]:
        """The main figures by name, for the comparison of two runs."""
        shown = {"law": plain(self.law or "")}
        shown |= {LABELS[key]: _shown(key, self.values[key]) for key in COMPARED if self.values.get(key)}
        if self._last is not None and self._first is not None:
            seconds = (self._last[0] - self._first[0]) / 1e9
            shown["mean speed [m/s]"] = f"{self._path / seconds:.4f}" if seconds > 0 else "0"
            shown["path [m]"] = f"{self._path:.3f}"
        shown["greatest C3 of the samples [N m]"] = f"{self._peak[0]:+.4f}"
        shown["warnings"] = str(len(self.values["warnings"].split("; "))) if self.values.get("warnings") else "none"
        return shown


def look_text(scales: Drawing, body: Body | None = None) -> str:
    """Markdown: what to look at, a sentence each, and the scales of the arrows; with what `body` has of parts."""
    lines = [
        "The eel swims towards its eyes, along the white arrow: bends run from nose to tail and push the water back.",
        "Colour on its flanks is the torque **C3** that bends it sideways, red one way and blue the other, on the "
        "scale of the bar below the picture.",
        "Arrows are the **force of the water** (yellow; magenta at nose and tail), the violet ribbon what the tail "
        "leaves in the **wake**.",
        *(["Lime plates are its **fins**, as large and turned as they are."] if body and body.fins else []),
        *([RINGS] if body and body.joints else []),
        "",
        f"Lengths: {scales.load_scale:g} m for 1 N/m along the body, {scales.end_force_scale:g} m for 1 N at its ends.",
    ]
    return "\n".join(lines)


def plain(name: str, longest: int = LONGEST_NAME) -> str:
    """A text from a message, escaped for Markdown, in one line of at most `longest` characters."""
    text = "".join(letter if letter.isprintable() else " " for letter in name[:longest])
    escaped = re.sub(r"([\\`*_{}\[\]<>#|~])", r"\\\1", text)
    return escaped + ("..." if len(name) > longest else "")


def _shown(key: str, value: str) -> str:
    """Numbers to three digits; names, as of the accuracy, and other texts unchanged."""
    try:
        return plain(value) if key == "accuracy" else number(float(value))
    except ValueError:
        return plain(value, LONGEST_TEXT)
