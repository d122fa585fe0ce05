# SPDX-License-Identifier: Apache-2.0
"""The texts of a recording: what to look at, the run's summary, its log; and the properties of the recording."""

import reprlib

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Body, Pose, Profiles, Status
from eel_viz.plots.state_text import Summary
from eel_viz.recording.destination import send_properties
from eel_viz.settings import Settings

SHORT = reprlib.Repr()
SHORT.maxstring = 220  # characters of a law's name, which is unchecked
LEVELS = ("INFO", "WARN", "ERROR", "WARN")  # for the levels of a DiagnosticStatus: OK, WARN, ERROR, STALE


class RunText(Summary):
    """Logs to `stream`, through the methods of topics, and sends properties to its `recording`."""

    def __init__(self, recording: rr.RecordingStream, stream: BatchedStream, settings: Settings) -> None:
        super().__init__()
        self._recording, self._stream, self._settings = recording, stream, settings
        self._statuses_said: dict[str, tuple[int, str]] = {}  # level and message, by name
        self._looked: tuple[Body | None, bool] = (None, False)  # the body, and whether the water moves
        self._log_look()

    def body(self, stamp: int, body: Body) -> None:
        super().body(stamp, body)
        self._looked = body, self._looked[1]
        if body.fins or body.joints:
            self._log_look()
        send_properties(self._recording, "body", {"length": float(body.length), "mass": float(body.mass)})

    def flow_vectors(self, stamp: int, position: np.ndarray, velocity: np.ndarray) -> None:
        if not self._looked[1]:
            self._looked = self._looked[0], True
            self._log_look()

    def head_pose(self, stamp: int, pose: Pose) -> None:
        if self.add_position(stamp, pose.position):
            self._write_if_due(stamp)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        if self.add_torque(stamp, wrench.x, wrench.values["torque_3"]):
            self._write_if_due(stamp)

    def curvature_law(self, stamp: int, name: str) -> None:
        """Log the name of the published law."""
        super().curvature_law(stamp, name)
        send_properties(self._recording, "swim", {"gait": SHORT.repr(name).strip("'")})
        self._log_event(stamp, f"law {SHORT.repr(name)} published", "INFO")

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Log each status whose level or message has changed. The values go into the summary."""
        for status in statuses:
            if self.add_status(stamp, status.message, status.values):
                self._write()
            if self._statuses_said.get(status.name) != (status.level, status.message):
                self._statuses_said[status.name] = (status.level, status.message)
                self._log_event(stamp, f"{status.name}: {status.message}", LEVELS[min(status.level, len(LEVELS) - 1)])

    def finish(self) -> None:
        """Send the last diagnostics, before the recording is closed."""
        if self.values:
            send_properties(self._recording, "diagnostics", self.numbers())

    def _log_look(self) -> None:
        text = look_text(self._settings, *self._looked)
        self._stream.log_static(entities.LOOK, rr.TextDocument(text, media_type="text/markdown"))

    def _log_event(self, stamp: int, text: str, level: str) -> None:
        self._stream.log(stamp, entities.LOG, rr.TextLog(text, level=level))

    def _write_if_due(self, stamp: int) -> None:
        if self._stream.drawing_due("summary", stamp):
            self._write()

    def _write(self) -> None:
        self._stream.log_text(self.stamp, entities.RUN, self.text())


def look_text(settings: Settings, body: Body | None = None, flow: bool = False) -> str:
    """Markdown: what to look at, one sentence each, with the scales of the arrows and the parts that `body` has.

    flow: whether arrows show moving water."""
    scale = f"up to {settings.colour_limit:g} N m" if settings.colour_limit else "of the last 3 s"
    lines = [
        "Eyes show its head, the white arrow where it moves, the grey line the path of its head.",
        f"Red and blue on its flanks: the torque **C3** that bends it sideways, on the scale {scale} below the picture "
        "(C1 twists, C2 bends it up and down).",
        f"Arrows: the **force of the water**, {settings.load_scale:g} m for 1 N/m; magenta at nose and tail, "
        f"{settings.end_force_scale:g} m for 1 N. Violet ribbon: what the tail leaves in the **wake**.",
    ]
    parts = {
        "Lime: **fins**.": body and body.fins,
        "Rings: **joints**, the whiter, the more the motor gives (tab *robot*).": body and body.joints,
    }
    water = "Pale blue arrows: how the **water** moves without the swimmer; the legend tells the longest."
    lines.append(" ".join(text for text, there in (parts | {water: flow}).items() if there))
    return "  \n".join(line for line in lines if line)
