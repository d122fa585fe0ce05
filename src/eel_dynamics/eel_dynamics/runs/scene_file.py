# SPDX-License-Identifier: Apache-2.0
"""A swim in a file: `load_scene` and `save_scene`. Nodes read the same file (`--params-file`).

Its keys are the names of the nodes' parameters, below `/**: ros__parameters:` or at the top level:

    gait: straight            # as in the node gait_generator; its numbers follow, and file: for a sequence
    period: 0.8
    body: boyer2010           # or a file
    scene: {planar: true}     # fields of `Scene`
    accuracy: 1e-4
    duration: 10.0            # s; in the library also "settled"
    initial_linear_velocity: [0.3, 0, 0]
    flow: shear velocity=0.1,0,0 width=0.5    # several are joined by " + "
    fins: pair station=0.5 area=0.0015 aspect_ratio=2.5   # likewise
    wrenches: world station=1 force=-0.5,0,0              # from outside, likewise
    robot: eight_servos       # or a file; its body is the scene's unless another is given

A new key is a line of `WORDS`.
"""

import os
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from eel_common.files.input_file import reading
from eel_common.files.output_file import replacing
from eel_common.files.yaml_tree import read_yaml
from eel_common.quantity import checked_instance, checked_path, checked_row, positive
from eel_common.wording import did_you_mean, shown
from eel_gaits.gaits.settings import SEQUENCES, Settings

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.equality import same
from eel_dynamics.model.fins.text import fins_from_text, text_of_fins
from eel_dynamics.model.flow.text import flow_from_text, text_of_flow
from eel_dynamics.model.initial_state import AT_REST
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.text import text_of_wrenches, wrenches_from_text
from eel_dynamics.runs.settled_duration import until_settled
from eel_dynamics.runs.swim import Swim

SUFFIXES = SEQUENCES  # of such files; a file with steps is a sequence
FOR_ALL, PARAMETERS = "/**", "ros__parameters"
ABOUT = "# A scene for eel simulate, terms, tradeoff and stability, and for --params-file of the nodes.\n"


class Word(NamedTuple):
    """A key of a file. given(swim, value): the fields of `Swim` that it sets. plain(swim): its value, or None."""

    given: Callable[[Swim, Any], dict[str, Any]]
    plain: Callable[[Swim], Any]


def load_scene(path: str | os.PathLike[str]) -> Swim:
    """The swim of a file. `ValueError` in one line names the file, the key, and its value."""
    with reading(f"scene {shown(str(path))}"):
        return swim_of(read_yaml(path))


def save_scene(swim: Swim, path: str | os.PathLike[str]) -> None:
    """Write `swim` to a file. `ValueError` for anything a file cannot hold; `NotWritten`: it cannot be completed."""
    words = words_of(checked_instance("swim", swim, Swim))
    text = yaml.safe_dump({FOR_ALL: {PARAMETERS: words}}, sort_keys=False, default_flow_style=None)
    with replacing(checked_path("path", path)) as draft:
        draft.write_text(ABOUT + text, encoding="utf-8")


def swim_of(words: Any, base: Swim | None = None) -> Swim:
    """The swim of these `words`, or `base` changed by them. `ValueError` names a bad key."""
    words = checked_instance("its content", words, Mapping)
    for level in (FOR_ALL, PARAMETERS):
        words = checked_instance(level, words.get(level, words), Mapping)
    known, gait = Settings.known_names(), {word: value for word, value in words.items() if word not in WORDS}
    for word in gait:
        if word not in known:
            hint = did_you_mean(word, (*WORDS, *known))
            raise ValueError(f"unknown word {shown(word)}{hint}, must be gait, its numbers, or {', '.join(WORDS)}")
    settings = Settings().changed(gait)
    swim = base or Swim(settings.law(), gait=settings)
    if base is not None and gait:
        swim = swim.unchecked(**swim.fields_of_gait(gait))
    for word, about in WORDS.items():
        swim = swim.unchecked(**about.given(swim, words[word])) if word in words else swim
    return swim.changed()  # checked as a whole


def words_of(swim: Swim) -> dict[str, Any]:
    """The keys of a file for this `swim`, without defaults. `ValueError` for anything a file cannot hold."""
    if not isinstance(swim.gait, Settings) or swim.gait.law() != swim.law:
        name = getattr(swim.law, "name", swim.law)
        raise ValueError(f"law {shown(name)} cannot be written: no gait by name gave it")
    for item in fields(Swim):
        if item.name not in HELD and not same(getattr(swim, item.name), item.default):
            raise ValueError(f"{item.name} cannot be written, got {shown(getattr(swim, item.name))}: it has no key")
    if swim.stations is None:
        raise ValueError("stations cannot be written, got None: give their number, or their X in m")
    own: dict[str, Any] = {"gait": swim.gait.gait, "file": swim.gait.file, **swim.gait.chosen}
    own |= {word: about.plain(swim) for word, about in WORDS.items()}
    return {word: value for word, value in own.items() if value not in (None, "", {})}


