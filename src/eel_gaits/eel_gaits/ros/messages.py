# SPDX-License-Identifier: Apache-2.0
"""Curvature laws as `eel_msgs/CurvatureLaw` messages, and back.

Laws and messages use the paper's section axes, so nothing is turned here. K2 (pitch) > 0 bends the tail down. K3 (yaw)
> 0 bends it to the right. `law_from_message` checks the message; its `ValueError` names the field and the value.
"""

import math
from array import array

import numpy as np
from builtin_interfaces.msg import Time
from std_msgs.msg import Header

from eel_gaits.laws.law import MAXIMUM_TERMS, Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term
from eel_msgs import msg

END_OF_TIME = 2**31 - 1  # s, of stamps
FRAME = "section"  # axes of the section itself
ROWS = "pitch", "pitch_rate", "pitch_accel", "yaw", "yaw_rate", "yaw_accel"
AXIS_NUMBERS = {"pitch": msg.CurvatureTerm.PITCH, "yaw": msg.CurvatureTerm.YAW}
AXIS_NAMES = {number: name for name, number in AXIS_NUMBERS.items()}


def law_to_message(law, *, stamp=None, frame=FRAME):
    """The law as a message.

    stamp (builtin_interfaces/Time): the time of the law's own t = 0; zero by default. frame: id of the section axes.
    """
    return msg.CurvatureLaw(
        header=Header(stamp=stamp or Time(), frame_id=frame),
        name=law.name,
        terms=[_term_to_message(term) for term in law.terms],
        transition=law.transition,
    )


def samples_to_message(time, x, rows, frame=FRAME):
    """One instant of a law without a closed form as a message, at `time` [s] and the points x (n,) [m].

    rows (6, n): pitch, its rate and its acceleration, then those of yaw [rad/m, rad/m/s, rad/m/s^2]. `ValueError` for a
    time that no stamp holds.
    """
    if not 0.0 <= time < END_OF_TIME:
        raise ValueError(f"time of a sample must be >= 0 s and < {END_OF_TIME} s, got {time:.9g} s")
    seconds, nanoseconds = divmod(math.floor(time * 1e9 + 0.5), 1_000_000_000)
    header = Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=frame)
    fields = {name: array("d", np.ascontiguousarray(row).tobytes()) for name, row in zip(ROWS, rows, strict=True)}
    return msg.CurvatureSamples(header=header, x=array("d", np.ascontiguousarray(x).tobytes()), **fields)


def law_from_message(message):
    """The `Law` in a message. The caller reads the header.

    `ValueError`, such as "terms[2].period must be >= 0 s, got -1.0", where the law is not finite, its arrays do not
    fit, a period is negative, an axis is unknown, or there are more than 1000 terms.
    """
    if len(message.terms) > MAXIMUM_TERMS:
        raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(message.terms)}")
    terms = [_term_from_message(term, f"terms[{index}]") for index, term in enumerate(message.terms)]
    return Law(*terms, name=message.name, transition=message.transition)


def _term_to_message(term):
    return msg.CurvatureTerm(
        axis=AXIS_NUMBERS[term.axis],
        amplitude=term.amplitude,
        knots=term.knots,
        wavelength=term.wavelength,
        period=term.period,
        phase=term.phase,
        envelope=[_ramp_to_message(ramp) for ramp in term.envelope],
    )


def _term_from_message(term, place):
    if term.axis not in AXIS_NAMES:
        known = " or ".join(f"{number} ({name})" for number, name in AXIS_NAMES.items())
        raise ValueError(f"{place}.axis must be {known}, got {term.axis}")
    ramps = [_ramp_from_message(ramp, f"{place}.envelope[{index}]") for index, ramp in enumerate(term.envelope)]
    try:
        return Term(
            axis=AXIS_NAMES[term.axis],
            amplitude=term.amplitude,
            knots=term.knots,
            wavelength=term.wavelength,
            period=term.period,
            phase=term.phase,
            envelope=tuple(ramps),
        )
    except ValueError as error:
        raise ValueError(f"{place}.{error}") from None


def _ramp_to_message(ramp):
    return msg.Ramp(start=ramp.start, end=ramp.end, delta=ramp.delta, factor=ramp.factor)


def _ramp_from_message(ramp, place):
    try:
        return Ramp(ramp.start, ramp.end, ramp.delta, ramp.factor)
    except ValueError as error:
        raise ValueError(f"{place}.{error}") from None
