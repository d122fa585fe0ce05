# SPDX-License-Identifier: Apache-2.0
"""Points of a study: one run each, with named numbers of the gait, the scene, the body or the initial state.

| name | what it sets |
|---|---|
| `period`, ... | a number of the gait |
| `scene.fluid_density`, ... | a field of `Scene` |
| `body` | a `Body`, or the name of one |
| `body.lateral_drag`, `body.centre_of_mass_offset`, ... | a number of `Body` |
| `flow`, `flow.spacing`, ... | a `Flow`, or its text as of `eel simulate --flow`; a field of it |
| `fins`, `fins.area`, `fins.k_p`, ... | `Fin`s, or their text; a field of all, or a gain of their `RollHold` |
| `robot` | a `Robot`, its name or its file |
| `robot.kp`, `robot.tails.damping`, `robot.joint_3.kp` ... | a field of all parts that have it, of a kind, or of one |
| `accuracy` | as in `simulate` |
| `initial.position_x`, `_y`, `_z` | head at the start [m], world |
| `initial.omega_x`, ..., `initial.v_z` | twist of the head at the start [rad/s, m/s], its axes |
"""

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import fields, replace
from typing import Any

import numpy as np
from eel_common.files.input_file import reading
from eel_common.quantity import checked_instance, number
from eel_common.wording import did_you_mean, shown
from eel_dynamics.analysis.measures import AT_END, OF_LEDGER, OF_WRENCH, measures_of
from eel_dynamics.batches.simulate_batch import result_of
from eel_dynamics.model.body.body import MASSES, NUMBERS, Body, checked_body
from eel_dynamics.model.fins.fins import Fin, RollHold, checked_fins
from eel_dynamics.model.fins.text import GAINS, fins_from_text
from eel_dynamics.model.flow.plain import KINDS
from eel_dynamics.model.flow.text import flow_from_text
from eel_dynamics.model.initial_state import InitialState
from eel_dynamics.model.robot.robot import Robot, checked_robot, robot_of
from eel_dynamics.model.scene import checked_scene
from eel_dynamics.runs.sampling import checked_times
from eel_gaits.gaits.registry import find

from eel_dynamics import Accuracy, Flow, Run, Scene, Swim
from eel_gaits import Law

Gait = str | Callable[..., Law] | Swim  # its name, a function of numbers, or a whole swim, as of a scene's file
Numbers = dict[str, Any]  # by the names above
Measure = Callable[[Run], dict[str, Any]]  # run -> {name: number}
AccuracyLike = str | float | Accuracy
Stations = int | np.ndarray
Progress = Callable[[int, int], object] | bool | None  # as in `sweep`
GROUPS = "scene.", "body.", "initial."  # prefixes of their names
FLOW, FINS, ROBOT = "flow.", "fins.", "robot."
POSITIONS = ("position_x", "position_y", "position_z")
VELOCITIES = ("omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z")


def measured(run: Run, measure: Measure | tuple[str, ...], periods: int | None = None) -> dict[str, Any]:
    """The measures of `run`, over its last `periods` whole periods (None: the later half).

    measure: run -> {name: number}, or names of `MEASURES`.
    """
    return measure(run) if callable(measure) else measures_of(run, measure, periods)


def without_the_rest(point: Swim, measure: Measure | tuple[str, ...], every_sample: bool = True) -> Swim:
    """The `point` without ledger, internal wrench, and intermediate samples, unless a named measure reads them.

    every_sample: whether intermediate samples are kept anyway.
    """
    if callable(measure):
        return point
    ledger, wrench = (not of.isdisjoint(measure) for of in (OF_LEDGER, OF_WRENCH))
    scene = point.scene
    scene = replace(scene, ledger=scene.ledger and ledger, internal_wrench=scene.internal_wrench and wrench)
    point = point.unchecked(scene=scene)
    if every_sample or not AT_END.issuperset(measure):
        return point
    end = float(checked_times(point.duration, point.sample_period)[-1])
    return point.unchecked(duration=end, sample_period=end) if end else point


def run_of_point(point: Swim) -> Run:
    """Simulate one `point`. `SimulationStopped` if it stops early."""
    swim = result_of(point.observed())
    if swim.stopped is not None:
        raise swim.stopped
    return swim.run


def base_of(gait: Gait, friction: str = "printed", **given: Any) -> Swim:
    """The swim that the points of a study share: `gait`, if it is a whole swim, with the fields `given` but for None.

    A robot may be a name or a file. Without a body, its own is taken. friction: of the default scene. `ValueError`
    names a bad field.
    """
    base = gait if isinstance(gait, Swim) else Swim(scene=Scene(friction=friction))
    given = {name: value for name, value in given.items() if value is not None}
    if "robot" in given:
        robot = given["robot"]
        given["robot"] = robot = checked_robot(robot_of(robot) if isinstance(robot, str) else robot)
        if robot is not None and robot.body is not None:
            given = {"body": robot.body} | given
    for name, check in {"body": checked_body, "scene": checked_scene, "accuracy": Accuracy.of}.items():
        given |= {name: check(given[name])} if name in given else {}
    return base.unchecked(**given)  # points are checked as a whole


def point_at(values: Numbers, gait: Gait, numbers: Numbers, base: Swim) -> Swim:
    """The swim of these `values` by name. The rest comes from `numbers`, with the same names, and from `base`.

    gait: its name, a function of numbers that returns a law, or a whole swim. `ValueError` names the point and the
    fault.
    """
    if not (isinstance(gait, (str, Swim)) or callable(gait)):
        raise ValueError(
            f"gait must be the name of a gait, a function that returns a law, or a Swim, got {shown(gait)}"
        )
    at = ", ".join(f"{name}={label_of(value) if _named(value) else shown(value)}" for name, value in values.items())
    with reading(f"at {at}"):
        return _point({**checked_instance("numbers", numbers, Mapping), **values}, gait, base)


