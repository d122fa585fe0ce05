# SPDX-License-Identifier: Apache-2.0
"""Notes in the scene on what a still picture cannot show: the swimmer's direction and speed."""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone
from eel_viz.same_stamp import SameStamp
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.lettering import standing_texts

PERIOD = 400_000_000  # ns: a number that changed faster could not be read
LETTERS = 0.043  # height of a capital [radii]
AHEAD = (0.06, 0.26)  # from head to begin and end of the arrow [body lengths]
THICK = 0.007  # radius of the arrow [body lengths]
NEARER = 0.25
SLOW = 0.01  # body lengths per second, below which no direction is shown
ABOVE = 0.12  # of the words over the arrow [radii]
Frame = tuple[np.ndarray, float]  # centre (3,) and radius [m] of what the camera sees


class Notes:
    """Draws the arrow ahead of the head with the head's speed, once both messages of a stamp are there."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._heading = SameStamp(self._draw_heading)
        self._words, self._written = "", -PERIOD  # and when they were written [ns]
        self.fit(1.0)

    def fit(self, length: float) -> None:
        """Fit the arrow to a body of `length` [m]."""
        style = rr.Arrows3D.from_fields(colors=[colours.NOTE], radii=[THICK * length])
        self._stream.log_static(entities.HEADING, style)

    def body(self, stamp: int, backbone: Backbone, velocity: np.ndarray, frame: Frame) -> None:
        """Take the body at `stamp` [ns]. velocity: of the whole swimmer, (3,) [m/s]. frame: the camera's."""
        self._heading.first(stamp, (backbone, velocity, frame))

    def speed(self, stamp: int, speed: float) -> None:
        """Take the head's speed [m/s] at `stamp` [ns]."""
        self._heading.second(stamp, speed)

    def _draw_heading(self, stamp: int, body: tuple[Backbone, np.ndarray, Frame], head_speed: float) -> None:
        backbone, velocity, frame = body
        length, speed = float(backbone.x[-1] - backbone.x[0]), float(np.linalg.norm(velocity))
        if speed > SLOW * length:
            begin, end = (backbone.position[0] + share * length / speed * velocity for share in AHEAD)
            ends = {"origins": begin[None].astype(np.float32), "vectors": (end - begin)[None].astype(np.float32)}
            self._stream.add_row(stamp, entities.HEADING, rr.Arrows3D, **ends)
            self._write(stamp, f"head {head_speed:.2f} m/s", end, frame)

    def _write(self, stamp: int, words: str, place: np.ndarray, frame: Frame) -> None:
        """Move the `words` before `place` (3,) [m]; log their letters if they are new, and were not just written.

        They are nearer to the eye by the share `NEARER`, and smaller, so that the body does not hide them.
        """
        centre, radius = frame
        near = place + NEARER * (centre + radius * camera.EYE - place)
        scale = np.full((1, 3), (1.0 - NEARER) * radius, dtype=np.float32)
        self._stream.add_row(stamp, entities.SPEED_NOTE, rr.Transform3D, translation=near[None], scale=scale)
        if words != self._words and not 0 <= stamp - self._written < PERIOD:
            self._words, self._written = words, stamp
            across, up = LETTERS * camera.RIGHT, LETTERS * camera.UP
            letters = standing_texts([ABOVE * camera.UP], [words], across, up, [colours.NOTE])
            self._stream.log(stamp, f"{entities.SPEED_NOTE}/words", letters)
