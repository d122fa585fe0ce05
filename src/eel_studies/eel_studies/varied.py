# SPDX-License-Identifier: Apache-2.0
"""Numbers of a swim by name, in addition to those of `points`, for the axes of maps. A new one is a line of `OWN`.

| name | what it sets |
|---|---|
| `period`, `scene.viscosity`, `flow.core`, `fins.area`, `robot.kp`, `initial.v_x`, `accuracy` ... | as in `points` |
| `amplitude` | factor of the law's curvature |
| `density_ratio` | density of the body / density of the water |
| `spin` | turns/s of the head, the same about all three axes |
| `flow_speed` | m/s: size of the flow's velocity |
| `step` | s: fixed steps of the classical method |
| `tolerance`, `resolution`, `method` | settings given one by one |

The duration scales with the period, so that a map shows the same number of periods everywhere.
"""

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
from eel_common.quantity import number
from eel_common.wording import shown
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.model.flow.plain import KINDS
from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.kinds import KINDS as PARTS_OF_ROBOT
from eel_gaits.gaits.registry import GAITS

from eel_dynamics import Accuracy, Scene, Swim
from eel_studies.points import POSITIONS, VELOCITIES, point_at

PARTS = Scene, Fin, RollHold, Servo, *PARTS_OF_ROBOT.values()  # whose numbers have units
UNITS = {"spin": "turns/s", "flow_speed": "m/s", "step": "s", "centre_of_mass_offset": "m", "mass_per_length": "kg/m"}
UNITS |= dict.fromkeys(POSITIONS, "m") | dict(zip(VELOCITIES, ("rad/s",) * 3 + ("m/s",) * 3, strict=True))
RESOLUTION = 36.0  # points per body length for given settings in time: the error in space stays below 1e-3


def varied(swim: Swim, values: dict[str, Any]) -> Swim:
    """The `swim` with these `values` by name. `ValueError` for an unsuitable one."""
    period = _longest_period(swim)
    swim = point_at({name: value for name, value in values.items() if name not in OWN}, swim, {}, swim)
    for name, value in values.items():
        if name in OWN:
            swim = swim.changed(**OWN[name](swim, value))
    if period and isinstance(swim.duration, float) and (now := _longest_period(swim)) != period:
        swim = swim.changed(duration=swim.duration * now / period)
    return swim


def labelled(name: str) -> str:
    """The `name` of a number for an axis, with its unit in brackets unless that depends on the part."""
    group, _, field = name.rpartition(".")
    gaits = () if group else (gait.numbers for gait in GAITS.values())
    kinds = KINDS.values() if group == "flow" else (*PARTS, *gaits)
    units = {item.metadata.get("unit") for kind in kinds for item in fields(kind) if item.name == field}
    unit = UNITS.get(field) or (units.pop() if len(units) == 1 else "")
    return f"{name} [{unit}]" if unit else name


def _longest_period(swim: Swim) -> float:
    return max((term.period for term in getattr(swim.law, "waves", ())), default=0.0)


def _flow_speed(swim: Swim, value: float) -> dict[str, Any]:
    velocity = np.array(getattr(swim.flow, "velocity", (0.0, 0.0, 0.0)))
    if not velocity.any():
        raise ValueError(f"flow_speed needs a flow with a velocity, got {shown(swim.flow)}")
    return {"flow": replace(swim.flow, velocity=tuple(value * velocity / np.linalg.norm(velocity)))}  # type: ignore


def _settings(swim: Swim, **changes: Any) -> dict[str, Any]:
    given = Accuracy.of(swim.accuracy)
    if given.target is not None:
        given = Accuracy(name="settings", resolution=RESOLUTION)
    return {"accuracy": replace(given, **changes)}


OWN: dict[str, Callable[[Swim, Any], dict[str, Any]]] = {  # name: (swim, value) -> fields of the swim
    "amplitude": lambda swim, value: {"law": swim.law * value},
    "density_ratio": lambda swim, value: {"scene": replace(swim.scene, density=value * swim.scene.fluid_density)},
    "spin": lambda swim, value: {
        "start": swim.start._replace(
            twist=np.concatenate((np.full(3, 2.0 * np.pi * value / np.sqrt(3.0)), swim.start.twist[3:]))
        )
    },
    "flow_speed": _flow_speed,
    "step": lambda swim, value: _settings(swim, step=number("step", value), order=None),
    "tolerance": lambda swim, value: _settings(swim, tolerance=number("tolerance", value)),
    "resolution": lambda swim, value: _settings(swim, resolution=number("resolution", value)),
    "method": lambda swim, value: _settings(swim, method=value[0], order=value[1]),
}
NAMES = (
    "of the gait; scene., body., initial., flow., robot. or fins. with a field; amplitude, density_ratio, flow_speed, "
    "spin, step, tolerance, resolution"
)