def law_of_terms(law: object) -> Law:
    """The `law` that a gait returned. `ValueError` for any other type: a `SampledLaw` has no terms."""
    if not isinstance(law, Law):
        raise ValueError(f"gait must return a Law, whose terms are known, got {shown(law)}")
    return law


def label_of(value: Any) -> Any:
    """The label of a value on its axis."""
    if _named(value):
        return value.name
    return value if isinstance(value, (bool, int, float, str)) else str(value)


def _named(value: object) -> bool:
    return isinstance(value, (Body, Accuracy, Robot))


def _point(values: Numbers, gait: Gait, base: Swim) -> Swim:
    body, accuracy, flow, fins, robot = base.body, base.accuracy, base.flow, base.fins, base.robot
    own: dict[str, Any] = {}
    groups: dict[str, dict[str, Any]] = {group.rstrip("."): {} for group in (*GROUPS, FLOW, FINS, ROBOT)}
    for name, value in values.items():
        group, _, field = name.partition(".")
        if field and group in groups:
            groups[group][field] = value
        elif name == "body":
            body = Body.named(value) if isinstance(value, str) else value
        elif name == "flow":
            flow = flow_from_text(value) if isinstance(value, str) else value
        elif name == "fins":
            fins = fins_from_text(value) if isinstance(value, str) else value
        elif name == "robot":
            robot = checked_robot(robot_of(value) if isinstance(value, str) else value)
            body = (robot and robot.body) or body
        elif name == "accuracy":
            accuracy = Accuracy.of(value)
        else:
            own[name] = value
    check_names("scene", groups["scene"], [item.name for item in fields(Scene)])
    check_names("body", groups["body"], (*NUMBERS, *MASSES))
    if groups["robot"]:
        robot = _robot_with(robot, groups["robot"])
    try:
        if isinstance(gait, Swim):
            of_gait = gait.fields_of_gait(own) if own else {"law": gait.law, "gait": gait.gait}
            law, base = of_gait["law"], base.unchecked(**of_gait)
        else:
            law = (find(gait) if isinstance(gait, str) else gait)(**own)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{error}{_of_robot(robot, own)}") from None
    body = body.changed(**groups["body"]) if groups["body"] else body
    scene = replace(base.scene, **groups["scene"]) if groups["scene"] else base.scene
    start = _start(base.start, groups["initial"])
    flow, fins = _flow_with(flow, groups["flow"]), fins_with(checked_fins(fins, body, scene), groups["fins"])
    changes = {"law": law, "body": body, "scene": scene, "accuracy": accuracy, "start": start}
    return base.changed(**changes, flow=flow, fins=fins, robot=robot)


def _of_robot(robot: Robot | None, numbers: Numbers) -> str:
    """A hint if one of the `numbers` that the gait lacks is a robot's."""
    for name, value in numbers.items():
        with suppress(ValueError, TypeError):
            _robot_with(robot, {name: value})
            return f"; that of the robot is {ROBOT}{name}"
    return ""


def _robot_with(robot: Robot | None, numbers: Numbers) -> Robot:
    if robot is None:
        raise ValueError(f"robot must be given for {', '.join(ROBOT + name for name in numbers)} to change, got none")
    return robot.with_numbers(numbers)


def fins_with(fins: tuple[Fin, ...], changes: Numbers) -> tuple[Fin, ...]:
    """The `fins` with changed fields, or changed gains of those that hold the roll."""
    if changes and not fins:
        raise ValueError(f"fins have no field {shown(next(iter(changes)))}: the scene has no fins")
    check_names("fins", changes, (*(item.name for item in fields(Fin)), *GAINS))
    gains = {name: value for name, value in changes.items() if name in GAINS}
    own = {name: value for name, value in changes.items() if name not in GAINS}
    if gains and not any(isinstance(fin.angle, RollHold) for fin in fins):
        raise ValueError(f"fins have no gain {shown(next(iter(gains)))}: none of them holds the roll")

    def changed(fin: Fin) -> Fin:
        held = {"angle": replace(fin.angle, **gains)} if isinstance(fin.angle, RollHold) else {}
        return replace(fin, **held | own)

    return tuple(changed(fin) for fin in fins)


def _flow_with(flow: Flow | None, changes: Numbers) -> Flow | None:
    """The `flow` with changed fields. A sum of flows cannot be changed, as its parts may share field names."""
    if not changes:
        return flow
    known = [item.name for item in fields(flow)] if type(flow) in KINDS.values() else []  # type: ignore[arg-type]
    if not known:
        raise ValueError(f"flow must be one built-in flow for {', '.join(changes)} to change, got {shown(flow)}")
    check_names("flow", changes, known)
    return replace(flow, **changes)  # type: ignore[type-var]


def _start(start: InitialState, changes: Numbers) -> InitialState:
    check_names("initial", changes, (*POSITIONS, *VELOCITIES))
    position, twist = start.position.copy(), start.twist.copy()
    for name, value in changes.items():
        row, names = (position, POSITIONS) if name in POSITIONS else (twist, VELOCITIES)
        row[names.index(name)] = number(f"initial.{name}", value)
    return start._replace(position=position, twist=twist)


def check_names(group: str, given: Numbers, known: Iterable[str]) -> None:
    """`ValueError` for one of the names `given` that the `group` does not have."""
    for name in given:
        if name not in known:
            hint = did_you_mean(name, known)
            raise ValueError(f"{group} has no field {shown(name)}{hint}, it has: {', '.join(known)}")
