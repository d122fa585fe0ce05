# SPDX-License-Identifier: Apache-2.0
"""Curvature laws and their samples as messages. `laws.law_message` reads messages of laws.

Laws and messages use the paper's section axes, so nothing is rotated here. K2 (pitch) > 0 bends the tail down. K3 (yaw)
> 0 bends it to the right.
"""

from array import array
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from eel_common.ros.headers import stamp_of
from std_msgs.msg import Header

from eel_gaits.laws.law import Law
from eel_gaits.laws.law_message import AXIS_NUMBERS, RAMP, WAVE
from eel_msgs import msg

FRAME = "section"  # axes of the section itself
ROWS = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"


def law_to_message(law: Law, *, stamp: Time | None = None, frame: str = FRAME) -> msg.CurvatureLaw:
    """The law as a message.

    stamp (builtin_interfaces/Time): the time of the law's own t = 0; zero by default. frame: id of the section axes.
    """
    terms = [
        msg.CurvatureTerm(
            axis=AXIS_NUMBERS[term.axis],
            envelope=[msg.Ramp(**_values(ramp, RAMP)) for ramp in term.envelope],
            **_values(term, WAVE),
        )
        for term in law.terms
    ]
    header = Header(stamp=stamp or Time(), frame_id=frame)
    return msg.CurvatureLaw(header=header, name=law.name, terms=terms, transition=law.transition)


def samples_to_message(time: float, x: np.ndarray, rows: np.ndarray, frame: str = FRAME) -> msg.CurvatureSamples:
    """A message for one instant of a law without a closed form, at `time` [s] and the points x (n,) [m].

    rows (6, n): pitch, its rate and its acceleration, then yaw likewise [rad/m, rad/m/s, rad/m/s^2]. `ValueError` if
    `time` does not fit into a stamp.
    """
    arrays = {"x": x, **dict(zip(ROWS, rows, strict=True))}
    fields = {name: array("d", np.ascontiguousarray(values).tobytes()) for name, values in arrays.items()}
    return msg.CurvatureSamples(header=Header(stamp=stamp_of(time), frame_id=frame), **fields)


def _values(holder: Any, names: tuple[str, ...]) -> dict[str, Any]:
    return {name: getattr(holder, name) for name in names}
