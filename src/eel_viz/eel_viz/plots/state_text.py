"""The state of a run in a few lines of text: what a viewer wants to know before trusting the picture.

Everything comes from messages: the path from head_pose, the torque from internal_wrench, the rest from diagnostics.
"""

import re

import numpy as np

from eel_viz.messages import Body

FRESH = 2_000_000_000  # ns: what the diagnostics said longer ago is not told as the present
TOLD = {  # keys of the diagnostics, and the words for them
    "warnings": "**warnings:**",
    "accuracy": "accuracy",
    "real_time_factor": "real-time factor",
    "closure_torque_relative": "closure",
    "energy_residual_worst": "worst residual [J]",
}
COMPARED = ("accuracy", "real_time_factor", "energy_residual_worst")  # beside another run
LONGEST_NAME, LONGEST_TEXT = 60, 400  # characters
PRESENT = ("warnings", "real_time_factor")  # those that may be otherwise a moment later


class Summary:
    """Collects, and writes Markdown."""

    def __init__(self) -> None:
        self.law: str | None = None
        self.body: Body | None = None
        self._state: tuple[int, str] = (0, "")  # in the diagnostics' words, and when [ns]
        self._statuses: list[tuple[int, str, dict[str, str]]] = []  # to come
        self.values: dict[str, str] = {}  # of the diagnostics
        self._first: tuple[int, np.ndarray] | None = None
        self._last: tuple[int, np.ndarray] | None = None
        self._path = 0.0  # m
        self._peak: tuple[float, float, int] = (0.0, 0.0, 0)  # N m, m, ns

    def move(self, stamp: int, position: np.ndarray) -> None:
        """The head is at `position`, (3,) [m], at `stamp` [ns]."""
        if self._last is not None:
            self._path += float(np.linalg.norm(position - self._last[1]))
        self._last = (stamp, np.array(position))
        self._first = self._first or self._last
        self._take_statuses()

    def strain(self, stamp: int, x: np.ndarray, torque: np.ndarray) -> None:
        """The yaw torque C3, (M,) [N m], at stations `x` [m] and `stamp` [ns]."""
        k = int(np.argmax(np.abs(torque)))
        if abs(torque[k]) > abs(self._peak[0]):
            self._peak = (float(torque[k]), float(x[k]), stamp)

    def status(self, stamp: int, state: str, values: dict[str, str]) -> bool:
        """What the diagnostics say at `stamp` [ns]; told once the head is there, and whether it is already."""
        self._statuses.append((stamp, state, values))
        self._statuses.sort(key=lambda status: status[0])
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
        """Markdown, one line of text a line."""
        law = "" if self.law is None else f"law **{plain(self.law)}**"
        fresh = self.stamp - self._state[0] <= FRESH
        lines = [", ".join(part for part in (law, plain(self._state[1], LONGEST_TEXT) if fresh else "") if part)]
        told = [key for key in TOLD if self.values.get(key) and (fresh or key not in PRESENT)]
        lines.append(", ".join(f"{TOLD[key]} {_short(self.values[key])}" for key in told))
        if self._last is not None and self._first is not None:
            seconds = (self._last[0] - self._first[0]) / 1e9
            mean = self._path / seconds if seconds > 0 else 0.0
            lines.append(f"mean speed **{mean:.3f} m/s**, path {self._path:.2f} m")
        torque, x, stamp = self._peak
        if torque:
            lines.append(f"greatest C3 **{torque:+.3f} N m** at X {x:.2f} m, {stamp / 1e9:.2f} s")
        if self.body is not None:
            lines.append(f"body {self.body.length:.3g} m, {self.body.mass:.4g} kg")
        return "  \n".join(line for line in lines if line)

    def figures(self) -> dict[str, str]:
        """The same in short, by name, to stand beside those of another run."""
        told = {"law": plain(self.law or "")}
        told |= {TOLD[key]: _short(self.values[key]) for key in COMPARED if self.values.get(key)}
        if self._last is not None and self._first is not None:
            seconds = (self._last[0] - self._first[0]) / 1e9
            told["mean speed [m/s]"] = f"{self._path / seconds:.4f}" if seconds > 0 else "0"
            told["path [m]"] = f"{self._path:.3f}"
        told["greatest C3 [N m]"] = f"{self._peak[0]:+.4f}"
        told["warnings"] = str(len(self.values["warnings"].split("; "))) if self.values.get("warnings") else "none"
        return told


def plain(name: str, longest: int = LONGEST_NAME) -> str:
    """A text from a message, in Markdown: shown as it is, in one line and not too long."""
    text = "".join(letter if letter.isprintable() else " " for letter in name[:longest])
    escaped = re.sub(r"([\\`*_{}\[\]<>#|~])", r"\\\1", text)
    return escaped + ("..." if len(name) > longest else "")


def _short(value: str) -> str:
    """Numbers to three digits; words as they are."""
    try:
        return f"{float(value):.3g}"
    except ValueError:
        return plain(value, LONGEST_TEXT)
