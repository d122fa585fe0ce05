# SPDX-License-Identifier: Apache-2.0
"""The time series: names and colours of each entity's values, in order; the attitude without jumps.

Paths are those of entities.py; next come a new curve's values, in recording/loggers.py.
"""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import colours

_ONE, _TWO, _THREE = colours.AXIS

SERIES = {  # entity: (name, colour) of each value
    entities.POSITION: (("x [m]", _ONE), ("y [m]", _TWO), ("z [m]", _THREE)),
    entities.ORIENTATION: (("x", _ONE), ("y", _TWO), ("z", _THREE), ("w", colours.GREY)),
    entities.ATTITUDE: (("heading", _THREE), ("pitch", _TWO), ("roll", _ONE)),
    entities.LINEAR: (("x", _ONE), ("y", _TWO), ("z", _THREE)),
    entities.ANGULAR: (("x", _ONE), ("y", _TWO), ("z", _THREE)),
    entities.SPEED: (("speed [m/s]", colours.PLAIN),),
    entities.DEPTH: (("depth [m]", colours.PLAIN),),
    entities.POWER: (
        ("actuators", colours.ACTUATORS),
        ("wake", colours.WAKE),
        ("nose", colours.ENDS),
        ("drag", colours.FORCE),
    ),
    entities.POWER_BESIDES: (("flow", colours.FLOW), ("fins", colours.FIN), ("dampers", colours.SPRINGS)),
    entities.KINETIC: (("body", colours.PLAIN), ("water", colours.FORCE)),
    entities.STORED: (("weight", colours.FLOW), ("springs", colours.SPRINGS)),
    entities.RESIDUAL: (("residual [J]", colours.PLAIN),),
}


def log_styles(stream: BatchedStream) -> None:
    """Log names, colours and widths of all lines, valid at all times."""
    for path, lines in SERIES.items():
        names, shades = zip(*lines, strict=True)
        stream.log_static(path, rr.SeriesLines(names=names, colors=shades, widths=[1.5] * len(names)))


class Attitude:
    """Heading, pitch and roll; heading and roll continue over whole turns, without jumps of 360 degrees."""

    def __init__(self) -> None:
        self._last: np.ndarray | None = None  # deg, (3,)

    def continued(self, angles: tuple[float, float, float]) -> np.ndarray:
        """Heading, pitch and roll [deg], (3,), from those of `attitude` [rad]."""
        degrees = np.degrees(angles)
        if self._last is not None:
            degrees -= 360.0 * np.round((degrees - self._last) / 360.0)
        self._last = degrees
        return degrees
