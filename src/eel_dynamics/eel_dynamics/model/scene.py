# SPDX-License-Identifier: Apache-2.0
"""The physics that a run models, and the water. A part that is off costs nothing.

The switches name the parts of the model of Boyer, Porez and Leroyer (2010): reactive (added mass, wake: eq. 36-37, 60),
resistive (section 7.2.1), nose (section 7.2.1), and the readings of its printed formulae.

`metacentric_height` is our own: each section's weight acts that far below its buoyancy, along its own axis 3. Weight
and buoyancy are equal, so they are only a torque, m g h (e3 x up) per length, with the potential energy m g h (1 - e3 .
up). It rights the body in roll and in pitch; in a planar scene it has no effect. Only this moment is
modelled: the mass stays on the backbone. A mass below it would also lag behind a sideways acceleration a, and roll the
section by m h a per length; the moment of inertia in roll would be m h^2 larger. Without these two effects, the square
of the roll's frequency is 7 % too high at h = 10 mm on the robot and 28 % at 20 mm, and the path of the falling gait at
10 mm differs by 14 mm after 4 s. The term is valid for m h^2 << J1 + J_f1 and a << g roll.

`weight` includes these effects, and more: gravity acts on the body's own mass per length, at its
`centre_of_mass_offset` below each section's centre, and buoyancy on the volume (eel_core/loads/weight.hpp). Such bodies
sink, trim, and come to rest. Without it, `density` and `mass_per_length` are only inertia.

Without `wake` each section keeps its own water. The balance of the strips (50) then lacks the terms d/dX of V1 sigma_f
and of V1 p_f - T_f t1, and their sum at the tail: the momentum flux and the pressure of eq. (51) and (60). The model is
then a chain of bodies in a perfect fluid (Kirchhoff), which sheds nothing. Only drag, and the printed load of the nose,
change the momentum of body and water, and the thrust of Lighthill's theory is gone. Such a run shows how much of a
motion is due to the wake. It is not a model of a fish.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Self

from eel_common.quantity import Quantities, checked_instance, documented, quantity
from eel_common.wording import did_you_mean, shown

import eel_core

FRICTION = (*eel_core.FRICTION_LAWS, "none")
ROUGH_FRICTION = ("blended", "taylor")  # laws that are not analytic along the body, and need more points
PERIMETER = ("ellipse", "printed")
ADDED_MASS = ("corrected", "printed")
TAIL_PRESSURE = ("lumped", "distributed")


@documented
@dataclass(frozen=True, kw_only=True, repr=False)
class Scene(Quantities):
    """Physics of a run. Immutable; every field has a default. `ValueError` names a bad field."""

    what: ClassVar[str] = "scene"

    planar: bool = quantity(
        False, "", "motion in the plane z = 0 only: one angle in place of a rotation; a pitch term is refused"
    )
    reactive: bool = quantity(True, "", "inertia of the water: added mass M_f, J_f, wake, nose's added mass m_o")
    added_inertia: bool = quantity(
        True, "", "momentum of the added mass, which the body accelerates; off: the wake's load at the tail alone"
    )
    wake: bool = quantity(
        True, "", "momentum that the water carries along the body and off at the tail; off: a section keeps its water"
    )
    resistive: bool = quantity(True, "", "drag of the water: k_o, k1 (friction), k2, k3 (cross flow), k4 (roll)")
    cross_flow: bool = quantity(True, "", "drag across the body and in roll: k2, k3, k4")
    friction: str = quantity("printed", "", "law of the axial friction c_f(Re)", choices=FRICTION)
    nose: bool = quantity(True, "", "loads on the rounded nose: added mass m_o and drag k_o")
    perimeter: str = quantity(
        "ellipse", "", "perimeter of a section: the ellipse's, or half of it as printed", choices=PERIMETER
    )
    added_mass: str = quantity(
        "corrected",
        "",
        "added mass across each half-axis: the ellipse's, or swapped as printed in eq. (37)",
        choices=ADDED_MASS,
    )
    metacentric_height: float = quantity(
        0.0,
        "m",
        "height of each section's buoyancy above its weight, along its axis 3: a moment that rights roll and pitch; "
        "below 0: top-heavy; 0: none",
    )
    weight: bool = quantity(
        False, "", "gravity and buoyancy of the body's mass and volume; off: its mass is inertia alone"
    )
    internal_wrench: bool = quantity(True, "", "internal force and torque along the body at output instants")
    ledger: bool = quantity(True, "", "energy ledger, integrated along with the motion")
    tail_pressure: str = quantity(
        "lumped",
        "",
        "pressure force of the water behind: -T_f t1 at the tail, or -d/dX(T_f t1) along the body",
        choices=TAIL_PRESSURE,
    )
    current: tuple[float, float, float] = quantity(
        (0.0, 0.0, 0.0), "m/s", "uniform velocity (x, y, z) of the water, world frame; against the eel: x < 0"
    )
    density: float | None = quantity(
        None, "kg/m^3", "density of the body, overrides the body's own", 0.0, exclusive=True
    )
    flow_gradient: bool = quantity(
        True, "", "forces by the gradient g of a flow, -g^T p and rho_f A g u; off: of its rate du/dt alone"
    )
    fluid_density: float = quantity(1000.0, "kg/m^3", "density of the water", 0.0)
    viscosity: float = quantity(1e-6, "m^2/s", "kinematic viscosity of the water", 0.0)

    def changed(self, values: Mapping[str, Any]) -> Self:
        """The same with these `values` of fields by name. `ValueError` names an unknown one."""
        known = [item.name for item in fields(self)]
        for name in values:
            if name not in known:
                hint = did_you_mean(name, known)
                raise ValueError(f"scene has no field {shown(name)}{hint}, it has: {', '.join(known)}")
        return replace(self, **values)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.weight and self.metacentric_height:
            raise ValueError(
                f"scene metacentric_height must be 0 m where weight is on, got {self.metacentric_height} m: give the "
                "body a centre_of_mass_offset"
            )
        if self.planar and self.current[2] != 0.0:
            raise ValueError(f"scene current must lie in the plane z = 0 of a planar scene, got {shown(self.current)}")


OF_PAPER = Scene()  # the default scene


def checked_scene(scene: Any) -> Scene:
    """`scene`, if it is a `Scene`; for None the paper's. `ValueError` for anything else."""
    found: Scene = OF_PAPER if scene is None else checked_instance("scene", scene, Scene)
    return found
