# SPDX-License-Identifier: Apache-2.0
"""Robots as files and as plain values. An error names file, line and key.

    name: my_robot
    body: fish.csv                    # a file in the same folder, or a name; by default any body
    joints:
      - position: [0.10, 0.22, 0.34]  # m; joints that are otherwise equal
        servo: {kp: 13.8, kd: 0.37, torque_limit: 3.0, speed_limit: 8.06}
      - {position: 0.5, stiffness: 2.0, damping: 0.01, limits: [-0.8, 0.8]}
    tails:
      - {start: 0.6, bending_stiffness: 0.6, damping: 0.01, modes: 4}
    muscles:
      - {start: 0.2, end: 0.5, bending_stiffness: 1.0, damping: 0.1,
         moment: [{amplitude: [0.5], wavelength: 1.0, period: 1.0}]}

The keys are the fields of `Joint`, `Servo`, `Torque`, `PassiveTail` and `Muscle`. `servo` may be a name (xm430_w210).
`torque` holds `time` and `torque`. `moment` holds terms of a law with amplitudes in N m. A stiffness or a damping that
changes along the body is a table {x: [...], values: [...]}.
"""

import os
from collections.abc import Callable, Mapping
from dataclasses import MISSING, asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.input_file import Misplaced
from eel_common.files.tables import is_table
from eel_common.files.yaml_tree import check_keys, fail, read_yaml, tried
from eel_common.texts import made
from eel_common.wording import shown
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

from eel_dynamics.model.body.body import Body
from eel_dynamics.model.robot.actuators import Servo, Torque
from eel_dynamics.model.robot.continuous import ProfileTable
from eel_dynamics.model.robot.kinds import KINDS
from eel_dynamics.model.robot.ready import SERVOS

ACTUATORS: dict[str, type[Any]] = {"servo": Servo, "torque": Torque}
POINTS = 201  # points of a table that replaces a function


def robot_in_yaml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The arguments of the `Robot` in a YAML file. `ValueError` names line and key."""
    path = Path(path)
    return {"name": path.stem} | robot_arguments(read_yaml(path), path.parent)


def plain_of_robot(robot: Any, length: float) -> dict[str, Any]:
    """`robot` as plain values, as in a file, without its body.

    A stiffness that is a function of X becomes a table over a body of `length` [m]. A torque that is a function is
    refused (`ValueError`), as no file holds code.
    """
    plain: dict[str, Any] = {"name": robot.name}
    for key, kind in KINDS.items():
        parts = [_plain_part(part, length) for part in robot.parts if isinstance(part, kind)]
        if parts:
            plain[key] = parts
    return plain


def _plain_part(part: Any, length: float) -> dict[str, Any]:
    plain: dict[str, Any] = {}
    for item in fields(part):
        value = getattr(part, item.name)
        if item.default is not MISSING and value is item.default:
            continue
        if isinstance(value, Servo):
            plain["servo"] = {each.name: getattr(value, each.name) for each in fields(value)}
        elif isinstance(value, Torque):
            if value.time is None:
                raise ValueError(f"joint {shown(part.name)} torque is a function, which no file holds: give its values")
            plain["torque"] = {"time": list(value.time), "torque": list(value.torque)}  # type: ignore[arg-type]
        elif isinstance(value, Law):
            plain[item.name] = [asdict(term) for term in value.terms]
        elif callable(value):
            table = value if isinstance(value, ProfileTable) else _table(value, part, length)
            plain[item.name] = {"x": list(table.x), "values": list(table.values)}
        else:
            plain[item.name] = list(value) if isinstance(value, tuple) else value
    return plain


def _table(function: Callable[..., Any], part: Any, length: float) -> ProfileTable:
    x = np.linspace(part.start, part.end if part.end is not None else length, POINTS)
    return ProfileTable(tuple(x.tolist()), tuple(float(function(each)) for each in x))


def robot_arguments(root: Any, folder: Path = Path()) -> dict[str, Any]:
    """The arguments of a `Robot` from plain values: parts, and name and body if the document has them.

    folder: the folder of files that the document names.
    """
    if not isinstance(root, Mapping):
        raise Misplaced("line 1", f"a robot must have keys such as joints, got {shown(root)}")
    check_keys(root, ("name", "body", *KINDS))
    found: dict[str, Any] = {"parts": []}
    for key, kind in KINDS.items():
        for entries in _list(root, key):
            found["parts"] += _parts(kind, entries, root, key)
    if not found["parts"]:
        fail(root, "joints", "must hold joints, or tails or muscles in their place, got none")
    if "name" in root:
        found["name"] = root["name"]
    if "body" in root:
        found["body"] = tried(root, "body", _body, root["body"], folder)
    return found


def _parts(kind: type[Any], entries: Any, root: Mapping[str, Any], key: str) -> list[Any]:
    """The parts of one entry: several joints, if it has several positions."""
    given, names = dict(_fields(entries, root, key)), {item.name for item in fields(kind)}
    if "actuator" in names:
        own = {name: value for name, value in given.items() if name not in ACTUATORS}
        given = own | {"actuator": _actuator(entries)}
    for name in ("bending_stiffness", "damping"):
        if "actuator" not in names and isinstance(given.get(name), Mapping):
            given[name] = _built(ProfileTable, given[name])
    if "moment" in names:
        given["moment"] = _moment(entries)
    places = given.get("position")
    if "position" not in names or not isinstance(places, list):
        return [_built(kind, entries, given)]
    if "name" in given:
        fail(entries, "name", "goes with one position")
    return [_built(kind, entries, given | {"position": place}) for place in places]


def _built(kind: type[Any], entries: Mapping[str, Any], given: Mapping[str, Any] | None = None) -> Any:
    """`kind` from the fields in a mapping, or from `given`."""
    what = getattr(kind, "what", "") or kind.__name__.lower()
    return tried(entries, "", made, kind, entries if given is None else given, what)


def _actuator(entries: Mapping[str, Any]) -> Servo | Torque | None:
    found = [name for name in ACTUATORS if name in entries]
    if len(found) > 1:
        fail(entries, "torque", "does not go with servo")
    for name in found:
        if name == "servo" and isinstance(entries[name], str):
            if entries[name] not in SERVOS:
                fail(entries, name, f"must be one of {', '.join(SERVOS)}, or a mapping, got {shown(entries[name])}")
            return SERVOS[entries[name]]
        actuator: Servo | Torque = _built(ACTUATORS[name], _fields(entries[name], entries, name))
        return actuator
    return None


def _moment(entries: Mapping[str, Any]) -> Law:
    terms = []
    for each in _list(entries, "moment"):
        given = {"axis": entries.get("axis", "yaw"), **_fields(each, entries, "moment")}
        given["envelope"] = [_built(Ramp, _fields(ramp, each, "envelope")) for ramp in _list(each, "envelope")]
        terms.append(_built(Term, each, given))
    return tried(entries, "moment", Law, *terms)


def _fields(given: Any, above: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """The value `given` at the `key`, if it is a mapping."""
    if not isinstance(given, Mapping):
        fail(above, key, f"must hold mappings of fields, got {shown(given)}")
    return given


def _body(given: Any, folder: Path) -> Body:
    if not isinstance(given, str):
        raise ValueError(f"must be a name or a file, got {shown(given)}")
    if not is_table(given, ".npz"):
        return Body.named(given)
    return Body.from_file(folder / given)


def _list(entries: Mapping[str, Any], key: str) -> list[Any]:
    found = entries.get(key, [])
    if not isinstance(found, (list, tuple)):
        fail(entries, key, f"must be a list, got {shown(found)}")
    return list(found)
