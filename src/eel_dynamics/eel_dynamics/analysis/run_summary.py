# SPDX-License-Identifier: Apache-2.0
"""The text of `Run.summary()`: the figures of a run with their units."""

import numpy as np

from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.analysis.trim import trim_of
from eel_dynamics.model.robot.actuators import at_limit

NOT_PROMISED = (  # errors that are measured, but not bounded by a target
    ("orientation", "orientation", " rad"),
    ("twist", "twist", ""),
    ("joint_angle", "joint angles", " rad"),
    ("joint_rate", "joint rates", ""),
)


def describe(run, periods: int | None = None) -> str:
    """Figures of the whole run, then those over the last `periods` whole periods (None: the later half of the run)."""
    limits = [f"beyond the model    {text}" for text in run.warnings]
    return "\n".join([*_of_the_run(run), *_of_the_gait(run, periods), *_of_the_cost(run), *limits])


def shown(value: float | None, digits: str = ".4g", unit: str = "") -> str:
    """A figure with its unit, or the word undefined."""
    return "undefined" if value is None else f"{value:{digits}} {unit}".rstrip()


def _of_the_run(run) -> list[str]:
    row = lambda values: "(" + ", ".join(f"{value:+.4f}" for value in values) + ")"  # noqa: E731
    about = getattr(run.law, "about", "")
    lines = [
        f"{run.law.name}: {run.body.name}, {run.body.length:g} m, {run.body_mass:.4g} kg, "
        f"{run.time[-1]:g} s, accuracy {run.accuracy.name}",
        *([f"motion              {about}"] if about else []),
        f"final position      {row(run.position[-1])} m",
        f"final orientation   {row(run.orientation[-1])} x y z w",
        f"head's path         {run.path_length:.4f} m",
        f"start to end        {np.linalg.norm(run.center_of_mass[-1] - run.center_of_mass[0]):.4f} m, centre of mass",
    ]
    if run.scene.weight:
        lines.append(f"weight              {trim_of(run.body, run.scene).about()}")
    if run.torque is not None:
        size, x, time = run.greatest_torque()
        lines.append(f"greatest torque     {size:.4g} N m at X = {x:.3f} m, t = {time:.3f} s")
    if run.robot is not None and run.robot.joints:
        joint = np.unravel_index(np.argmax(np.abs(run.motor_torque)), run.motor_torque.shape)[1]
        limited = at_limit(run.robot.servos, run.motor_torque, run.motor_power).mean(axis=0)
        lines.append(
            f"motors              greatest torque {np.max(np.abs(run.motor_torque)):.4g} N m "
            f"({run.robot.joints[joint].name}), at the limit for up to {limited.max():.0%} of the time"
        )
    if run.closure_torque is not None:
        lines.append(f"closure at the nose {np.max(run.closure_torque):.1e} N m, {np.max(run.closure_force):.1e} N")
    if run.energy is not None:
        e = run.energy
        kinetic = e.kinetic_body[-1] + e.kinetic_fluid[-1] - e.kinetic_body[0] - e.kinetic_fluid[0]
        potential = f"potential {e.potential[-1] - e.potential[0]:+.4g}, " if np.any(e.potential) else ""
        if run.robot is not None:
            potential += f"springs {e.elastic[-1] - e.elastic[0]:+.4g}, dampers {e.damping_work[-1]:+.4g}, "
        lines.append(
            f"energy [J]          actuators {e.actuator_work[-1]:+.4g}, wake {e.wake_work[-1]:+.4g}, "
            f"nose {e.nose_work[-1]:+.4g}, "
            f"drag {e.drag_work[-1]:+.4g}, kinetic {kinetic:+.4g}, {potential}residual {e.residual[-1]:+.1e}"
        )
    return lines


def _of_the_gait(run, periods: int | None) -> list[str]:
    try:
        a = Analysis(run, periods)
    except ValueError as error:
        if periods is not None:
            raise
        return [f"gait                undefined: {error}"]
    window = a.window
    lines = [
        f"over the last       {window.periods} x {window.period:g} s, {window.start:g} to {window.end:g} s",
        f"mean speed U        {shown(a.mean_speed, '.4f', 'm/s')}, period-averaged centre of mass over the water",
        f"gait                {_of_settling(a)}",
        f"stride U T/l        {shown(a.stride)}, slip U T/lambda {shown(a.slip)}",
    ]
    try:
        lines.append(
            f"Strouhal f A/U      {shown(a.strouhal)} with A = {shown(a.tail_excursion, '.4f', 'm')}, "
            f"swimming number {shown(a.swimming_number, '.3g')}, Reynolds {shown(a.reynolds, '.3g')}"
        )
    except ValueError as error:
        lines.append(f"Strouhal f A/U      undefined: {error}")
    return [*lines, *_of_the_power(a), *_of_the_torque(a)]


def _of_settling(a: Analysis) -> str:
    if not a.moves:
        return "at rest"
    return f"{'settled' if a.settled else 'NOT settled'}: {a.settling}"


def _of_the_power(a: Analysis) -> list[str]:
    run = a.run
    if run.energy is None:
        return []
    lines = [f"actuator power      mean {a.actuator_power:.4g} W net, peak {a.peak_actuator_power:.4g} W"]
    if run.torque is not None and run.x[0] == 0.0 and run.x[-1] == run.body.length:
        lines[0] += (
            f"; positive part: mean {a.positive_actuator_power:.4g} W, peak {a.peak_positive_actuator_power:.4g} W"
        )
    return [
        *lines,
        f"power of the water  wake {a.wake_power:.4g} W, axial friction {a.friction_power:.4g} W, "
        f"nose {a.nose_power:.4g} W",
        f"cost of transport   {shown(a.cost_of_transport, '.4g', 'J/(kg m)')}, by the weight "
        f"{shown(a.specific_cost_of_transport)}",
        f"efficiency          hydromechanical {shown(a.hydromechanical_efficiency)}, "
        f"propulsive {shown(a.propulsive_efficiency)}" + (" (the tail leads)" if a.tail_leads else ""),
    ]


def _of_the_torque(a: Analysis) -> list[str]:
    if a.run.torque is None:
        return []
    peak, rms, x = a.peak_torque, a.rms_torque, a.run.x
    return [
        f"torque along X      peak {np.max(peak):.4g} N m at {x[np.argmax(peak)]:.3f} m, "
        f"RMS {np.max(rms):.4g} N m at {x[np.argmax(rms)]:.3f} m"
    ]


def _of_the_cost(run) -> list[str]:
    lines = [f"cost                {run.steps} steps, {run.evaluations} evaluations of the head's dynamics"]
    lines = lines if run.evaluations else []  # unknown for a bag
    error = run.error_estimate
    if error is not None:
        torque = "" if error.torque is None else f", of the torque {error.torque:.1e}"
        rows = "" if error.resampling is None else f", {error.resampling:.1e} of it from the law's rows"
        lines.append(
            f"estimated error     of the position {error.position:.1e}{torque}{rows}; "
            f"it took {error.evaluations} evaluations"
        )
        known = error.errors
        further = [f"{words} {known[name]:.1e}{unit}" for name, words, unit in NOT_PROMISED if name in known]
        lines += [f"not promised        {', '.join(further)}"] if further else []
    return lines
