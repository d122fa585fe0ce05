# SPDX-License-Identifier: Apache-2.0
"""Reads a law from a message `eel_msgs/CurvatureLaw`, from ROS or a bag, by the names of its fields."""

from collections.abc import Callable
from typing import Any, TypeVar

from eel_gaits.laws.law import MAXIMUM_TERMS, Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import SECTION_COLUMN, Term

Made = TypeVar("Made")

AXIS_NUMBERS = {name: column + 1 for name, column in SECTION_COLUMN.items()}  # as in CurvatureTerm
AXIS_NAMES = {number: name for name, number in AXIS_NUMBERS.items()}
WAVE = "amplitude", "knots", "wavelength", "period", "phase"  # fields of both `Term` and its message
RAMP = "start", "end", "delta", "factor"


def law_from_message(message: Any) -> Law:
    """The `Law` in a CurvatureLaw, from ROS or a bag. The caller reads the header.

    `ValueError`, such as "terms[2].period must be >= 0 s, got -1.0", for a law that is not finite, arrays that do not
    fit together, a negative period, an unknown axis, or more than 1000 terms.
    """
    if len(message.terms) > MAXIMUM_TERMS:
        raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(message.terms)}")
    terms = [_term_from_message(term, f"terms[{index}]") for index, term in enumerate(message.terms)]
    return Law(*terms, name=message.name, transition=message.transition)


def _term_from_message(term: Any, place: str) -> Term:
    if term.axis not in AXIS_NAMES:
        known = " or ".join(f"{number} ({name})" for number, name in AXIS_NAMES.items())
        raise ValueError(f"{place}.axis must be {known}, got {term.axis}")
    ramps = [
        _made(Ramp, f"{place}.envelope[{index}]", **{name: getattr(ramp, name) for name in RAMP if hasattr(ramp, name)})
        for index, ramp in enumerate(term.envelope)
    ]
    return _made(
        Term, place, axis=AXIS_NAMES[term.axis], envelope=tuple(ramps), **{name: getattr(term, name) for name in WAVE}
    )


def _made(kind: Callable[..., Made], place: str, **values: Any) -> Made:
    """Call `kind` on the values. Its `ValueError` begins with the `place`."""
    try:
        return kind(**values)
    except ValueError as error:
        raise ValueError(f"{place}.{error}") from None
