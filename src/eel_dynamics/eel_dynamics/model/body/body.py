# SPDX-License-Identifier: Apache-2.0
"""The body: elliptic sections along a straight reference line (sections 3.3 and 7.2.1). It is homogeneous unless its
mass is given.

A section at X has the half-height a(X) along E3 (its major axis on the paper's robot) and the half-width b(X) along E2.
X runs from 0 at the nose to the length at the tail. The nose is pointed, a(0) = b(0) = 0, or blunt; neither sheds a
wake.
"""

import os
import warnings
from collections.abc import Callable, Iterable
from functools import cache, cached_property, lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.cell import cell_of
from eel_common.files.input_file import reading
from eel_common.files.tables import read_table
from eel_common.quantity import checked_choice, checked_instance, checked_row, number, positive
from eel_common.wording import shown
from numpy.typing import ArrayLike

from eel_dynamics.model.body.along import AlongBody, HalfAxis
from eel_dynamics.model.body.appendages import APART, Appendage, checked_appendages
from eel_dynamics.model.body.body_picture import lines_of_body, picture_of_body
from eel_dynamics.model.body.grid import Grid
from eel_dynamics.model.body.hull import BY_SHAPE, attached, cross_flow_by_shape, crossings, roundness_squared
from eel_dynamics.model.body.links import BLUNT, arguments_of_links
from eel_dynamics.model.body.moments import with_moments
from eel_dynamics.model.body.panels import panels_of
from eel_dynamics.model.body.shapes import KINKS, NamedHalfAxis
from eel_dynamics.model.equality import same

PANEL_OF_NOSE = 0.05  # of the length, for a body without named kinks
LONGEST = 100.0  # m: a longer body in a file may be in mm
PROFILES = ("lateral_drag", "vertical_drag", "lateral_added_mass")  # coefficients that may vary along the body
DRAGS = ("roll_drag", "friction_factor", "round_added_mass", "joint_drag", "base_drag", "appendage_factor")
NUMBERS = ("density", "nose_added_mass", "nose_drag", *DRAGS, *PROFILES)
COLUMNS, WHAT = ("x", "half_width", "half_height"), "body file "  # columns of a body file; WHAT begins an error
MASSES = "mass_per_length", "centre_of_mass_offset"  # its optional columns
UNITS = {**dict.fromkeys((*COLUMNS, MASSES[1]), "m"), MASSES[0]: "kg/m"}
WATER = 1000.0  # kg/m^3, default density of a body
THICK = 0.25  # of the greatest area: in thinner sections, which weigh little, the centre of mass may be outside
LARGEST = 1e6  # m, of a number in a file
POINTED_NOSE, BLUNT_NOSE = (0.32, 0.036), (4.0 / (3.0 * np.pi), 0.4)  # k and c_p: as printed; for one side of a disc
# (Lamb, Hydrodynamics, art. 102), and for a blunt cylinder along the flow without friction and base (Hoerner)
SHARP = 1e-3  # of the body's greatest half-axis: a smaller half-axis at the tail counts as 0


