# SPDX-License-Identifier: Apache-2.0
"""The measures of a run: one number per measure, with its unit and definition."""

from contextlib import suppress
from typing import Any

import numpy as np
from eel_common.quantity import checked_choice

from eel_dynamics.analysis.analysis import Analysis

ANALYSIS, ESTIMATE = "analysis", "error estimate"  # parts of a run


MEASURES: dict[
    str, tuple[str, str, Any]
] = {  # name: (unit, description, source: a function of the run, or the part with an attribute of this name)
    "head_x": ("m", "head at the end, world axes", lambda run: run.position[-1, 0]),
    "head_y": ("m", "head at the end, world axes", lambda run: run.position[-1, 1]),
    "head_z": ("m", "head at the end, world axes", lambda run: run.position[-1, 2]),
    "duration": ("s", "time of the last sample", lambda run: run.time[-1]),
    "path_length": ("m", "length of the head's path through the samples", lambda run: run.path_length),
    "mean_speed": ("m/s", "U: period-averaged centre of mass over the water, later half", ANALYSIS),
    "speed_change": ("", "change of U within the later half, relative", ANALYSIS),
    "settled": ("", "1 where the gait had settled in the later half, 0 where not", ANALYSIS),
    "stride": ("", "body lengths per period, later half", ANALYSIS),
    "slip": ("", "speed relative to that of the wave along the body, later half", ANALYSIS),
    "tail_excursion": ("m", "peak-to-peak excursion of the tail, later half", ANALYSIS),
    "strouhal": ("", "frequency times excursion by speed, later half", ANALYSIS),
    "reynolds": ("", "speed times length by viscosity, later half", ANALYSIS),
    "actuator_power": ("W", "mean power of the actuators, later half", ANALYSIS),
    "actuator_work": (
        "J",
        "work of the actuators over the run",
        lambda run: run.energy and run.energy.actuator_work[-1],
    ),
    "cost_of_transport": ("J/(kg m)", "work of the actuators by mass and way, later half", ANALYSIS),
    "hydromechanical_efficiency": ("", "part of the work not shed into the wake, later half", ANALYSIS),
    "propulsive_efficiency": ("", "part of the work that overcomes the drag of going ahead, later half", ANALYSIS),
    "greatest_torque": (
        "N m",
        "greatest internal torque over the run and the body",
        lambda run: None if run.torque is None else run.greatest_torque()[0],
    ),
    "ledger_residual": (
        "J",
        "greatest residual of the energy ledger",
        lambda run: run.energy and np.max(np.abs(run.energy.residual)),
    ),
    "error_position": ("", "estimated relative error of the head's position", ESTIMATE),
    "error_torque": ("", "estimated relative error of the internal torque", ESTIMATE),
    "error_growth_rate": ("1/s", "rate at which errors grow", ESTIMATE),
    "evaluations": ("", "evaluations of the head's dynamics", lambda run: run.evaluations),
}
OF_ESTIMATE = tuple(name for name, (_, _, where) in MEASURES.items() if where == ESTIMATE)
# Data that a run needs for a measure, besides its motion:
OF_WRENCH = frozenset(("greatest_torque", "error_torque"))
OF_LEDGER = frozenset(
    (
        "actuator_power",
        "actuator_work",
        "cost_of_transport",
        "hydromechanical_efficiency",
        "propulsive_efficiency",
        "ledger_residual",
    )
)
AT_END = frozenset(("head_x", "head_y", "head_z", "duration", "evaluations"))  # need only the last sample


def measures_of(run, names=tuple(MEASURES), periods: int | None = None) -> dict[str, float]:
    """The measures `names` of `run`; NaN if undefined, or if the run lacks the data.

    periods: whole periods at the run's end instead of its later half.
    """

    analysis: Any = None
    if any(MEASURES[name][2] == ANALYSIS for name in names):
        with suppress(ValueError):  # the gait has no period, or the run is too short
            analysis = Analysis(run, periods)

    def measure(name: str) -> Any:
        where = MEASURES[name][2]
        if where == ESTIMATE:
            return getattr(run.error_estimate, name.removeprefix("error_"), None)
        try:
            return (analysis and getattr(analysis, name)) if where == ANALYSIS else where(run)
        except ValueError:  # the scene has no ledger or no wrench
            return None

    found = {name: measure(name) for name in names}
    return {name: float("nan") if value is None else float(value) for name, value in found.items()}


def checked_measures(argument: str, names, estimate: bool = True) -> tuple[str, ...]:
    """The `names` of measures as a tuple; None: all measures of a run with or without error estimate.

    `ValueError` that names the `argument` for an unknown measure, and for one of the error without an estimate.
    """
    if names is None:
        return tuple(name for name in MEASURES if estimate or name not in OF_ESTIMATE)
    names = tuple(names) if np.iterable(names) and not isinstance(names, str) else (names,)
    for name in names:
        checked_choice(argument, name, MEASURES)
        if name in OF_ESTIMATE and not estimate:
            raise ValueError(f"{argument} {name} needs the error estimate, which is off")
    return names


def described(name: str) -> dict[str, str]:
    """Unit and description of a measure, as attributes of a labelled array; empty for a name not in `MEASURES`."""
    if name not in MEASURES:
        return {}
    unit, description, _ = MEASURES[name]
    return {"units": unit or "1", "long_name": description}
