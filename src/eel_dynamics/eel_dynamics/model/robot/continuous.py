# SPDX-License-Identifier: Apache-2.0
"""Parts of the body that bend continuously: a passive tail, and a body with muscles.

Their curvature is a sum of Legendre polynomials over the part. Per section the moment is

    EI K + eta dK/dt - moment(t, X),

EI: `bending_stiffness`, eta: `damping`, K: the curvature in section axes (positive: down, to the right).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
from eel_common.quantity import checked_instance, checked_row, documented, quantity, required
from eel_common.wording import shown
from eel_gaits.laws.law import Law

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.part import MOST_MODES, Part

Profile = float | Callable[..., object]


@dataclass(frozen=True)
class ProfileTable:
    """Values (n,) at `x` (n,) [m], rising, two or more, as a function of X: monotone cubics through them."""

    x: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        x, values = checked_row("table x", self.x, None), checked_row("table values", self.values, None)
        if len(x) < 2 or not (np.diff(x) > 0.0).all():
            raise ValueError(f"table x must be two numbers or more that rise, got {shown(x.tolist())}")
        if len(values) != len(x):
            raise ValueError(f"table values must be as many as x, {len(x)}, got {len(values)}")
        object.__setattr__(self, "x", tuple(x.tolist()))
        object.__setattr__(self, "values", tuple(values.tolist()))

    def __call__(self, x: Any) -> np.ndarray:
        """The value at `x` [m]; the first and the last value are held."""
        from scipy.interpolate import pchip_interpolate

        return np.asarray(pchip_interpolate(self.x, self.values, np.clip(x, self.x[0], self.x[-1])))


class ContinuousPart(Part):
    """Base of passive tails and muscles."""

    start: float
    end: float | None
    modes: int

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.axis not in ("yaw", "pitch"):
            raise ValueError(f"{self.what} axis must be yaw or pitch, got {shown(self.axis)}")
        if self.end is not None and self.end <= self.start:
            raise ValueError(f"{self.what} end must be > start ({self.start:g} m), got {self.end:g}")
        if not isinstance(self.name, str) or not self.name:
            raise ValueError(f"{self.what} name must be a text, got {shown(self.name)}")

    @property
    def support(self) -> tuple[float, float]:
        assert self.end is not None
        return self.start, self.end

    @property
    def place(self) -> float:
        return self.start

    @property
    def degrees(self) -> Sequence[int]:
        return range(self.modes)

    @property
    def geometry(self) -> tuple[Any, ...]:
        return type(self), self.start, self.end, self.modes, self.axis

    def located(self, beside: Sequence[float], body: Body) -> Self:
        return self if self.end is not None else replace(self, end=body.length)  # type: ignore[call-arg]  # a field below

    def check_place(self, body: Body) -> None:
        start, end = self.support
        if end > body.length or start >= body.length:
            called = f"{self.what} {shown(self.name)} start and end"
            raise ValueError(f"{called} must lie in 0 to {body.length:g} m, got {start:g} to {end:g}")


@documented
@dataclass(frozen=True, repr=False)
class PassiveTail(ContinuousPart):
    """A part that only springs and dampers keep straight, up to the tail or to `end`. Immutable.

    `ValueError` names a bad field.
    """

    what: ClassVar[str] = "passive tail"
    key: ClassVar[str] = "tails"

    start: float = required("m", "X where it begins", 0.0)
    bending_stiffness: Profile = required("N m^2", "EI, a number or a function of X [m]", 0.0, profile=True)
    damping: Profile = quantity(0.0, "N m^2 s", "eta, a number or a function of X [m]", 0.0, profile=True)
    modes: int = quantity(4, "", "Legendre polynomials of the curvature", 1, MOST_MODES, whole=True)
    end: float | None = quantity(None, "m", "X where it ends; None: the tail", 0.0, exclusive=True)
    axis: str = quantity("yaw", "", "yaw or pitch", plain=True)
    name: str = quantity("tail", "", "in messages and tables", plain=True)


@documented
@dataclass(frozen=True, repr=False)
class Muscle(ContinuousPart):
    """A part that muscles bend against its own stiffness. Immutable; `ValueError` names a bad field."""

    what: ClassVar[str] = "muscle"
    key: ClassVar[str] = "muscles"

    start: float = required("m", "X where it begins", 0.0)
    end: float = required("m", "X where it ends", 0.0, exclusive=True)
    bending_stiffness: Profile = required("N m^2", "EI, a number or a function of X [m]", 0.0, profile=True)
    damping: Profile = required("N m^2 s", "eta, a number or a function of X [m]", 0.0, profile=True)
    moment: Law = required("", "a Law whose amplitudes are N m in place of rad/m", plain=True)
    modes: int = quantity(6, "", "Legendre polynomials of the curvature", 1, MOST_MODES, whole=True)
    axis: str = quantity("yaw", "", "yaw or pitch", plain=True)
    name: str = quantity("muscle", "", "in messages and tables", plain=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        other = {term.axis for term in checked_instance("muscle moment", self.moment, Law).terms} - {self.axis}
        if other:
            raise ValueError(f"muscle moment must have terms in {self.axis} alone, got {', '.join(other)}")