def _body(swim: Swim, value: Any) -> dict[str, Any]:
    body = body_of(checked_instance("body", value, str))
    return {"body": body, "body_file": value if Path(value).suffix else ""}


def _plain_body(swim: Swim) -> str:
    of_robot = swim.robot is not None and swim.robot.body == swim.body
    return "" if of_robot else _name_of(swim, "body", "numbers")


def _name_of(swim: Swim, word: str, held: str) -> str:
    """The name or file of a body or robot. `ValueError` if the content that it `held` has changed."""
    own = getattr(swim, word)
    name: str = getattr(swim, f"{word}_file") or own.name
    if WORDS[word].given(swim, name)[word] != own:
        raise ValueError(f"{word} {shown(name)} cannot be written: its {held} are no longer those of that name")
    return name


def _scene(swim: Swim, value: Any) -> dict[str, Any]:
    return {"scene": swim.scene.changed(checked_instance("scene", value, Mapping))}


def _plain_scene(swim: Swim) -> dict[str, Any]:
    """The fields that differ from their defaults; rows as lists."""
    defaults, own = vars(Scene()), {item.name: getattr(swim.scene, item.name) for item in fields(Scene)}
    others = {name: value for name, value in own.items() if value is not None and value != defaults[name]}
    return {name: np.array(value).tolist() if isinstance(value, tuple) else value for name, value in others.items()}


def _plain_accuracy(swim: Swim) -> Any:
    name = swim.accuracy.name
    if Accuracy.of(name) != swim.accuracy:
        raise ValueError(f"accuracy {shown(name)} cannot be written: it must be a preset or a target")
    return float(name) if name[0].isdigit() and "," not in name else name


def _duration(swim: Swim, value: Any) -> dict[str, Any]:
    return {"duration": value if until_settled(value) else positive("duration", value, "s")}


def _robot(swim: Swim, value: Any) -> dict[str, Any]:
    robot = robot_of(checked_instance("robot", value, str))
    own = None if robot is None else robot.body
    return {"robot": robot, "robot_file": value if Path(value).suffix else "", "body": own or swim.body}


def _of_start(field: str, part: slice = slice(None)) -> Word:
    """A key for a `part` of a row of the initial state."""

    def given(swim: Swim, value: Any) -> dict[str, Any]:
        row = getattr(swim.start, field).copy()
        row[part] = checked_row(f"initial {field}", value, len(row[part]))
        return {"start": swim.start._replace(**{field: row})}

    def plain(swim: Swim) -> Any:
        row = getattr(swim.start, field)[part]
        return None if np.array_equal(row, getattr(AT_REST, field)[part]) else row.tolist()

    return Word(given, plain)


def _number(name: str, default: Any) -> Word:
    """A key with a field of its own."""
    return Word(
        lambda swim, value: {name: value}, lambda swim: None if getattr(swim, name) == default else getattr(swim, name)
    )


WORDS: dict[str, Word] = {  # robot before body, as a given body replaces the robot file's
    "robot": Word(_robot, lambda swim: swim.robot and _name_of(swim, "robot", "parts")),
    "body": Word(_body, _plain_body),
    "scene": Word(_scene, _plain_scene),
    "accuracy": Word(lambda swim, value: {"accuracy": Accuracy.of(value)}, _plain_accuracy),
    "duration": Word(_duration, lambda swim: swim.duration),
    "sample_period": _number("sample_period", None),
    "stations": _number("stations", 51),
    "initial_position": _of_start("position"),
    "initial_orientation": _of_start("orientation"),
    "initial_angular_velocity": _of_start("twist", slice(3)),
    "initial_linear_velocity": _of_start("twist", slice(3, 6)),
    "fins": Word(
        lambda swim, value: {"fins": fins_from_text(checked_instance("fins", value, str))},
        lambda swim: text_of_fins(swim.fins) or None,
    ),
    "wrenches": Word(
        lambda swim, value: {"wrenches": wrenches_from_text(checked_instance("wrenches", value, str))},
        lambda swim: text_of_wrenches(swim.wrenches) or None,
    ),
    "flow": Word(
        lambda swim, value: {"flow": flow_from_text(checked_instance("flow", value, str))},
        lambda swim: swim.flow and text_of_flow(swim.flow),
    ),
}
HELD = {"law", "gait", "start", "body_file", "robot_file"} | WORDS.keys()  # fields of a swim that a file can hold