class Body:
    """Geometry and mass of a swimmer, and the coefficients of its drag. Immutable.

    `ValueError` names the bad argument and its value.

    Args:
        half_width, half_height: functions of X [m] that return m, or arrays [m] at `x`. The squares of arrays are
            interpolated by a monotone cubic between the kinks.
        length: [m]; with arrays it is the last `x`.
        x: [m], shape (M,), M >= 4, rising from 0 to the length; with arrays only.
        kinks: X [m] inside (0, length) where a half-axis or one of its derivatives jumps.
        nose: half-axes and length (a_o, b_o, c_o) [m] of the cap in m_o = rho_f pi k a_o b_o c_o and
            k_o = pi c_p a_o b_o; by default the half-axes at the end of the first panel, and its length. For a blunt
            nose the half-axes at X = 0, and sqrt(a_o b_o).
        blunt_nose: the section at X = 0 may be larger than 0. It sheds no wake: the water ahead has no momentum, so the
            face takes the force - V1 M_f V of the water that it sets in motion. The internal force at X = 0 is that
            force minus the nose's load.
        density: [kg/m^3], of a homogeneous body; by default that of water, 1000.
        mass_per_length: m(X) [kg/m] instead of a density: a number, a function of X that is smooth between the kinks,
            or an array at `x`. Each section's mass is distributed as in a homogeneous one.
        centre_of_mass_offset: h(X) [m], depth of the centre of mass below the section's centre, along its axis 3;
            given likewise. Gravity acts on it in a `Scene(weight=True)`; its effect on the inertia is always included.
        nose_added_mass: k; by default 0.32, for a blunt nose 4/(3 pi), one side of a disc.
        nose_drag: c_p; by default 0.036, for a blunt nose 0.4.
        roll_drag, lateral_drag, vertical_drag: c_1, c_2, c_3. The last two may vary along the body like a mass per
            length, or be "by shape": by the roundness of each section (eel_dynamics/model/body/hull.py).
        friction_factor: times the friction of a smooth plate at rest: a beating body has a thinner boundary layer
            (Lighthill, Proc. R. Soc. B 179 (1971): up to 4), and joints and gaps are rough.
        lateral_added_mass: times that of the ellipse, along axis 2: below 1 for gaps between links and round ends, 1.51
            for a square section instead of its inscribed circle (Newman, Marine Hydrodynamics, 1977, table 4.3). It may
            vary along the body.
        round_added_mass: C_a, added mass of a circular section / that of potential flow, along axes 2 and 3; a section
            between plate and circle has 1 - (1 - C_a) s^2 with its roundness s. 1 for attached flow; 0.2 for separated
            cross flow.
        joint_drag, link_length: c_s and p [m] of the drag of links, -1/2 rho_f c_s (A / p) abs(V) V1 per length: 0 for
            a smooth body, 0.87 if each link is an isolated blunt cylinder.
        base_drag: c_b, for the area at the tail's end, -1/2 rho_f c_b A(l) V1 abs(V1) there.
        appendages: of type `Appendage`, drag areas fixed to sections. appendage_factor: times all of these areas.
        name: of the body in messages.
    """

    def __init__(
        self,
        *,
        half_width: Any,
        half_height: Any,
        length: float | None = None,
        x: ArrayLike | None = None,
        kinks: ArrayLike = (),
        nose: tuple[float, float, float] | None = None,
        density: float | None = None,
        mass_per_length: Any = None,
        centre_of_mass_offset: Any = 0.0,
        nose_added_mass: float | None = None,
        nose_drag: float | None = None,
        roll_drag: float = 1.0,
        lateral_drag: Any = 1.98,
        vertical_drag: Any = 1.0,
        friction_factor: float = 1.0,
        lateral_added_mass: Any = 1.0,
        round_added_mass: float = 1.0,
        joint_drag: float = 0.0,
        link_length: float | None = None,
        base_drag: float = 0.0,
        appendage_factor: float = 1.0,
        blunt_nose: bool = False,
        appendages: Iterable[Appendage] = (),
        name: str = "body",
    ) -> None:
        if x is not None:
            x = checked_row("body x", x, None)
            falls = np.flatnonzero(np.diff(x) <= 0.0)
            if len(x) < 4 or len(falls) or x[0] != 0.0:
                ends = f" from {x[0]:g} to {x[-1]:g}" if len(x) else ""
                ends += f", {x[falls[0] + 1]:g} after {x[falls[0]]:g}" if len(falls) else ""
                raise ValueError(f"body x must rise from 0 over 4 points or more, got {len(x)} points{ends}")
            length = x[-1] if length is None else length
            if abs(x[-1] - positive("body length", length, "m")) > 1e-9 * x[-1]:
                raise ValueError(f"body x must end at the length {length} m, got {x[-1]}")
        elif length is None:
            raise ValueError("body length must be given, in m, where half_width and half_height are functions")
        self.length = float(x[-1]) if x is not None else positive("body length", length, "m")
        if density is not None and mass_per_length is not None:
            raise ValueError(f"body density must not be given beside mass_per_length, got {shown(density)}")
        self._density = positive("body density", WATER if density is None else density, "kg/m^3")
        self.name = checked_instance("body name", name, str)
        self.kinks = self._checked_kinks(kinks)
        self.blunt_nose = bool(checked_instance("body blunt_nose", blunt_nose, (bool, np.bool_)))
        self.appendages = checked_appendages(appendages, self.length)
        bounds = (0.0, *(self.kinks or (PANEL_OF_NOSE * self.length,)), self.length)
        self._half_width = HalfAxis("half_width", half_width, x, bounds, self.blunt_nose)
        self._half_height = HalfAxis("half_height", half_height, x, bounds, self.blunt_nose)
        self._mass: AlongBody | None = None
        if mass_per_length is not None:
            self._mass = AlongBody("body mass_per_length", "kg/m", mass_per_length, x, bounds, 0.0)
        self._offset = AlongBody("body centre_of_mass_offset", "m", centre_of_mass_offset, x, bounds)
        self.offset = self._checked_offset()
        self.nose = self._checked_nose(nose, bounds[1])
        k, c_p = BLUNT_NOSE if self.blunt_nose else POINTED_NOSE
        self.nose_added_mass = number(
            "body nose_added_mass", k if nose_added_mass is None else nose_added_mass, minimum=0.0
        )
        self.nose_drag = number("body nose_drag", c_p if nose_drag is None else nose_drag, minimum=0.0)
        self.roll_drag = number("body roll_drag", roll_drag, minimum=0.0)
        self.friction_factor = number("body friction_factor", friction_factor, minimum=0.0)
        self.round_added_mass = number("body round_added_mass", round_added_mass, minimum=0.0, maximum=1.0)
        self.joint_drag = number("body joint_drag", joint_drag, minimum=0.0)
        self.link_length = None if link_length is None else positive("body link_length", link_length, "m")
        if self.joint_drag and self.link_length is None:
            raise ValueError(f"body joint_drag needs a link_length, in m, got {self.joint_drag:g} and none")
        self.base_drag = number("body base_drag", base_drag, minimum=0.0)
        self.appendage_factor = number("body appendage_factor", appendage_factor, minimum=0.0)
        self._profiles = {
            name: None
            if isinstance(given, str) and given == BY_SHAPE
            else AlongBody(f"body {name}", "", given, x, bounds, 0.0)
            for name, given in zip(PROFILES, (lateral_drag, vertical_drag, lateral_added_mass), strict=True)
        }
        if self._profiles["lateral_added_mass"] is None:
            raise ValueError(f"body lateral_added_mass must be numbers, got {shown(BY_SHAPE)}: see round_added_mass")
        self.panel_ends = self._panel_ends(bounds)
        numbers = tuple(getattr(self, name) for name in ("nose_added_mass", "nose_drag", *DRAGS, "link_length"))
        self._hash = hash((self.name, self.length, self.kinks, self.nose, self._density, numbers, self.appendages))

    def plot(self) -> Any:
        """A matplotlib figure of the outlines, from above and from the side. `ImportError` without matplotlib."""
        return picture_of_body(self)

    def _repr_html_(self) -> str:
        return cell_of(self.plot, lines_of_body(self))

    def half_width(self, x: ArrayLike) -> np.ndarray:
        """b(X) [m] along E2 at `x` [m]."""
        return np.asarray(np.sqrt(self._half_width.square(np.asarray(x, dtype=float))))

    def half_height(self, x: ArrayLike) -> np.ndarray:
        """a(X) [m] along E3 at `x` [m]."""
        return np.asarray(np.sqrt(self._half_height.square(np.asarray(x, dtype=float))))

    @property
    def lateral_drag(self) -> Any:
        """c_2 as given."""
        return self._given("lateral_drag")

    @property
    def vertical_drag(self) -> Any:
        """c_3 as given."""
        return self._given("vertical_drag")

    @property
    def lateral_added_mass(self) -> Any:
        """The factor on the added mass along axis 2, as given."""
        return self._given("lateral_added_mass")

    def _given(self, name: str) -> Any:
        profile = self._profiles[name]
        return BY_SHAPE if profile is None else profile.given

    def cross_flow(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """c_2 and c_3 (n,) of the sections at `x` (n,) [m]."""
        lateral, vertical = self._profiles["lateral_drag"], self._profiles["vertical_drag"]
        if lateral is not None and vertical is not None:
            return lateral(x), vertical(x)
        by_shape = cross_flow_by_shape(*self._squares_behind(x))
        return by_shape[0] if lateral is None else lateral(x), by_shape[1] if vertical is None else vertical(x)

    def added_mass_factors(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Factors (n,) of the added mass along axes 2 and 3, relative to the ellipse's, at `x` (n,) [m]."""
        beta = (
            attached(self.round_added_mass, *self._squares_behind(x))
            if self.round_added_mass != 1.0
            else np.ones(len(x))
        )
        factor = self._profiles["lateral_added_mass"]
        assert factor is not None
        return factor(x) * beta, beta

    def added_mass_slopes(
        self, x: np.ndarray, squares: tuple[np.ndarray, ...], swapped: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives by X of squares of half-axes times `added_mass_factors`, (n,) each [m], at `x` (n,) [m].

        The square of the half-height belongs to axis 2, and that of the half-width to axis 3; the other way round if
        they are `swapped`. squares: those of `squares`, at `x`.
        """
        a, b, a_slope, b_slope = squares
        along2, along3 = ((b, b_slope), (a, a_slope)) if swapped else ((a, a_slope), (b, b_slope))
        factor = self._profiles["lateral_added_mass"]
        assert factor is not None
        slopes2, slopes3 = along2[1], along3[1]
        if self.round_added_mass != 1.0:
            near = self._squares_behind(x)
            most, s_squared = np.maximum(*near), roundness_squared(*near)
            beta = attached(self.round_added_mass, *near)
            least_slope, most_slope = np.where(near[0] < near[1], (a_slope, b_slope), (b_slope, a_slope))
            # square d(s^2)/dX with d(s^2)/dX = (least' - s^2 most') / most
            change = (1.0 - self.round_added_mass) * (least_slope - s_squared * most_slope)
            slopes2 = slopes2 * beta - (near[1] if swapped else near[0]) / most * change
            slopes3 = slopes3 * beta - (near[0] if swapped else near[1]) / most * change
        else:
            beta = np.ones(len(x))
        return factor(x) * slopes2 + factor.slope(x) * along2[0] * beta, slopes3

    def _squares_behind(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """a^2 and b^2 [m^2] at `x` (n,) [m], or just behind the nose, where their ratio has a limit."""
        behind = np.maximum(x, 1e-9 * self.length)
        return self._half_height.square(behind), self._half_width.square(behind)

    def mass_per_length(self, x: ArrayLike, density: float | None = None) -> np.ndarray:
        """m(X) [kg/m] at `x` [m]. density [kg/m^3]: of a scene, instead of a homogeneous body's own."""
        if self._mass is None:
            density = self._density if density is None else density
            return np.asarray(density * (np.pi * self.half_height(x) * self.half_width(x)))
        if density is not None:
            raise ValueError(f"scene density must be none for a body with mass_per_length, got {density:g} kg/m^3")
        return self._mass(x)

    def centre_of_mass_offset(self, x: ArrayLike) -> np.ndarray:
        """h(X) [m] at `x` [m]: depth of the centre of mass below the section's centre."""
        return self._offset(x)

    @property
    def half_axes(self) -> dict[str, Any]:
        """The half-axes as given: functions of X, or arrays (2, M) of X and half-axis [m]."""
        return {"half_width": self._half_width.given, "half_height": self._half_height.given}

    @property
    def breaks(self) -> np.ndarray:
        """X [m] inside the body where a derivative of a half-axis from data may jump: its data points."""
        return self._half_width.breaks

    def squares(self, x: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """a^2, b^2 [m^2] and their derivatives by X [m] at `x` (M,) [m]. At a kink, the derivative ahead of it."""
        at, height, width = np.asarray(x, dtype=float), self._half_height, self._half_width
        return height.square(at), width.square(at), height.slope(at), width.slope(at)

    @cached_property
    def pointed_tail(self) -> bool:
        """Whether the tail ends in an edge or a point: there a half-axis is 0, and the perimeter behaves like its
        root."""
        squares = np.array(self.squares(np.array([0.5 * self.length, self.length]))[:2])
        return bool(np.min(squares[:, 1]) <= SHARP**2 * np.max(squares))

    @cached_property
    def volume(self) -> float:
        """Integral of pi a b dX [m^3]."""
        grid = Grid.of(panels_of(self, resolution=40))
        if not len(self.breaks):
            return float(np.sum(grid.weight * np.pi * self.half_width(grid.x) * self.half_height(grid.x)))
        return self.integral(lambda x: np.pi * self.half_width(x)[None] * self.half_height(x))[0]

    def integral(self, fields: Callable[[np.ndarray], np.ndarray]) -> list[float]:
        """Integrals of `fields`, from X (n,) [m] to (m, n), over the body; fields are smooth between kinks and data."""
        grid = Grid.of(panels_of(self, resolution=40))
        values = with_moments(fields, grid, self.breaks) if len(self.breaks) else fields(grid.x)
        return list(map(float, values @ grid.weight))

    @property
    def mass(self) -> float:
        """Mass [kg] at the body's own density."""
        return self.mass_in(None)

    def mass_in(self, density: float | None) -> float:
        """Mass [kg] with the `density` [kg/m^3] that a scene sets; None: the body's own."""
        if self._mass is None:
            return self.volume * (self._density if density is None else density)
        return self.integral(lambda x: self.mass_per_length(x, density)[None])[0]

    @property
    def density(self) -> float:
        """Density [kg/m^3]; the mean density of a body with its own mass per length."""
        return self._density if self._mass is None else self.mass / self.volume

    @property
    def arguments(self) -> dict[str, Any]:
        """The arguments of an equal body."""
        shape = self.half_axes
        if len(self.breaks):
            shape = {"x": shape["half_width"][0], **{name: values[1] for name, values in shape.items()}}
        shape |= {name: getattr(self, name) for name in ("length", "kinks", "nose", "blunt_nose")}
        shape |= {"density": self._density if self._mass is None else None}
        own = {name: getattr(self, name) for name in (*NUMBERS[1:], "link_length", "appendages", "name")}
        masses = {"mass_per_length": self._mass and self._mass.given, "centre_of_mass_offset": self._offset.given}
        return shape | own | masses

    def changed(self, **changes: Any) -> "Body":
        """The same body with changed `arguments`."""
        own = self.arguments
        if unknown := [name for name in changes if name not in own]:
            raise ValueError(f"body has no {shown(unknown[0])}, it has: {', '.join(own)}")
        if changes.get("mass_per_length") is not None:
            own["density"] = None
        return Body(**own | changes)

    def __deepcopy__(self, memo: dict[int, Any]) -> "Body":  # immutable
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(Body, **self.arguments), ()

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Body) and same(self.arguments, other.arguments))

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        return f"Body({self.name!r}, length={self.length} m, density={self.density} kg/m^3)"

    @staticmethod
    @cache
    def boyer2010() -> "Body":
        """The eel-like robot of section 7.2.1: 1 m long, 1.944 kg."""
        return Body(**_named_shape("boyer2010", 1.0), nose=(0.025, 0.05, 0.05))

    @staticmethod
    def kern2006(length: float = 1.0) -> "Body":
        """The anguilliform swimmer of Kern and Koumoutsakos, J. Exp. Biol. 209 (2006): volume 0.0059326 length^3."""
        return Body._kern2006(positive("body length", length, "m"))

    @staticmethod
    @lru_cache(maxsize=64)
    def _kern2006(length: float) -> "Body":
        return Body(**_named_shape("kern2006", length))

    @staticmethod
    def spindle(length: float, slenderness: float) -> "Body":
        """A body with a round nose and a blunt tail of half the height. It is twice as high as wide.

        length: [m]. slenderness: length / (2 x greatest half-height).
        """
        length = positive("body length", length, "m")
        half = length / (2.0 * positive("body slenderness", slenderness))

        def half_height(x: np.ndarray) -> np.ndarray:
            s = np.asarray(x, dtype=float) / length
            return half * np.sqrt(np.clip(1.0 - np.clip(1.0 - s / 0.05, 0.0, None) ** 2, 0.0, None)) * (1.0 - 0.5 * s)

        return Body(
            length=length, half_width=lambda x: 0.5 * half_height(x), half_height=half_height, kinks=(0.05 * length,)
        )

    @staticmethod
    def of_links(
        length: float,
        number: int,
        half_width: float,
        half_height: float,
        *,
        joints: Any,
        nose: Any = BLUNT,
        tail: Any = BLUNT,
        mass: float | None = None,
        **others: Any,
    ) -> "Body":
        """A body of `number` links of one section, `length` [m] long in all, with the hull coefficients of such robots.

        half_width, half_height: along axes 2 and 3 [m]. joints: "flush", or the drag coefficient c_s of an isolated
        link, 0 to 0.87; there is no default, as only a test determines it (`eel identify`). nose: "blunt", or the
        length [m] of a quarter ellipse. tail: "blunt", or the length [m] over which its width falls to an edge. mass:
        [kg]; None: that of the displaced water. others: further arguments of `Body`, which override these. `ValueError`
        names a bad argument.
        """
        own = arguments_of_links(length, number, half_width, half_height, joints, nose, tail)
        body = Body(**own | others)
        return body if mass is None else body.changed(density=positive("body mass", mass, "kg") / body.volume)

    @staticmethod
    def named(name: str) -> "Body":
        """The body called `name`: boyer2010 or kern2006. `ValueError` for another name."""
        checked_choice("body", name, NAMED, "a file")
        made: Body = getattr(Body, name)()
        return made

    @staticmethod
    def from_file(path: str | os.PathLike[str]) -> "Body":
        """A body from columns x, half_width, half_height of a table with a header, or an .npz file, in m or in the
        units of their names: half_width_mm.

        It may also have the columns mass_per_length [kg/m] and centre_of_mass_offset [m].
        """
        if not isinstance(path, (str, os.PathLike)):
            raise ValueError(f"body file must be a path, got {shown(path)}")
        path = Path(path)
        with reading(f"{WHAT}{shown(str(path))}"):
            table = read_table(path, WHAT)
            if missing := [name for name in COLUMNS if name not in table]:
                raise table.error(f"a body must have columns {', '.join(COLUMNS)}; {', '.join(missing)} missing")
            columns: dict[str, Any] = {
                name: table.column(name, unit, LARGEST) for name, unit in UNITS.items() if name in table
            }
            body = Body(**columns, name=path.stem)
        table.tell()
        if body.length > LONGEST:
            warnings.warn(f"body file {path} is {body.length:g} m long: are its columns in m?", stacklevel=2)
        return body

    def _checked_kinks(self, kinks: ArrayLike) -> tuple[float, ...]:
        values = checked_row("body kinks", kinks, None)
        if np.any(np.diff(values) <= 0.0) or np.any(values <= 0.0) or np.any(values >= self.length):
            raise ValueError(f"body kinks must rise inside (0, {self.length}) m, got {shown(values.tolist())}")
        return tuple(values.tolist())

    def _checked_offset(self) -> bool:
        """Whether the centre of mass is off the axis. `ValueError` if it is outside the section."""
        x = np.linspace(0.0, self.length, 257)
        a, h = self.half_height(x), self._offset(x)
        area = a * self.half_width(x)
        outside = (np.abs(h) > a) & (area > THICK * area.max())
        if outside.any():
            first = np.flatnonzero(outside)[0]
            raise ValueError(
                f"body centre_of_mass_offset must lie within the section, {a[first]:.4g} m high at X = {x[first]:.4g} "
                f"m, got {h[first]:.6g} m"
            )
        return bool(h.any())

    def _panel_ends(self, bounds: tuple[float, ...]) -> tuple[float, ...]:
        """The kinks, the places of appendages, and the places where sections by shape change from high to wide."""
        ends = list(bounds[1:])
        by_shape = self.round_added_mass != 1.0 or None in self._profiles.values()
        for place in (
            *(each.x for each in self.appendages if any(each.drag)),
            *(crossings(self, bounds) if by_shape else ()),
        ):
            if min(abs(place - end) for end in (0.0, *ends)) > APART * self.length:
                ends.append(place)
        return tuple(sorted(ends))

    def _checked_nose(self, nose: ArrayLike | None, end: float) -> tuple[float, float, float]:
        if nose is None and self.blunt_nose:
            a, b = float(self.half_height(0.0)), float(self.half_width(0.0))
            return a, b, float(np.sqrt(a * b))
        if nose is None:
            return float(self.half_height(end)), float(self.half_width(end)), float(end)
        values = checked_row("body nose", nose, None)
        if values.shape != (3,) or np.any(values < 0.0):
            raise ValueError(f"body nose must be three lengths (a_o, b_o, c_o) >= 0 m, got {shown(nose)}")
        return tuple(values.tolist())


def checked_body(body: Any) -> Body:
    """`body`, if it is a `Body`; for None the body of Boyer, Porez and Leroyer 2010. `ValueError` for anything else."""
    if isinstance(body, (str, os.PathLike)):
        raise ValueError(
            f"body must be a Body, got {shown(body)}: Body.from_file(...) reads a file, and names are class methods "
            "such as Body.kern2006()"
        )
    return Body.boyer2010() if body is None else checked_instance("body", body, Body)


def _named_shape(name: str, length: float) -> dict[str, Any]:
    half_axes = {axis: NamedHalfAxis(name, axis, length) for axis in ("half_width", "half_height")}
    return {"name": name, "length": length, "kinks": tuple(kink * length for kink in KINKS[name]), **half_axes}


NAMED = tuple(KINKS)
