# SPDX-License-Identifier: Apache-2.0
"""The curves over time: names and colours of each entity's values, in order, and the values.

Paths are in entities.py.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from eel_common.attitude import attitude

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Pose, Twist
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
        ("actuators", colours.deep(colours.ACTUATORS)),
        ("wake", colours.WAKE),
        ("nose", colours.ENDS),
        ("drag", colours.FORCE),
    ),
    entities.POWER_BESIDES: (
        ("flow", colours.deep(colours.FLOW)),
        ("fins", colours.FIN),
        ("dampers", colours.deep(colours.SPRINGS)),
        ("appendages", colours.APPENDAGE),
        ("outside", colours.EXTERNAL),
    ),
    entities.KINETIC: (("body", colours.PLAIN), ("water", colours.FORCE)),
    entities.STORED: (("weight", colours.FLOW), ("springs", colours.SPRINGS)),
    entities.RESIDUAL: (("residual [J]", colours.PLAIN),),
}


BESIDES = {  # curves that begin with the first non-zero value
    entities.POWER_BESIDES: ("flow_power", "fins_power", "damping_power", "appendages_power", "external_power"),
    entities.STORED: ("potential", "elastic"),
}


def log_styles(stream: BatchedStream, series: Mapping[str, Sequence[tuple[str, colours.Colour]]]) -> None:
    """Log name and colour of each curve of `series`, by the path; colours fit the light theme and the dark one."""
    for path, lines in series.items():
        stream.log_series_style(path, [name for name, _ in lines], [colours.curve(colour) for _, colour in lines])


class Series:
    """Logs the head's motion and the energy ledger, through the methods of topics, in double precision."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._attitude = Attitude()
        self._besides: set[str] = set()  # paths of `BESIDES` with lines
        log_styles(stream, SERIES)

    def head_pose(self, stamp: int, pose: Pose) -> None:
        if self._stream.number_due("head_pose", stamp):
            scalars = self._stream.add_scalars
            scalars(stamp, entities.POSITION, pose.position)
            scalars(stamp, entities.ORIENTATION, pose.orientation)
            scalars(stamp, entities.ATTITUDE, self._attitude.continued(attitude(pose.orientation.tolist())))
            scalars(stamp, entities.DEPTH, -pose.position[2:])

    def head_twist(self, stamp: int, twist: Twist) -> None:
        if self._stream.number_due("head_twist", stamp):
            self._stream.add_scalars(stamp, entities.SPEED, [np.linalg.norm(twist.linear)])
            self._stream.add_scalars(stamp, entities.LINEAR, twist.linear)
            self._stream.add_scalars(stamp, entities.ANGULAR, twist.angular)

    def energy(self, stamp: int, energy: dict[str, float]) -> None:
        """Log the terms of the energy ledger [W], [J]."""
        if self._stream.number_due("energy", stamp):
            powers = [energy[f"{name}_power"] for name in ("actuator", "wake", "nose", "drag")]
            self._stream.add_scalars(stamp, entities.POWER, powers)
            self._stream.add_scalars(stamp, entities.KINETIC, [energy["kinetic_body"], energy["kinetic_fluid"]])
            self._stream.add_scalars(stamp, entities.RESIDUAL, [energy["residual"]])
            for path, names in BESIDES.items():
                values = [energy[name] for name in names]
                if any(values) or path in self._besides:  # a swim without fins has no line for them
                    self._besides.add(path)
                    self._stream.add_scalars(stamp, path, values)


class Attitude:
    """Heading, pitch and roll. Heading and roll continue over whole turns, without jumps of 360 degrees."""

    def __init__(self) -> None:
        self._last: np.ndarray | None = None  # deg, (3,)

    def continued(self, angles: tuple[float, float, float]) -> np.ndarray:
        """Heading, pitch and roll [deg], (3,), from those of `attitude` [rad]."""
        degrees = np.degrees(angles)
        if self._last is not None:
            degrees -= 360.0 * np.round((degrees - self._last) / 360.0)
        self._last = degrees
        return degrees
