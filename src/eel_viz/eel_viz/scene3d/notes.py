# SPDX-License-Identifier: Apache-2.0
"""Says in the scene what a still picture cannot show: where the swimmer swims and how fast, and its greatest torque."""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.lettering import standing_texts

PERIOD = 400_000_000  # ns: words that changed faster could not be read
LETTERS = 0.043  # height of a capital [radii]
AHEAD = (0.06, 0.22)  # from head to begin and end of the arrow [body lengths]
NEARER = 0.25
SLOW = 0.01  # body lengths per second, below which no direction is shown
NAME = "greatest torque C3 in 3 s"
ABOVE, BESIDE = 0.28, 0.12  # of the words over the body, and over the arrow [radii]


class Notes:
    """Draws the arrow ahead of the head with the head's speed, and the greatest torque C3 at its place.

    Attributes:
        speed: of the head [m/s]. peak: place [m] and size [N m] of the greatest C3. None: not known.
    """

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self.speed: float | None = None
        self.peak: tuple[float, float] | None = None
        self._words: dict[str, tuple[str, int]] = {}  # and when they were written [ns]
        stream.log_static(entities.HEADING, rr.Arrows3D.from_fields(colors=[colours.NOTE], radii=[0.004]))
        leader = [[0.05 * camera.UP, (ABOVE - 1.2 * LETTERS) * camera.UP]]
        line = rr.LineStrips3D(leader, colors=[colours.NOTE], radii=rr.Radius.ui_points(0.5))
        stream.log_static(f"{entities.TORQUE_NOTE}/line", line)
        stream.log_static(f"{entities.TORQUE_NOTE}/name", _written(NAME, 1.25 * ABOVE))

    def draw(self, stamp: int, backbone: Backbone, velocity: np.ndarray, frame: tuple[np.ndarray, float]) -> None:
        """Draw at `stamp` [ns]. velocity: of the whole swimmer, (3,) [m/s]. frame: the camera's."""
        length, speed = float(backbone.x[-1] - backbone.x[0]), float(np.linalg.norm(velocity))
        if self.speed is not None and speed > SLOW * length:
            begin, end = (backbone.position[0] + share * length / speed * velocity for share in AHEAD)
            ends = {"origins": begin[None].astype(np.float32), "vectors": (end - begin)[None].astype(np.float32)}
            self._stream.add_row(stamp, entities.HEADING, rr.Arrows3D, **ends)
            self._write(stamp, entities.SPEED_NOTE, f"{self.speed:.2f} m/s", end, frame, BESIDE)
        if self.peak is not None and self.peak[1] > 0.0:
            x, torque = self.peak
            place = np.array([np.interp(x, backbone.x, column) for column in backbone.position.T])
            words = f"{torque:.2g} N m at X = {x:.2f} m"
            self._write(stamp, entities.TORQUE_NOTE, words, place, frame, ABOVE)

    def _write(
        self, stamp: int, path: str, words: str, place: np.ndarray, frame: tuple[np.ndarray, float], above: float
    ) -> None:
        """Move the `words` before `place` (3,) [m]; log their letters if they are new, `above` [radii] it.

        They are nearer to the eye by the share `NEARER`, and smaller, so that the body does not hide them.
        """
        centre, radius = frame
        near = place + NEARER * (centre + radius * camera.EYE - place)
        scale = np.full((1, 3), (1.0 - NEARER) * radius, dtype=np.float32)
        self._stream.add_row(stamp, path, rr.Transform3D, translation=near[None], scale=scale)
        written, when = self._words.get(path, ("", stamp - PERIOD))
        if words != written and stamp - when >= PERIOD:
            self._words[path] = words, stamp
            self._stream.log(stamp, f"{path}/words", _written(words, above))


def _written(words: str, above: float) -> rr.LineStrips3D:
    return standing_texts([above * camera.UP], [words], LETTERS * camera.RIGHT, LETTERS * camera.UP, [colours.NOTE])
