# SPDX-License-Identifier: Apache-2.0
"""Motors that are too slow for a law, found before the swim.

At its speed limit a motor has no torque left. It lags behind the law, and its torque has a kink whenever it reaches the
limit. Such a swim takes many steps.
"""

from typing import NamedTuple

import numpy as np
from eel_gaits.laws.law import Law
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.model.robot.compiled import ModeTable

LOOKS = 24  # instants at which the law is evaluated
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)  # its multiples fall on all phases of any period alike
FAR = 3.0  # times its speed limit, from which a motor is far too slow


class SlowMotors(NamedTuple):
    """A text about motors that are too slow, and whether one is far too slow."""

    text: str
    far: bool


def slow_motors(table: ModeTable | None, law: Law | SampledLaw, duration: float) -> SlowMotors | None:
    """The motors in a `table` that cannot follow a `law` within `duration` [s]; None if all can."""
    motors = () if table is None else table.motors
    fastest = np.array([motor.servo.speed_limit or np.inf for motor in motors])
    if table is None or not np.isfinite(fastest).any():
        return None
    modes = [motor.mode for motor in motors]
    times = duration * (GOLDEN * np.arange(LOOKS) % 1.0)
    rates = np.array([law.curvature(time, table.points)[1] for time in times])
    asked = np.einsum("mp,tpm->tm", table.projection[modes], rates[:, :, table.axis[modes]])
    most = np.abs(asked).max(axis=0)
    slow = np.flatnonzero(most > fastest)
    if not len(slow):
        return None
    worst = slow[np.argmax(most[slow] / fastest[slow])]
    far = bool(most[worst] > FAR * fastest[worst])
    text = (
        f"{len(slow)} of {len(motors)} motors are too slow for the law: the one of {table.name[modes[worst]]} is asked "
        f"for {most[worst]:.3g} rad/s, its speed_limit is {fastest[worst]:.3g} rad/s"
    )
    return SlowMotors(f"{text}; they lag so far that no run is made finer for its target" if far else text, far)
