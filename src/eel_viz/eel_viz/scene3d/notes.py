# SPDX-License-Identifier: Apache-2.0
"""Notes in the scene on what a still picture cannot show: the swimmer's direction and speed, and its greatest
torque."""

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
NEARER = 0.25
SLOW = 0.01  # body lengths per second: below this no direction is shown
NAME = "greatest torque |C3| in 3 s"
ABOVE, BESIDE = 0.28, 0.12  # distances of the words from the body, and from the arrow [radii]
Frame = tuple[np.ndarray, float]  # centre (3,) and radius [m] of the camera's frame


class Notes:
    """Draws the arrow ahead of the head with the head's speed, and the greatest torque C3 at its place.

    Body, speed and torque come in separate messages. A note is drawn when both of its messages of a stamp have come.
    """

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._heading = SameStamp(self._draw_heading)
        self._torque = SameStamp(self._draw_torque)
        self._words: dict[str, tuple[str, int]] = {}  # words, and their time [ns]
        stream.log_static(entities.HEADING, rr.Arrows3D.from_fields(colors=[colours.NOTE], radii=[0.007]))
        leader = [[0.05 * camera.UP, (ABOVE - 1.2 * LETTERS) * camera.UP]]
        line = rr.LineStrips3D(leader, colors=[colours.NOTE], radii=rr.Radius.ui_points(0.5))
        stream.log_static(f"{entities.TORQUE_NOTE}/line", line)
        stream.log_static(f"{entities.TORQUE_NOTE}/name", _written(NAME, 1.25 * ABOVE))

    def body(self, stamp: int, backbone: Backbone, velocity: np.ndarray, frame: Frame) -> None:
        """Take the body at `stamp` [ns]. velocity: of the whole swimmer, (3,) [m/s]. frame: the camera's."""
        self._heading.first(stamp, (backbone, velocity, frame))
        self._torque.first(stamp, (backbone, frame))

    def speed(self, stamp: int, speed: float) -> None:
        """Take the head's speed [m/s] at `stamp` [ns]."""
        self._heading.second(stamp, speed)

    def peak(self, stamp: int, place: float, size: float) -> None:
        """Take the greatest C3 of the last seconds, its place [m] and its magnitude [N m], at `stamp` [ns]."""
        self._torque.second(stamp, (place, size))

    def _draw_heading(self, stamp: int, body: tuple[Backbone, np.ndarray, Frame], head_speed: float) -> None:
        backbone, velocity, frame = body
        length, speed = float(backbone.x[-1] - backbone.x[0]), float(np.linalg.norm(velocity))
        if speed > SLOW * length:
            begin, end = (backbone.position[0] + share * length / speed * velocity for share in AHEAD)
            ends = {"origins": begin[None].astype(np.float32), "vectors": (end - begin)[None].astype(np.float32)}
            self._stream.add_row(stamp, entities.HEADING, rr.Arrows3D, **ends)
            words = f"head {head_speed:.2f} m/s"
            self._write(stamp, entities.SPEED_NOTE, words, end, frame, above=BESIDE, period=PERIOD)

    def _draw_torque(self, stamp: int, body: tuple[Backbone, Frame], peak: tuple[float, float]) -> None:
        (backbone, frame), (x, torque) = body, peak
        if torque > 0.0:
            place = np.array([np.interp(x, backbone.x, column) for column in backbone.position.T])
            words = f"{torque:.2g} N m at X = {x:.2f} m"
            self._write(stamp, entities.TORQUE_NOTE, words, place, frame, above=ABOVE, period=0)

    def _write(
        self, stamp: int, path: str, words: str, place: np.ndarray, frame: Frame, *, above: float, period: int
    ) -> None:
        """Move the `words` in front of `place` (3,) [m]. New words are logged as letters, `above` [radii] it.

        period: least time [ns] between two changes of the words.

        They are nearer to the eye by the share `NEARER`, and smaller, so that the body does not hide them.
        """
        centre, radius = frame
        near = place + NEARER * (centre + radius * camera.EYE - place)
        scale = np.full((1, 3), (1.0 - NEARER) * radius, dtype=np.float32)
        self._stream.add_row(stamp, path, rr.Transform3D, translation=near[None], scale=scale)
        written, when = self._words.get(path, ("", stamp - period))
        if words != written and stamp - when >= period:
            self._words[path] = words, stamp
            self._stream.log(stamp, f"{path}/words", _written(words, above))


def _written(words: str, above: float) -> rr.LineStrips3D:
    return standing_texts([above * camera.UP], [words], LETTERS * camera.RIGHT, LETTERS * camera.UP, [colours.NOTE])
