# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments. `ValueError` names the argument that does not fit, and its value."""

from functools import lru_cache

import numpy as np
from eel_base.attitude import unit_quaternion
from eel_base.quantity import is_finite, numbers
from eel_base.wording import shown

FEW = 8  # numbers of a row that a message shows


def checked_instance(name: str, value, kind: type | tuple[type, ...]):
    """`value`, if it is a `kind`, or one of several."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        raise ValueError(f"{name} must be a {' or a '.join(each.__name__ for each in kinds)}, got {shown(value)}")
    return value


def checked_number(name: str, value, unit: str, *, zero: bool = False) -> float:
    """`value` as a finite float > 0, or >= 0 where `zero` is true."""
    if not is_finite(value) or value < 0.0 or (value == 0.0 and not zero):
        rule = f"finite and {'>=' if zero else '>'} 0 {unit}".rstrip()
        raise ValueError(f"{name} must be {rule}, got {shown(value)}")
    return float(value)


def checked_row(name: str, values, size: int | None) -> np.ndarray:
    """`values` as an array (size,) of finite floats. Any size fits where `size` is None."""
    if type(values) is tuple and all(type(value) is float for value in values):
        return _checked_tuple(name, values, size).copy()
    return _checked_row(name, values, size)


@lru_cache(maxsize=64)
def _checked_tuple(name: str, values: tuple, size: int | None) -> np.ndarray:
    return _checked_row(name, values, size)


def _checked_row(name: str, values, size: int | None) -> np.ndarray:
    array = numbers(name, values)
    if array.ndim != 1 or (size is not None and len(array) != size):
        got = shown(values)
        if array.ndim == 1:
            got = f"{len(array)}: {got}" if 0 < len(array) <= FEW else f"{len(array)}"
        raise ValueError(f"{name} must be {'a row of' if size is None else size} numbers, got {got}")
    if not np.isfinite(array).all():
        index = np.flatnonzero(~np.isfinite(array))[0]
        raise ValueError(f"{name} must be finite, got {array[index]} at index {index}")
    return array


def checked_quaternion(name: str, quaternion) -> np.ndarray:
    """`quaternion` (x, y, z, w) as an array (4,), normalised (`unit_quaternion`)."""
    return np.array(unit_quaternion(name, checked_row(name, quaternion, 4).tolist()))


@lru_cache(maxsize=64)
def equidistant(length: float, count: int) -> np.ndarray:
    """X (count,) [m] of `count` equidistant stations from the nose to the tail."""
    return np.linspace(0.0, length, count)


def checked_stations(stations, length: float) -> np.ndarray:
    """X (M,) [m] of the stations: a number of equidistant ones, or X that rise within 0 to `length` [m]."""
    if isinstance(stations, (int, np.integer)) and not isinstance(stations, bool):
        if not 2 <= stations <= 100_000:
            raise ValueError(f"stations must be 2 or more, or their X in m, got {shown(stations)}")
        return equidistant(length, int(stations)).copy()
    x = checked_row("stations", stations, None)
    if len(x) < 1 or np.any(np.diff(x) <= 0.0) or x[0] < 0.0 or x[-1] > length * (1 + 1e-12):
        raise ValueError(f"stations must rise within 0 to {length} m, got {shown(stations)}")
    return np.minimum(x, length)


def check_planar(position, orientation, twist):
    """`ValueError` unless the initial state lies in the plane z = const and stays there."""
    x, y, _, _ = orientation.tolist()
    if abs(x) > 1e-12 or abs(y) > 1e-12:
        raise ValueError(f"orientation must be a turn about z in a planar scene, got {shown(orientation.tolist())}")
    roll, pitch, _, _, _, heave = twist.tolist()
    if roll or pitch or heave:
        raise ValueError(
            f"twist must lie in the plane of a planar scene (Omega_1 = Omega_2 = V_3 = 0), got {shown(twist.tolist())}"
        )


def check_planar_law(law):
    """`ValueError` unless `law` bends the body in the plane."""
    if not law.in_plane:
        raise ValueError(f"law {shown(law.name)} has a pitch term: a planar scene cannot bend out of its plane")
