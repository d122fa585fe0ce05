# SPDX-License-Identifier: Apache-2.0
"""How hard motors work, as shares of what they can, and in colours."""

import numpy as np

from eel_viz.part_messages import Motors

AT_LIMIT = 1.0 - 1e-9  # of the torque that a motor can give, from which it counts as at its limit


def loads_of(motors: Motors) -> np.ndarray:
    """What each motor gives of what it can, (J,), 0 to 1; of motors without a limit NaN."""
    torque, limited = np.abs(motors.torque), np.isfinite(motors.limit)
    none = np.where(limited, (torque > 0.0).astype(float), np.nan)  # at a speed at which no torque is left
    return np.asarray(np.divide(torque, motors.limit, out=none, where=limited & (motors.limit > 0.0)))


def load_colours(loads: np.ndarray) -> np.ndarray:
    """Entries of `colours.LOADS` for `loads` (...,), uint8: the last, red, at the limit alone."""
    below = np.clip(np.nan_to_num(loads) * 254.0, 0.0, 254.0).round()
    return np.where(loads >= AT_LIMIT, 255, below).astype(np.uint8)
