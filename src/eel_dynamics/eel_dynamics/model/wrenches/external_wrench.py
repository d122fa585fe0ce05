# SPDX-License-Identifier: Apache-2.0
"""External wrenches on sections: tows, tethers, thrusters (eel_core/loads/external_wrenches.hpp).

    ExternalWrench(0.0, force=(2.0, 0.0, 0.0))                        # tows the head forwards, as it is turned
    ExternalWrench(1.0, force=(-0.5, 0.0, 0.0), frame="world")        # a tether holds the tail back
    ExternalWrench(0.0, force=((0, 0, 0), (3, 0, 0)), time=(1, 1))    # from 1 s on
    ExternalWrench(0.5, torque=lambda t: (0.0, 0.0, 0.1 * math.sin(t)))

A table is interpolated linearly. If an instant stands twice in it, the wrench jumps there, and a time step ends there.
"""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from eel_common.quantity import Quantities, checked_instance, checked_row, documented, quantity, required
from eel_common.wording import shown

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.fins.fins import APART

SECTION, WORLD = "section", "world"
FRAMES = SECTION, WORLD
MOST_WRENCHES = 1000  # of a swimmer
MOST_INSTANTS = 100_000  # of a table
NONE = (0.0, 0.0, 0.0)
UNITS = {"force": "N", "torque": "N m"}
IN_PLANE = {"force": (0, 1), "torque": (2,)}  # components that a planar scene allows


