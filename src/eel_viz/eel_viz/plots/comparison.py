# SPDX-License-Identifier: Apache-2.0
"""Compares two runs: draws the other run over this one, and plots their differences.

The other swimmer is drawn as hoops around this one, so that both can be seen where they coincide. A difference is this
run's value minus the other's, at this run's stamps and stations (see `pairs`).
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Body, Pose, Profiles, Status, Twist
from eel_viz.plots.pairs import Pairs
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.readable import number, quantity
from eel_viz.plots.state_text import Summary
from eel_viz.scene3d import colours
from eel_viz.scene3d.camera import FollowFrame
from eel_viz.scene3d.skin import Skin
from eel_viz.scene3d.swimmer_scene import log_frame
from eel_viz.scene3d.water import WaterBox

HOOPS, SIDES = 24, 16
SUMMARY_PERIOD = 200_000_000  # ns

Due = Callable[[str, int, int], bool]


class Comparison:
    """`this` and `other` log the messages of the two runs, by the methods of `Loggers`.

    names: of this run and the other. limit: of the torque plot [N m]. due(what, stamp, period): whether `what` is to be
    logged at `stamp` [ns]. drawings: the period of drawings [ns].
    """

    def __init__(self, stream: BatchedStream, *, names: tuple[str, str], limit: float, due: Due, drawings: int):
        self._stream, self._due, self._drawings, self.names = stream, due, drawings, names
        self._heads, self._torques = Pairs(), Pairs()
        self.this = ThisSide(self, lambda stamp: due("both", stamp, drawings))
        self.other = OtherSide(self, stream, lambda stamp: due("other", stamp, drawings))
        self._both = ProfilePlot(
            stream,
            entities.COMPARED_TORQUE,
            names=tuple(f"C3 {name}" for name in names[::-1]),  # the other below
            unit="N m",
            limit=limit,
            palette=(colours.AMBER, colours.AXIS[2]),
            widths=(2.6, 1.2),
        )
        self._difference = ProfilePlot(
            stream,
            entities.TORQUE_DIFFERENCE,
            names=("C1", "C2", "C3"),
            unit="N m",
            limit=0.0,
        )
        self._farthest = self._worst = self._greatest = 0.0
        self._frame, self._water = FollowFrame(), WaterBox(stream, entities.BOTH_WATER)
        for path, name, colour in (
            (entities.OTHER_SPEED, f"{names[1]} [m/s]", colours.AMBER),
            (entities.DISTANCE, "distance [m]", colours.MAGENTA),
            (entities.TORQUE_DIFFERENCE_MOST, "greatest over X [N m]", colours.MAGENTA),
        ):
            stream.log_static(path, rr.SeriesLines(names=[name], colors=[colour], widths=[1.5]))

    def heads(self, pairs: list[tuple]) -> None:
        """Log the distance between the two heads for each complete pair of positions, (3,) [m]."""
        for stamp, _, this, other in pairs:
            self.this.summary.add_position(stamp, this)
            self.other.summary.add_position(stamp, other)
            if self._due("compared", stamp, SUMMARY_PERIOD):
                self._stream.log(stamp, entities.COMPARE_TEXT, rr.TextDocument(self.text(), media_type="text/markdown"))
            distance = float(np.linalg.norm(this - other))
            self._farthest = max(self._farthest, distance)
            self._stream.add_scalars(stamp, entities.DISTANCE, [distance])

    def move_camera(self, stamp: int) -> None:
        """Keep both swimmers in the picture, at `stamp` [ns]; the other at its last place."""
        last = [side.line for side in (self.this, self.other) if side.line is not None]
        positions = np.concatenate([backbone.position for backbone in last])
        body_length = max(float(backbone.x[-1] - backbone.x[0]) for backbone in last)
        frame = self._frame.follow(stamp, positions, body_length)
        log_frame(self._stream, stamp, entities.BOTH, *frame)
        self._water.draw(stamp, *frame, positions)

    def torques(self, pairs: list[tuple]) -> None:
        """Log C3 of both runs and the differences of C1, C2, C3 for each complete pair of torques, (M, 3) [N m]."""
        for stamp, x, this, other in pairs:
            self.this.summary.add_torque(stamp, x, this[:, 2])
            self.other.summary.add_torque(stamp, x, other[:, 2])
            difference = this - other
            both = np.stack([other[:, 2], this[:, 2]], axis=1)
            self._both.include(x, both)
            self._difference.include(x, difference)
            most = float(np.abs(difference).max())
            self._worst = max(self._worst, most)
            self._greatest = max(self._greatest, float(np.abs(this).max()))
            self._stream.add_scalars(stamp, entities.TORQUE_DIFFERENCE_MOST, [most])
            if self._due("compared torque", stamp, self._drawings):
                self._both.draw(stamp, x, both)
                self._difference.draw(stamp, x, difference)
                self._difference.draw_envelope(stamp)

    def text(self) -> str:
        """Markdown: the greatest differences, and the figures of both runs side by side."""
        columns = [side.summary.figures() for side in (self.this, self.other)]
        lines = [f"heads apart by at most **{quantity(self._farthest, 'm')}** so far  "]
        if self._greatest:
            share = number(100.0 * self._worst / self._greatest)
            lines.append(f"torques by at most **{quantity(self._worst, 'N m')}**, {share} % of the greatest")
        lines += ["", f"| | {self.names[0]} | {self.names[1]} |", "|---|---|---|"]
        for key in columns[1] | columns[0]:
            lines.append(f"| {key} | " + " | ".join(column.get(key, "") for column in columns) + " |")
        return "\n".join(lines)


class Side(ABC):
    """The messages that are logged alike for both runs."""

    def __init__(self, comparison: Comparison) -> None:
        self._comparison = comparison
        self.summary = Summary()
        self.line: Backbone | None = None  # the last backbone

    def body(self, stamp: int, body: Body) -> None:
        """Take the body."""
        self.summary.body = body

    def curvature_law(self, stamp: int, name: str) -> None:
        """Take the law's name."""
        self.summary.law = name

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Take the values of the statuses."""
        for status in statuses:
            self.summary.add_status(stamp, status.message, status.values)

    def head_pose(self, stamp: int, pose: Pose) -> None:
        """Take the head's position."""
        self._comparison.heads(self._pair(self._comparison._heads, stamp, pose.position))

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """Take the torques."""
        torque = wrench.together("torque_1", "torque_2", "torque_3")
        self._comparison.torques(self._pair(self._comparison._torques, stamp, torque, wrench.x))

    @abstractmethod
    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        """Add a sample of this side; returns the complete pairs."""


