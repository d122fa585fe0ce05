# SPDX-License-Identifier: Apache-2.0
"""Curvature laws: the commanded curvature of the body, with exact first and second time derivatives.

A law is a sum of terms. Each term is a wave in pitch (K2) or yaw (K3) of the backbone:

    K(t, X) = sum over terms of  envelope(t) amplitude(X) sin(2 pi (X / wavelength - t / period) + phase)

A quotient is dropped where its divisor is 0. An envelope is a sum of ramps, or a product of such sums. Equations (62)
to (66) of Boyer, Porez and Leroyer, J. Nonlinear Sci. 20 (2010), 47-79, doi:10.1007/s00332-009-9050-5, are such a law.

Laws add (`+`), scale (`*`), and are delayed, mirrored, ramped in and out, and followed by one another.

Section axes (the paper's): 1 along the backbone from head to tail, 2 lateral, 3 up. K2 > 0 bends the tail down,
K3 > 0 bends it towards +2. X runs from 0 at the nose to the body's length at the tail.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from eel_common.cell import cell_of
from eel_common.quantity import checked_choice, number, numbers, positive
from eel_common.wording import shown

from eel_gaits.laws.law_picture import lines_of_law, picture_of_law
from eel_gaits.laws.ramp import begun, ended
from eel_gaits.laws.term import SECTION_COLUMN, Term

MAXIMUM_TERMS = 1000
MAXIMUM_NAME = 200  # characters


@dataclass(frozen=True, init=False)
class Law:
    """A curvature law: the sum of its terms. A law without terms is the straight body.

    Law(one, two) and Law([one, two]) are the same law of two terms. `ValueError` names a bad attribute.

    Attributes:
        terms: at most 1000.
        name: its name in messages and plots, at most 200 characters.
        transition: [s], duration of the blend from a swimmer's present motion to the law; 0 for the receiver's default.
    """

    terms: tuple[Term, ...]
    name: str
    transition: float

    def __init__(self, *terms: Any, name: str = "law", transition: float = 0.0) -> None:
        if len(terms) == 1 and isinstance(terms[0], (list, tuple)):
            (terms,) = terms
        if len(terms) > MAXIMUM_TERMS:
            raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(terms)}")
        for index, term in enumerate(terms):
            if not isinstance(term, Term):
                raise ValueError(f"terms[{index}] must be a Term, got {shown(term)}")
        object.__setattr__(self, "terms", tuple(terms))
        object.__setattr__(self, "name", checked_name(name))
        object.__setattr__(self, "transition", number("transition", transition, "s", minimum=0.0))

    def __hash__(self) -> int:  # cached: tables are looked up by it
        found = self.__dict__.get("_hash")
        if found is None:
            found = hash((self.terms, self.name, self.transition))
            object.__setattr__(self, "_hash", found)
        return found

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}  # valid in this process only

    def __repr__(self) -> str:
        count = f"{len(self.terms)} term{'' if len(self.terms) == 1 else 's'}"
        return f"Law({shown(self.name)}, {count}{f', transition={self.transition:g} s' if self.transition else ''})"

    def plot(self, length: float = 1.0) -> Any:
        """A matplotlib figure: the curvature along a body of `length` [m] over a period, after all ramps.

        `ImportError` without matplotlib.
        """
        period = max((abs(term.period) for term in self.terms), default=0.0) or 1.0
        settled = max((ramp.end for term in self.terms for ramp in term.envelope), default=0.0)
        return picture_of_law(self, positive("length", length, "m"), settled, period)

    def _repr_html_(self) -> str:
        return cell_of(self.plot, lines_of_law(self))

    @property
    def in_plane(self) -> bool:
        """Whether the body bends in yaw only."""
        return all(term.axis == "yaw" for term in self.terms)

    @property
    def waves(self) -> tuple[Term, ...]:
        """The terms that have a period."""
        return tuple(term for term in self.terms if term.period)

    def curvature(self, time: float, x: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Curvature, its rate and its acceleration at one time. `ValueError` names an argument that is not finite.

        Args:
            time: [s], the law's own time.
            x: [m], shape (M,), arc length from the nose.

        Returns:
            value [rad/m], rate [rad/m/s], acceleration [rad/m/s^2], each of shape (M, 3), in section axes. Column 0 is
            zero, column 1 is pitch (K2), column 2 is yaw (K3).
        """
        x = np.atleast_1d(numbers("x", x))
        if not np.all(np.isfinite(x)):
            raise ValueError(f"x must be finite, got {shown(x)}")
        time = number("time", time)
        total = np.zeros((3, x.size, 3))
        for term in self.terms:
            total[:, :, SECTION_COLUMN[term.axis]] += term.curvature(time, x)
        return total[0], total[1], total[2]

    # -- laws made of laws

    def __add__(self, other: object) -> "Law":
        """The sum of two laws. Its transition is the longer one."""
        if not isinstance(other, Law):
            return NotImplemented
        name = self.name if self.name == other.name else f"{self.name} + {other.name}"[:MAXIMUM_NAME]
        return Law(*self.terms, *other.terms, name=name, transition=max(self.transition, other.transition))

    def __mul__(self, scale: Any) -> "Law":
        """The law with `scale` times its curvature."""
        if isinstance(scale, Law):
            return NotImplemented
        scale = number("scale", scale)
        return self._of(term.scaled(scale) for term in self.terms)

    __rmul__ = __mul__

    def delayed(self, delay: float) -> "Law":
        """The same motion, later by `delay` [s]; earlier where it is negative."""
        delay = number("delay", delay)
        return self._of(term.delayed(delay) for term in self.terms)

    def mirrored(self, axis: str = "yaw") -> "Law":
        """The law with the opposite curvature about one `axis`: left and right ("yaw") or up and down ("pitch")."""
        checked_choice("axis", axis, SECTION_COLUMN)
        return self._of(term.scaled(-1.0) if term.axis == axis else term for term in self.terms)

    def ramped_in(self, start: float, end: float) -> "Law":
        """The law, straight before `start` [s] and unchanged after `end` [s].

        A term that is 0 until `start` anyway is not changed.
        """
        start, end = _interval(start, end)
        return self._of(replace(term, envelope=begun(term.envelope, start, end)) for term in self.terms)

    def ramped_out(self, start: float, end: float) -> "Law":
        """The law, unchanged before `start` [s] and straight after `end` [s]."""
        start, end = _interval(start, end)
        envelopes = [ended(term.envelope, start, end) for term in self.terms]
        pairs = zip(self.terms, envelopes, strict=True)
        return self._of(replace(term, envelope=envelope) for term, envelope in pairs if envelope is not None)

    def followed_by(self, other: "Law", at: float, blend: float = 0.5) -> "Law":
        """This law until `at` [s], then `other`, whose own t = 0 lies there.

        From `at` on this law fades out over `blend` [s]. Terms of `other` that do not start from rest fade in during
        that time. The curvature is twice differentiable in time.
        """
        if not isinstance(other, Law):
            raise ValueError(f"the law that follows must be a Law, got {shown(other)}")
        at, blend = number("at", at), positive("blend", blend, "s")
        first, second = self.ramped_out(at, at + blend), other.delayed(at).ramped_in(at, at + blend)
        return Law(*first.terms, *second.terms, name=self.name, transition=self.transition)

    def _of(self, terms: Iterable[Term]) -> "Law":
        return Law(*terms, name=self.name, transition=self.transition)


def _interval(start: float, end: float) -> tuple[float, float]:
    start, end = number("start", start), number("end", end)
    if not end > start:
        raise ValueError(f"end must be > start ({start:g} s), got {end:g}")
    return start, end


def checked_name(value: object) -> str:
    """`value`, if it is a valid name of a law."""
    if not isinstance(value, str):
        raise ValueError(f"name must be a text, got {shown(value)}")
    if len(value) > MAXIMUM_NAME:
        raise ValueError(f"name must have at most {MAXIMUM_NAME} characters, got {len(value)}")
    return str(value)
