# SPDX-License-Identifier: Apache-2.0
"""Motors over time: how hard each works, the one that is nearest to its limit, and the power and work of all."""

from collections.abc import Callable

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.part_messages import Motors
from eel_viz.plots.heat_map import ROWS, HeatMap
from eel_viz.plots.limit import Limit
from eel_viz.robots.loads import AT_LIMIT, load_colours, loads_of
from eel_viz.scene3d import colours

MAP_PERIOD = 200_000_000  # ns
SERIES = {
    entities.HARDEST_MOTOR: (("torque", colours.ACTUATORS), ("limit", colours.OTHER)),
    entities.SATURATED: (("motors at their limits", colours.ACTUATORS),),
    entities.MOTOR_POWER: (("power [W]", colours.ACTUATORS),),
    entities.MOTOR_WORK: (("work [J]", colours.ACTUATORS),),
}


class LoadMap(HeatMap):
    """The motors from nose to tail over time; their loads, or where none has a limit their torques up to `limit`."""

    LEAST = 0.0

    def __init__(self, stream: BatchedStream, limit: Limit, *, limited: bool) -> None:
        self._limited, self._count = limited, 0
        super().__init__(stream, limit=limit, root=entities.LOAD_MAP, palette=colours.LOADS)

    def _indices(self, values: np.ndarray, limit: float) -> np.ndarray:
        return load_colours(values / limit) if self._limited else np.minimum(load_colours(values / limit), 254)

    def _rows(self, x: np.ndarray, values: np.ndarray) -> np.ndarray:
        self._count = len(values)
        return np.asarray(values[np.arange(ROWS) * len(values) // ROWS])

    def _texts(self, length: float, limit: float) -> list[str]:
        bar = ["limit", "50 %", "0 %"] if self._limited else [f"{limit:g}", "N m", "0"]
        return ["motor 1", "", f"motor {self._count}" if self._count > 1 else "", *bar]


class MotorPlots:
    """Draws the motors of a recording. due(what, stamp, period): whether `what` is to be logged at `stamp` [ns]."""

    def __init__(self, stream: BatchedStream, due: Callable[[str, int, int], bool], period: int) -> None:
        self._stream, self._due, self._period = stream, due, period
        self._map: LoadMap | None = None
        self._limit = Limit(0.0)
        self._last: tuple[int, float] | None = None  # ns, W
        self._work = 0.0  # J
        for path, lines in SERIES.items():
            names, shades = zip(*lines, strict=True)
            stream.log_static(path, rr.SeriesLines(names=names, colors=shades, widths=[1.5] * len(names)))

    def draw(self, stamp: int, motors: Motors) -> None:
        """Continue with the `motors` at `stamp` [ns]."""
        power, loads = float(motors.power.sum()), loads_of(motors)
        if self._last is not None:
            self._work += 0.5e-9 * (stamp - self._last[0]) * (power + self._last[1])
        self._last = stamp, power
        limited = bool(np.isfinite(loads).any())
        shown = np.nan_to_num(loads) if limited else np.abs(motors.torque)
        hardest = int(np.argmax(shown))
        self._draw_map(stamp, shown, limited=limited)
        if self._due("motors", stamp, self._period):
            torque = [abs(float(motors.torque[hardest]))]
            self._stream.add_scalars(
                stamp, entities.HARDEST_MOTOR, [*torque, float(motors.limit[hardest])] if limited else torque
            )
            if limited:
                self._stream.add_scalars(stamp, entities.SATURATED, [float(np.sum(loads >= AT_LIMIT))])
            self._stream.add_scalars(stamp, entities.MOTOR_POWER, [power])
            self._stream.add_scalars(stamp, entities.MOTOR_WORK, [self._work])

    def _draw_map(self, stamp: int, shown: np.ndarray, *, limited: bool) -> None:
        if self._map is None:
            self._map = LoadMap(self._stream, Limit(1.0, grows=False) if limited else self._limit, limited=limited)
        self._limit.include(stamp, float(shown.max()))
        self._map.include(stamp, np.arange(1.0, len(shown) + 1.0), shown)
        if self._due("load map", stamp, MAP_PERIOD):
            self._map.draw(stamp)