class ThisSide(Side):
    """The run that the rest of the recording shows."""

    def __init__(self, comparison: Comparison, due: Callable[[int], bool]) -> None:
        super().__init__(comparison)
        self._due = due

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Take the line, and move the camera."""
        self.line = backbone
        if self._due(stamp):
            self._comparison.move_camera(stamp)

    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        return pairs.add_this(*sample)


class OtherSide(Side):
    """The other run, which is drawn here."""

    def __init__(self, comparison: Comparison, stream: BatchedStream, due: Callable[[int], bool]) -> None:
        super().__init__(comparison)
        self._stream, self._due = stream, due
        self._skin: Skin | None = None
        shade = [colours.AMBER]
        thin: Any = [rr.Radius.ui_points(0.8)]
        for path in (entities.OTHER_HOOPS, entities.OTHER_BACKBONE):
            stream.log_static(path, rr.LineStrips3D.from_fields(colors=shade, radii=thin))

    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        return pairs.add_other(*sample)

    def body(self, stamp: int, body: Body) -> None:
        """Take the sections, for the hoops."""
        super().body(stamp, body)
        self._skin = Skin(body.x, body.half_width, body.half_height, rings=HOOPS, sides=SIDES)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """Log the speed [m/s]."""
        self._stream.add_scalars(stamp, entities.OTHER_SPEED, [np.linalg.norm(twist.linear)])

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Log line and hoops."""
        self.line = backbone
        if not self._due(stamp):
            return
        line = backbone.position[None].astype(np.float32)
        self._stream.add_row(stamp, entities.OTHER_BACKBONE, rr.LineStrips3D, strips=line)
        if self._skin is not None:
            vertices, _ = self._skin.place(backbone.x, backbone.position, backbone.orientation)
            rings = vertices.reshape(HOOPS, SIDES, 3)[3:]  # those at the nose are too dense
            self._stream.add_row(
                stamp, entities.OTHER_HOOPS, rr.LineStrips3D, strips=np.concatenate([rings, rings[:, :1]], axis=1)
            )
