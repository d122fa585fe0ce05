# SPDX-License-Identifier: Apache-2.0
"""Motors over time: the load of each, the one closest to its limit, and the total power and work."""

import numpy as np

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.limit import Limit
from eel_viz.messages import AT_LIMIT, Motors
from eel_viz.plots.heat_map import ROWS, HeatMap
from eel_viz.plots.series import log_styles
from eel_viz.scene3d import colours

SERIES = {
    entities.HARDEST_MOTOR: (("torque", colours.ACTUATORS), ("limit", colours.OTHER)),
    entities.SATURATED: (("motors at their limits", colours.ACTUATORS),),
    entities.MOTOR_POWER: (("power [W]", colours.ACTUATORS),),
    entities.MOTOR_WORK: (("work [J]", colours.ACTUATORS),),
}


class LoadMap(HeatMap):
    """The motors from nose to tail over time: their loads, or without any limit their torques up to `limit`."""

    LEAST = 0.0

    def __init__(self, stream: BatchedStream, limit: Limit, *, limited: bool) -> None:
        self._limited, self._count = limited, 0
        super().__init__(stream, limit=limit, root=entities.LOAD_MAP, palette=colours.LOADS)

    def _indices(self, values: np.ndarray, limit: float) -> np.ndarray:
        shades = colours.load_index(values / limit)
        return shades if self._limited else np.minimum(shades, 254)

    def _rows(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        self._count = len(values)
        return np.asarray(values[np.arange(ROWS) * len(values) // ROWS])

    def _texts(self, length: float, limit: float) -> list[str]:
        bar = ["limit", "50 %", "0 %"] if self._limited else [f"{limit:g}", "N m", "0"]
        return ["motor 1", "", f"motor {self._count}" if self._count > 1 else "", *bar]


class MotorPlots:
    """Draws the motors of a recording."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._map: LoadMap | None = None
        self._limit = Limit(0.0)
        self._last: tuple[int, float] | None = None  # ns, W
        self._work = 0.0  # J
        log_styles(stream, SERIES)

    def draw(self, stamp: int, motors: Motors) -> None:
        """Continue with the `motors` at `stamp` [ns]."""
        power, loads = float(motors.power.sum()), motors.loads
        if self._last is not None:
            self._work += 0.5e-9 * (stamp - self._last[0]) * (power + self._last[1])
        self._last = stamp, power
        limited = bool(np.isfinite(loads).any())
        shown = np.nan_to_num(loads) if limited else np.abs(motors.torque)
        hardest = int(np.argmax(shown))
        self._limit.recent.include(stamp, float(shown.max()))
        if self._map is None:
            limit = Limit(1.0, grows=False) if limited else self._limit
            self._map = LoadMap(self._stream, limit, limited=limited)
        self._map.add(stamp, np.arange(1.0, len(shown) + 1.0), shown)
        if self._stream.number_due("motors", stamp):
            torque = [abs(float(motors.torque[hardest]))]
            self._stream.add_scalars(
                stamp, entities.HARDEST_MOTOR, [*torque, float(motors.limit[hardest])] if limited else torque
            )
            if limited:
                self._stream.add_scalars(stamp, entities.SATURATED, [float(np.sum(loads >= AT_LIMIT))])
            self._stream.add_scalars(stamp, entities.MOTOR_POWER, [power])
            self._stream.add_scalars(stamp, entities.MOTOR_WORK, [self._work])
