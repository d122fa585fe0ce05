# SPDX-License-Identifier: Apache-2.0
"""Readings of a node's sensors, from a bag: the same values as `Run.imu` and its like for a run."""

import os
from collections.abc import Callable
from typing import Any

import numpy as np

from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.sensors.imu import ImuReadings
from eel_dynamics.sensors.velocity import VelocityReadings


def readings_from_bag(path: str | os.PathLike[str], namespace: str | None = None) -> dict[str, Any]:
    """Readings of sensors in a bag, with the time [s] of each: `imu` (`ImuReadings`), `velocity`
    (`VelocityReadings`), `pressure` [Pa] and `depth` [m] below z = 0 as pairs (time (N,), values (N,)).

    Topics missing in the bag are left out. namespace: the swimmer's; None: that of the only one. The last of several
    readings with one stamp counts: a node that waits at its start repeats them. Readings after a reset follow those
    before. `ValueError` where the bag holds no swimmer; `ImportError` without the package eel_viz.
    """
    found: dict[str, list[tuple[float, Any]]] = {}
    for topic, message in function_of_eel_viz("messages")(path, namespace):
        if topic in _READERS:
            stamp, rows = message.header.stamp, found.setdefault(topic, [])
            time = stamp.sec + 1e-9 * stamp.nanosec
            if rows and rows[-1][0] == time:
                rows.pop()
            rows.append((time, message))
    return {
        topic: _READERS[topic](np.array([time for time, _ in rows]), [message for _, message in rows])
        for topic, rows in found.items()
    }


def _imu(time: np.ndarray, messages: list[Any]) -> ImuReadings:
    told = messages[0].orientation_covariance[0] >= 0.0
    orientation = np.array([[*_xyz(each.orientation), each.orientation.w] for each in messages]) if told else None
    force, turning = (
        np.array([_xyz(getattr(each, name)) for each in messages])
        for name in ("linear_acceleration", "angular_velocity")
    )
    return ImuReadings(time, force, turning, orientation)


def _velocity(time: np.ndarray, messages: list[Any]) -> VelocityReadings:
    return VelocityReadings(time, np.array([_xyz(each.twist.twist.linear) for each in messages]))


def _pressure(time: np.ndarray, messages: list[Any]) -> tuple[np.ndarray, np.ndarray]:
    return time, np.array([each.fluid_pressure for each in messages], dtype=float)


def _depth(time: np.ndarray, messages: list[Any]) -> tuple[np.ndarray, np.ndarray]:
    return time, np.array([-each.pose.pose.position.z for each in messages], dtype=float)


def _xyz(vector: Any) -> list[float]:
    return [vector.x, vector.y, vector.z]


_READERS: dict[str, Callable[[np.ndarray, list[Any]], Any]] = {
    "imu": _imu,
    "velocity": _velocity,
    "pressure": _pressure,
    "depth": _depth,
}
