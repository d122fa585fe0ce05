# SPDX-License-Identifier: Apache-2.0
"""Curvature laws as `eel_msgs/CurvatureLaw` messages, and back.

Laws and messages use the paper's section axes, so nothing is turned here. K2 (pitch) > 0 bends the tail down. K3 (yaw)
> 0 bends it to the right. `law_from_message` checks the message; its `ValueError` names the field and the value.
"""

from array import array
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from builtin_interfaces.msg import Time
from eel_ros.headers import stamp_of
from std_msgs.msg import Header

from eel_gaits.laws.law import MAXIMUM_TERMS, Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term
from eel_msgs import msg

Made = TypeVar("Made")

FRAME = "section"  # axes of the section itself
ROWS = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"
AXIS_NUMBERS = {"pitch": msg.CurvatureTerm.PITCH, "yaw": msg.CurvatureTerm.YAW}
AXIS_NAMES = {number: name for name, number in AXIS_NUMBERS.items()}
WAVE = "amplitude", "knots", "wavelength", "period", "phase"  # of terms and their messages alike
RAMP = "start", "end", "delta", "factor"


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
    """One instant of a law without a closed form as a message, at `time` [s] and the points x (n,) [m].

    rows (6, n): pitch, its rate and its acceleration, then those of yaw [rad/m, rad/m/s, rad/m/s^2]. `ValueError` for a
    time that no stamp holds.
    """
    arrays = {"x": x, **dict(zip(ROWS, rows, strict=True))}
    fields = {name: array("d", np.ascontiguousarray(values).tobytes()) for name, values in arrays.items()}
    return msg.CurvatureSamples(header=Header(stamp=stamp_of(time), frame_id=frame), **fields)


def law_from_message(message: msg.CurvatureLaw) -> Law:
    """The `Law` in a message. The caller reads the header.

    `ValueError`, such as "terms[2].period must be >= 0 s, got -1.0", where the law is not finite, its arrays do not
    fit, a period is negative, an axis is unknown, or there are more than 1000 terms.
    """
    if len(message.terms) > MAXIMUM_TERMS:
        raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(message.terms)}")
    terms = [_term_from_message(term, f"terms[{index}]") for index, term in enumerate(message.terms)]
    return Law(*terms, name=message.name, transition=message.transition)


def _term_from_message(term: msg.CurvatureTerm, place: str) -> Term:
    if term.axis not in AXIS_NAMES:
        known = " or ".join(f"{number} ({name})" for number, name in AXIS_NAMES.items())
        raise ValueError(f"{place}.axis must be {known}, got {term.axis}")
    ramps = [
        _made(Ramp, f"{place}.envelope[{index}]", **_values(ramp, RAMP)) for index, ramp in enumerate(term.envelope)
    ]
    return _made(Term, place, axis=AXIS_NAMES[term.axis], envelope=tuple(ramps), **_values(term, WAVE))


def _values(holder: Any, names: tuple[str, ...]) -> dict[str, Any]:
    return {name: getattr(holder, name) for name in names}


def _made(kind: Callable[..., Made], place: str, **values: Any) -> Made:
    """What `kind` makes of the values; its `ValueError` begins with the `place`."""
    try:
        return kind(**values)
    except ValueError as error:
        raise ValueError(f"{place}.{error}") from None
