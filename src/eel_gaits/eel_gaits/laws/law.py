# SPDX-License-Identifier: Apache-2.0
"""Curvature laws: the commanded curvature of the body, with exact first and second time derivatives.

A law is a sum of terms. Each term is a wave in pitch (K2) or yaw (K3) of the backbone:

    K(t, X) = sum over terms of  envelope(t) amplitude(X) sin(2 pi (X / wavelength - t / period) + phase)

A quotient is dropped where its divisor is 0. An envelope is a sum of ramps. Equations (62) to (66) of Boyer, Porez and
Leroyer, J. Nonlinear Sci. 20 (2010), 47-79, doi:10.1007/s00332-009-9050-5, are such a sum.

Section axes (the paper's): 1 along the backbone from head to tail, 2 lateral, 3 up. K2 > 0 bends the tail down,
K3 > 0 bends it towards +2. X runs from 0 at the nose to the body's length at the tail.
"""

from dataclasses import dataclass

import numpy as np

from eel_gaits.input_output.quantity import number, numbers
from eel_gaits.input_output.wording import shown
from eel_gaits.laws.term import AXES, Term

MAXIMUM_TERMS = 1000
MAXIMUM_NAME = 200  # characters


@dataclass(frozen=True, init=False)
class Law:
    """A curvature law: the sum of its terms. A law without terms is the straight body.

    Law(one, two) and Law([one, two]) are the same law of two terms. `ValueError` names an attribute that does not fit.

    Attributes:
        terms: at most 1000.
        name: the law's name in messages and plots, at most 200 characters.
        transition: [s], duration of the blend from a swimmer's present motion to the law; 0 for the receiver's default.
    """

    terms: tuple[Term, ...]
    name: str
    transition: float

    def __init__(self, *terms, name="law", transition=0.0):
        if len(terms) == 1 and isinstance(terms[0], (list, tuple)):
            (terms,) = terms
        if len(terms) > MAXIMUM_TERMS:
            raise ValueError(f"terms must be at most {MAXIMUM_TERMS}, got {len(terms)}")
        for index, term in enumerate(terms):
            if not isinstance(term, Term):
                raise ValueError(f"terms[{index}] must be a Term, got {shown(term)}")
        transition = number("transition", transition)
        if transition < 0.0:
            raise ValueError(f"transition must be >= 0 s, got {transition}")
        object.__setattr__(self, "terms", tuple(terms))
        object.__setattr__(self, "name", _name(name))
        object.__setattr__(self, "transition", transition)

    def __hash__(self):  # kept: tables are looked up by it
        found = self.__dict__.get("_hash")
        if found is None:
            found = hash((self.terms, self.name, self.transition))
            object.__setattr__(self, "_hash", found)
        return found

    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name != "_hash"}  # of this process's strings

    def __repr__(self):
        count = f"{len(self.terms)} term{'' if len(self.terms) == 1 else 's'}"
        return f"Law({shown(self.name)}, {count}{f', transition={self.transition:g} s' if self.transition else ''})"

    @property
    def in_plane(self) -> bool:
        """Whether the body bends only in yaw."""
        return all(term.axis == "yaw" for term in self.terms)

    def curvature(self, time, x):
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
            total[:, :, AXES[term.axis]] += term.curvature(time, x)
        return total[0], total[1], total[2]


def _name(value):
    if not isinstance(value, str):
        raise ValueError(f"name must be a text, got {shown(value)}")
    if len(value) > MAXIMUM_NAME:
        raise ValueError(f"name must have at most {MAXIMUM_NAME} characters, got {len(value)}")
    return str(value)
