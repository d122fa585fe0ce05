# SPDX-License-Identifier: Apache-2.0
"""Laws as messages and back: exact, and every refusal names the field and the value."""

import math

import pytest
from eel_gaits.laws.law_message import law_from_message
from eel_gaits.ros.messages import law_to_message
from hypothesis import given
from law_strategies import laws
from rclpy.serialization import deserialize_message, serialize_message

from eel_gaits import GAITS, falling, gait
from eel_msgs.msg import CurvatureLaw, CurvatureTerm, Ramp


@given(law=laws())
def test_round_trip_is_exact(law):
    message = law_to_message(law)
    received = deserialize_message(serialize_message(message), CurvatureLaw)
    assert law_from_message(message) == law
    assert law_from_message(received) == law


@pytest.mark.parametrize("name", sorted(GAITS))
def test_every_gait_passes(name):
    assert law_from_message(law_to_message(gait(name, transition=0.5))) == gait(name, transition=0.5)


def test_header_and_axes():
    message = law_to_message(falling())
    assert (message.header.frame_id, message.header.stamp.sec, message.header.stamp.nanosec) == ("section", 0, 0)
    assert [term.axis for term in message.terms] == [CurvatureTerm.YAW, CurvatureTerm.PITCH]


def test_a_message_without_terms_is_the_straight_body():
    assert law_from_message(CurvatureLaw()).terms == ()


def changed(**changes):
    """The falling gait with a third term, the one that is changed."""
    message = law_to_message(falling())
    fields = {"axis": CurvatureTerm.YAW, "amplitude": [1.0, 2.0], **changes}
    message.terms.append(CurvatureTerm(**fields))
    return message


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        (changed(period=-1.0), "terms[2].period must be >= 0 s, got -1.0"),
        (changed(period=math.nan), "terms[2].period must be finite, got nan"),
        (changed(wavelength=math.inf), "terms[2].wavelength must be finite, got inf"),
        (changed(phase=-math.inf), "terms[2].phase must be finite, got -inf"),
        (changed(axis=0), "terms[2].axis must be 2 (pitch) or 3 (yaw), got 0"),
        (changed(axis=255), "terms[2].axis must be 2 (pitch) or 3 (yaw), got 255"),
        (changed(amplitude=[]), "terms[2].amplitude must have at least 1 coefficient, got none"),
        (changed(amplitude=[1.0, math.nan]), "terms[2].amplitude[1] must be finite, got nan"),
        (changed(knots=[0.0]), "terms[2].knots must be none or at least 2, got 1"),
        (changed(knots=[0.0, 0.5, 1.0]), "terms[2].amplitude must have one value per knot (3), got 2 values"),
        (changed(knots=[1.0, 0.0]), "terms[2].knots must be strictly increasing [m], got [1.0, 0.0]"),
        (changed(knots=[0.0, math.nan]), "terms[2].knots[1] must be finite, got nan"),
        (
            changed(envelope=[Ramp(start=0.0, end=1.0, delta=1.0), Ramp(start=1.0, end=1.0, delta=1.0)]),
            "terms[2].envelope[1].end must be > start (1.0 s), got 1.0",
        ),
        (changed(envelope=[Ramp(end=1.0, delta=math.nan)]), "terms[2].envelope[0].delta must be finite, got nan"),
        (CurvatureLaw(transition=-0.5), "transition must be >= 0 s, got -0.5"),
        (CurvatureLaw(transition=math.inf), "transition must be finite, got inf"),
        (CurvatureLaw(terms=[CurvatureTerm()] * 1001), "terms must be at most 1000, got 1001"),
    ],
)
def test_refuses_with_the_field_and_the_value(message, expected):
    with pytest.raises(ValueError) as caught:
        law_from_message(message)
    assert str(caught.value) == expected
