# SPDX-License-Identifier: Apache-2.0
"""Reads laws, and a controller's samples of laws, from serialised messages."""

from typing import Any

from eel_common.ros.headers import FieldReader
from eel_common.ros.serving import read_message
from eel_gaits.laws.law import MAXIMUM_TERMS
from eel_gaits.ros.messages import ROWS

from eel_dynamics.curvature.curvature_samples import LateSample, check_points
from eel_dynamics.ros.inputs.stamps import stamped
from eel_msgs import msg

JOIN = "a controller that joins a running simulation begins 1/rate or more after the stamp of the last odom"
LARGEST_LAW = 2**19  # bytes, without the name: 1,000 terms of 30 knots, which are adopted in half a second


def law_name(data: bytes) -> str:
    """The name in a serialised CurvatureLaw. `EOFError` if the message ends before its terms."""
    return FieldReader(data).text()


def read_law(data: bytes) -> msg.CurvatureLaw:
    """The CurvatureLaw in a serialised message. `ValueError` for too many terms, or too many numbers in them.

    They are counted before the message is deserialised, because 10^5 terms would block the process for a second.
    """
    fields = FieldReader(data)
    name, terms = fields.text(), fields.number()
    if terms > MAXIMUM_TERMS:
        raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {terms}")
    if len(data) - len(name) > LARGEST_LAW:
        raise ValueError(f"its terms must have at most {LARGEST_LAW} bytes, got {len(data) - len(name)}")
    return read_message(data, msg.CurvatureLaw)


def samples_from_message(data: bytes, now: float) -> dict[str, Any]:
    """The arguments of `Simulation.add_samples`: time [s], x [m], curvatures and two time derivatives, section axes.

    data: a serialised CurvatureSamples. Deserialising it would cost five times as much as reading its numbers here.
    now: simulation time [s]. `ValueError` for an invalid stamp, or too many points; `EOFError` if the message ends
    before its fields.
    """
    fields = FieldReader(data)
    x = fields.numbers()
    check_points(len(x))
    return {"time": stamped(fields.stamp, now), "x": x} | {name: fields.numbers() for name in ROWS}


def refused(error: Exception, driven: bool = False) -> str:
    """The log line for curvature samples that are refused with an `error`.

    driven: whether earlier samples drive the swimmer, or drove it until they ran out.
    """
    reason = str(error).removeprefix("curvature samples ")
    if reason.startswith("time "):
        reason = f"header.stamp{reason.removeprefix('time')}"
    if isinstance(error, LateSample):
        reason += f": {'send them further ahead' if driven else JOIN}"
    return f"curvature samples refused: {reason}"
