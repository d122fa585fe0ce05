# SPDX-License-Identifier: Apache-2.0
"""Power of the actuators along the body of a run, from its internal torque."""

import numpy as np


def power_density(run) -> np.ndarray:
    """Power of the actuators per length, -C . dK/dt (T, M) [W/m], at the stations of `run`. `ValueError` where these do
    not reach from nose to tail."""
    length = run.body.length
    if len(run.x) < 2 or run.x[0] > 1e-9 * length or run.x[-1] < (1.0 - 1e-9) * length:
        raise ValueError(f"run must have stations from 0 to {length:g} m, got {run.x[0]:g} to {run.x[-1]:g} m")
    return -np.sum(torque_of(run) * run.curvature_rate, axis=2)


def area(values: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Integral of `values` (..., n) by `x` (n,), by the trapezoidal rule."""
    return np.sum(0.5 * (values[..., 1:] + values[..., :-1]) * np.diff(x), axis=-1)


def torque_of(run) -> np.ndarray:
    """The internal torque (T, M, 3) [N m] of `run`. `ValueError` where it holds none."""
    if run.torque is None:
        raise ValueError("torque needs a run with scene internal_wrench on")
    return run.torque
