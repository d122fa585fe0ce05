"""The state of a run in a few lines of text: what a viewer wants to know before trusting the picture.

Everything comes from messages: the path from head_pose, the torque from internal_wrench, the rest from diagnostics.
"""

import numpy as np

from eel_viz.messages import Body

TOLD = {  # keys of the diagnostics, and the words for them
    "warnings": "**warnings:**",
    "accuracy": "accuracy",
    "real_time_factor": "real-time factor",
    "closure_torque_relative": "closure",
    "energy_residual_worst": "worst residual [J]",
}


class Summary:
    """Collects, and writes Markdown."""

    def __init__(self) -> None:
        self.law: str | None = None
        self.body: Body | None = None
        self.state = ""  # in the diagnostics' words
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
            _, self.state, values = self._statuses.pop(0)
            self.values.update(values)
            taken = True
        return taken

    @property
    def stamp(self) -> int:
        """Time of the head's last position [ns]."""
        return 0 if self._last is None else self._last[0]

    def text(self) -> str:
        """Markdown, one paragraph a line."""
        law = "" if self.law is None else f"law **{self.law}**"
        lines = [", ".join(part for part in (law, self.state) if part)]
        if self._last is not None and self._first is not None:
            seconds = (self._last[0] - self._first[0]) / 1e9
            mean = self._path / seconds if seconds > 0 else 0.0
            lines.append(f"mean speed **{mean:.3f} m/s**, path {self._path:.2f} m")
        torque, x, stamp = self._peak
        if torque:
            lines.append(f"greatest C3 **{torque:+.3f} N m** at X {x:.2f} m, {stamp / 1e9:.2f} s")
        lines.append(
            ", ".join(f"{words} {_short(self.values[key])}" for key, words in TOLD.items() if self.values.get(key))
        )
        if self.body is not None:
            lines.append(f"body {self.body.length:.3g} m, {self.body.mass:.4g} kg")
        return "\n\n".join(line for line in lines if line)


def _short(value: str) -> str:
    """Numbers to three digits; words as they are."""
    try:
        return f"{float(value):.3g}"
    except ValueError:
        return value