@documented
@dataclass(frozen=True, repr=False)
class ExternalWrench(Quantities):
    """An external wrench on the section at a station. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "external wrench"

    station: float = required("m", "X of the section, 0 at the head, up to the body's length", 0.0)
    force: Any = quantity(
        NONE,
        "N",
        "on the section's centre: three numbers, rows of them at `time`, or a function of the time",
        plain=True,
    )
    torque: Any = quantity(NONE, "N m", "about the section's centre, likewise", plain=True)
    frame: str = quantity(
        SECTION,
        "",
        "axes of both: those of the section, x forward, y left, z up, as base_link at the head; or those of the world",
        choices=FRAMES,
    )
    time: Any = quantity(None, "s", "instants of the rows, one or more, that do not fall; None: none", plain=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.time is not None:
            time = checked_row("external wrench time", self.time, None)
            if not 1 <= len(time) <= MOST_INSTANTS or (np.diff(time) < 0.0).any():
                rule = f"1 to {MOST_INSTANTS} instants that do not fall"
                raise ValueError(f"external wrench time must be {rule}, got {shown(time.tolist())}")
            thrice = np.flatnonzero(time[2:] == time[:-2])
            if len(thrice):
                raise ValueError(f"external wrench time may have an instant twice, got {time[thrice[0]]:g} s thrice")
            object.__setattr__(self, "time", tuple(time.tolist()))
        for name in UNITS:
            object.__setattr__(self, name, self._checked(name, getattr(self, name)))
        if self.time is not None and not any(self._is_table(name) for name in UNITS):
            raise ValueError("external wrench time goes with rows of force or torque, got neither")

    def _checked(self, name: str, given: Any) -> Any:
        """Three numbers, rows of them, or a function."""
        if callable(given):
            return given
        what = f"external wrench {name}"
        several = isinstance(given, (list, tuple)) or (isinstance(given, np.ndarray) and given.ndim > 0)
        rows = several and len(given) > 0 and np.ndim(given[0]) > 0
        if not rows:
            return tuple(checked_row(what, given, 3).tolist())
        if self.time is None or len(given) != len(self.time):
            count = 0 if self.time is None else len(self.time)
            raise ValueError(f"{what} must have a row for each time, {count}, got {len(given)}")
        return tuple(tuple(checked_row(f"{what}[{index}]", row, 3).tolist()) for index, row in enumerate(given))

    def _is_table(self, name: str) -> bool:
        given = getattr(self, name)
        return not callable(given) and np.ndim(given) == 2

    @property
    def is_function(self) -> bool:
        """Whether force or torque is a function."""
        return any(callable(getattr(self, name)) for name in UNITS)

    @property
    def acts(self) -> bool:
        """Whether it is not zero. A zero wrench only lets a panel end at its station, and costs nothing."""
        return self.is_function or any(np.any(getattr(self, name)) for name in UNITS)

    @property
    def jumps(self) -> tuple[float, ...]:
        """Times [s] at which it jumps."""
        return tuple(self.time[k] for k in self._ends[1:-1])

    def at(self, time: float, behind: float | None = None) -> np.ndarray:
        """(6,) force [N] and torque [N m] at `time` [s]. At a jump: the value before it, or after it if `behind` is its
        time [s].

        `ValueError` if a function does not return three finite numbers.
        """
        return np.concatenate([self._part_at(name, time, behind) for name in UNITS])

    def _part_at(self, name: str, time: float, behind: float | None) -> np.ndarray:
        given = getattr(self, name)
        if callable(given):
            return checked_row(f"external wrench {name} at {time:.6g} s", given(time), 3)
        if not self._is_table(name):
            return np.array(given)
        piece = self._piece(time if behind is None else behind, behind is not None)
        instants, rows = np.array(self.time)[piece], np.array(given)[piece]
        return np.array([np.interp(time, instants, column) for column in rows.T])

    def _piece(self, time: float, behind: bool) -> slice:
        """The instants of the piece between two jumps that holds `time` [s]. At a jump: the piece before it, or
        after it if `behind` is its time."""
        passed = sum(jump <= time if behind else jump < time for jump in self.jumps)
        return slice(*self._ends[passed : passed + 2])

    @property
    def _ends(self) -> list[int]:
        """Indices of the instants at which the pieces between jumps begin, and the end of the last piece."""
        instants = self.time or ()
        return [0, *(k for k, (a, b) in enumerate(pairwise(instants), start=1) if a == b), len(instants)]

    def cubics(self, now: float) -> tuple[np.ndarray, np.ndarray]:
        """Knots (n,) [s] and coefficients (n - 1, 4, 6) of cubics from `now` [s] to the next jump. Not for functions.

        Coefficients begin with the constant; of six numbers the first three are the torque.
        """
        knots = np.array([now] if self.time is None else np.unique(self.time[self._piece(now, True)]))
        values = np.array([self.at(time, now)[[3, 4, 5, 0, 1, 2]] for time in knots.tolist()])
        if len(knots) == 1:
            knots, values = np.array([knots[0], knots[0] + 1.0]), np.repeat(values, 2, axis=0)
        coefficients = np.zeros((len(knots) - 1, 4, 6))
        coefficients[:, 0] = values[:-1]
        coefficients[:, 1] = np.diff(values, axis=0) / np.diff(knots)[:, None]
        return knots, coefficients


def checked_wrenches(given: Any, body: Body, planar: bool) -> tuple[ExternalWrench, ...]:
    """The wrenches of a run as a tuple. `ValueError` names one that the `body` or a `planar` scene does not allow."""
    if given is None:
        return ()
    if isinstance(given, (str, ExternalWrench)) or not np.iterable(given):
        raise ValueError(f"wrenches must be a list of ExternalWrench, got {shown(given)}")
    found = tuple(checked_instance("external wrench", each, ExternalWrench) for each in given)
    if len(found) > MOST_WRENCHES:
        raise ValueError(f"wrenches must be at most {MOST_WRENCHES}, got {len(found)}")
    for each in found:
        check_wrench(each, body, planar)
    return found


def check_wrench(wrench: ExternalWrench, body: Body, planar: bool) -> None:
    """`ValueError` for a `wrench` off the `body`, or out of the plane of a `planar` scene."""
    if wrench.station > body.length * (1.0 + APART):
        what = f"external wrench station must lie on the body, 0 to {body.length:g} m"
        raise ValueError(f"{what}, got {wrench.station:g} m")
    if not planar:
        return
    for name in UNITS:
        if not callable(getattr(wrench, name)):
            for row in np.atleast_2d(getattr(wrench, name)).tolist():
                _check_in_plane(name, row)


def _check_in_plane(name: str, row: Any) -> None:
    out = [value for axis, value in enumerate(row) if axis not in IN_PLANE[name]]
    if any(out):
        axis = "z alone" if name == "torque" else "x and y alone"
        raise ValueError(f"external wrench {name} must be along {axis} in a planar scene, got {shown(list(row))}")


def next_jump(wrenches: tuple[ExternalWrench, ...], now: float) -> float:
    """The first time [s] after `now` at which one of the `wrenches` jumps; infinite without one."""
    return min((time for each in wrenches if each.acts for time in each.jumps if time > now), default=math.inf)


def instants_of(wrenches: tuple[ExternalWrench, ...]) -> list[float]:
    """Times [s] at which one of the `wrenches`, or its rate, jumps."""
    return sorted({time for each in wrenches if each.acts for time in each.time or ()})


def core_wrenches(
    wrenches: tuple[ExternalWrench, ...], body: Body, grid: Grid, x: np.ndarray, now: float, planar: bool
) -> list[tuple[Any, ...]]:
    """The `wrenches` for the compiled mechanics, from `now` [s] to the next jump; stations at `x` (M,) [m]."""
    near, rows = 10.0 * APART * body.length, []
    for each in wrenches:
        if each.acts:
            node = None if each.station <= near else int(np.searchsorted(grid.x, each.station - near))
            at_end = each.station >= body.length - near
            behind = len(x) if at_end else int(np.searchsorted(x, each.station - near))
            given = (_called(each, now, planar),) if each.is_function else each.cubics(now)
            rows.append((node, behind, each.frame == WORLD, *given))
    return rows


def _called(wrench: ExternalWrench, now: float, planar: bool) -> Callable[[float], tuple[float, ...]]:
    """Torque and force of a `wrench` with functions, as a function of time. If one of the two is a table, it begins at
    `now` [s]."""

    def called(time: float) -> tuple[float, ...]:
        row = wrench.at(time, now)
        if planar:
            _check_in_plane("force", row[:3])
            _check_in_plane("torque", row[3:])
        return (*row[3:].tolist(), *row[:3].tolist())

    return called


def plain_wrench(wrench: ExternalWrench) -> dict[str, Any]:
    """A wrench as plain values. `ValueError` for a function."""
    if wrench.is_function:
        raise ValueError(f"external wrench at {wrench.station:g} m has no text: it is a function")
    return asdict(wrench)
