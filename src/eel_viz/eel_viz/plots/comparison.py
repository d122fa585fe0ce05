# SPDX-License-Identifier: Apache-2.0
"""Compares two runs: draws the other run over this one, and plots their differences.

The other swimmer is drawn as hoops around this one, so that both stay visible where they coincide. A difference is this
run's value minus the other's, at this run's stamps and stations (see `pairs`).
"""

import numpy as np

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Body, Pose, Profiles, Twist
from eel_viz.plots.pairs import Pairs, Stamped
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.state_text import Summary, number, quantity
from eel_viz.scene3d import colours
from eel_viz.scene3d.camera import FollowFrame
from eel_viz.scene3d.skin import Skin
from eel_viz.scene3d.swimmer_scene import log_frame
from eel_viz.scene3d.water import WaterBox

HOOPS, SIDES = 24, 16
FIRST_HOOP = 3  # earlier ones, at the nose, are too dense
SUMMARY_PERIOD = 200_000_000  # ns


class Comparison:
    """`this` and `other` take the messages of the two runs, through the methods of `Loggers`.

    names: of this run and the other. limit: of the torque plot [N m].
    """

    def __init__(self, stream: BatchedStream, *, names: tuple[str, str], limit: float) -> None:
        self._stream, self._names = stream, names
        self._heads, self._torques = Pairs(), Pairs()
        self.this, self.other = Side(self, stream), OtherSide(self, stream)
        self._both = ProfilePlot(
            stream,
            entities.COMPARED_TORQUE,
            names=tuple(f"C3 {name}" for name in names[::-1]),  # the other below
            unit="N m",
            limit=limit,
            palette=(colours.OTHER, colours.AXIS[2]),
            widths=(2.6, 1.2),
            envelope_period=None,
        )
        self._difference = ProfilePlot(
            stream,
            entities.TORQUE_DIFFERENCE,
            names=("C1", "C2", "C3"),
            unit="N m",
            limit=0.0,
            envelope_period=stream.drawing_period,
        )
        self._farthest = self._worst = self._greatest = 0.0  # m, N m, N m
        self._frame, self._water = FollowFrame(), WaterBox(stream, entities.BOTH_WATER)
        for path, name, colour in (
            (entities.OTHER_SPEED, f"{names[1]} [m/s]", colours.AXIS[0]),
            (entities.DISTANCE, "distance [m]", colours.PLAIN),
            (entities.TORQUE_DIFFERENCE_MOST, "greatest over X [N m]", colours.PLAIN),
        ):
            stream.log_series_style(path, [name], [colours.curve(colour)])

    def add_head(self, side: "Side", stamp: int, position: np.ndarray) -> None:
        """Take a head's position (3,) [m]; log the distance between the two heads for each complete pair."""
        for pair in self._heads.add(Stamped(stamp, position), of_other=side is self.other):
            distance = float(np.linalg.norm(pair.this - pair.other))
            self._farthest = max(self._farthest, distance)
            self.this.add_position(pair.stamp, pair.this)
            if self.other.add_position(pair.stamp, pair.other):
                self._write(pair.stamp)
            self._stream.add_scalars(pair.stamp, entities.DISTANCE, [distance])

    def add_torque(self, side: "Side", stamp: int, wrench: Profiles) -> None:
        """Take torques; log C3 of both runs and the differences of C1, C2, C3 [N m] for each complete pair."""
        torque = wrench.together("torque_1", "torque_2", "torque_3")
        for at, x, this, other in self._torques.add(Stamped(stamp, torque, wrench.x), of_other=side is self.other):
            assert x is not None  # torques have stations
            difference = this - other
            self._both.add(at, x, np.stack([other[:, 2], this[:, 2]], axis=1))
            self._difference.add(at, x, difference)
            most = float(np.abs(difference).max())
            self._worst = max(self._worst, most)
            self._greatest = max(self._greatest, float(np.abs(this).max()))
            self.this.add_torque(at, x, this[:, 2])
            if self.other.add_torque(at, x, other[:, 2]):
                self._write(at)
            self._stream.add_scalars(at, entities.TORQUE_DIFFERENCE_MOST, [most])

    def move_camera(self, stamp: int) -> None:
        """Keep both swimmers in the picture at `stamp` [ns], the other at its last place."""
        last = [side.line for side in (self.this, self.other) if side.line is not None]
        positions = np.concatenate([backbone.position for backbone in last])
        body_length = max(float(backbone.x[-1] - backbone.x[0]) for backbone in last)
        centre, radius = self._frame.follow(stamp, positions, body_length)
        log_frame(self._stream, stamp, entities.BOTH, centre, radius)
        self._water.draw(stamp, centre, radius)

    def _write(self, stamp: int) -> None:
        if self._stream.due("compared", stamp, SUMMARY_PERIOD):
            self._stream.log_text(stamp, entities.COMPARE_TEXT, self._text())

    def _text(self) -> str:
        """Markdown: the greatest differences, and the figures of both runs side by side."""
        columns = [side.figures() for side in (self.this, self.other)]
        lines = [f"heads apart by at most **{quantity(self._farthest, 'm')}** so far  "]
        if self._greatest:
            share = number(100.0 * self._worst / self._greatest)
            lines.append(f"torques by at most **{quantity(self._worst, 'N m')}**, {share} % of the greatest")
        lines += ["", f"| | {self._names[0]} | {self._names[1]} |", "|---|---|---|"]
        for key in columns[1] | columns[0]:
            lines.append(f"| {key} | " + " | ".join(column.get(key, "") for column in columns) + " |")
        return "\n".join(lines)


class Side(Summary):
    """Takes the messages of one run. The rest of the recording shows it."""

    def __init__(self, comparison: Comparison, stream: BatchedStream) -> None:
        super().__init__()
        self._comparison, self._stream = comparison, stream
        self.line: Backbone | None = None  # the last backbone

    def head_pose(self, stamp: int, pose: Pose) -> None:
        self._comparison.add_head(self, stamp, pose.position)

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        self._comparison.add_torque(self, stamp, wrench)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Take the line, and move the camera."""
        self.line = backbone
        if self._stream.drawing_due("both", stamp):
            self._comparison.move_camera(stamp)


class OtherSide(Side):
    """Takes the messages of the other run, and draws it."""

    def __init__(self, comparison: Comparison, stream: BatchedStream) -> None:
        super().__init__(comparison, stream)
        self._skin: Skin | None = None
        for path in (entities.OTHER_HOOPS, entities.OTHER_BACKBONE):
            stream.log_line_style(path, colours.OTHER, width=0.8)

    def body(self, stamp: int, body: Body) -> None:
        """Take the sections, for the hoops."""
        super().body(stamp, body)
        self._skin = Skin(body.x, body.half_width, body.half_height, rings=HOOPS, sides=SIDES)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """Log the speed [m/s]."""
        self._stream.add_scalars(stamp, entities.OTHER_SPEED, [np.linalg.norm(twist.linear)])

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        self.line = backbone
        if not self._stream.drawing_due("other", stamp):
            return
        self._stream.add_lines(stamp, entities.OTHER_BACKBONE, backbone.position[None])
        if self._skin is not None:
            vertices, _ = self._skin.place(backbone.x, backbone.position, backbone.orientation)
            rings = vertices.reshape(HOOPS, SIDES, 3)[FIRST_HOOP:]
            self._stream.add_lines(stamp, entities.OTHER_HOOPS, np.concatenate([rings, rings[:, :1]], axis=1))
