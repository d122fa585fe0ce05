# SPDX-License-Identifier: Apache-2.0
"""Reads a sequence from a YAML file (`laws.sequence` has the format). An error names file, line and key."""

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from eel_base.files.input_file import Misplaced, reading
from eel_base.files.yaml_tree import Entries, read_yaml
from eel_base.quantity import positive
from eel_base.wording import shown

from eel_gaits.gaits.registry import find
from eel_gaits.laws.law import MAXIMUM_NAME, Law
from eel_gaits.laws.sequence import BLEND, sequence

Made = TypeVar("Made")

DEEPEST, MOST_STEPS = 8, 1000
FILE = ("name", "blend", "steps")
PART = ("gait", "set", "together", "scale", "mirror", "delay")
STEP = (*PART, "steps", "repeat", "duration", "blend")


def sequence_from_file(path: str | os.PathLike[str]) -> Law:
    """The `Law` of the sequence in a YAML file. `ValueError` in one line names file, line and key."""
    path = Path(path)
    with reading(shown(str(path))):
        return SequenceReader(path.stem[:MAXIMUM_NAME]).law(read_yaml(path))


class SequenceReader:
    """Makes a law of a YAML document. name: of the law, where the document gives none."""

    def __init__(self, name: str) -> None:
        self._name, self._steps = name, 0

    def law(self, root: Any) -> Law:
        """The law of the document."""
        if not isinstance(root, Entries):
            raise Misplaced("line 1", f"a sequence must have the key steps, got {shown(root)}")
        self._check_keys(root, FILE)
        name = root.get("name", self._name)
        blend = self._tried(root, "blend", positive, "blend", root.get("blend", BLEND))
        rows = [
            self._step(each, root, blend, 1, last=index == len(root["steps"]) - 1)
            for index, each in enumerate(self._list(root, "steps"))
        ]
        self._tried(root, "name", Law, name=name)
        return self._tried(root, "steps", sequence, rows, blend=blend, name=name)

    def _step(self, step: Any, above: Entries, blend: float, depth: int, *, last: bool = False) -> tuple[Any, ...]:
        """A row for `sequence`."""
        self._steps += 1
        if self._steps > MOST_STEPS or depth > DEEPEST:
            self._fail(above, "steps", f"must be at most {MOST_STEPS}, in at most {DEEPEST} levels")
        self._check_mapping(step, above, "steps")
        self._check_keys(step, STEP)
        into = self._tried(step, "blend", positive, "blend", step.get("blend", blend))
        if "steps" in step:
            return *self._repeated(step, into, depth), into
        if "repeat" in step:
            self._fail(step, "repeat", "needs steps of its own")
        law, duration = self._part(step, depth), step.get("duration")
        if duration is None and not last:
            self._fail(step, "duration", "must be given for all steps but the last, got none")
        return law, None if duration is None else self._tried(step, "duration", positive, "duration", duration), into

    def _repeated(self, step: Entries, blend: float, depth: int) -> tuple[Law, float]:
        """The law and the duration of a step that has steps of its own."""
        for key in (*PART, "duration"):
            if key in step:
                self._fail(step, key, "does not go with steps")
        times = self._tried(step, "repeat", positive, "repeat", step.get("repeat", 1))
        if times != int(times) or times > MOST_STEPS:
            self._fail(step, "repeat", f"must be a whole number up to {MOST_STEPS}, got {times:g}")
        rows = [self._step(each, step, blend, depth + 1) for each in self._list(step, "steps")] * int(times)
        return self._tried(step, "steps", sequence, rows, blend=blend), sum(row[1] for row in rows)

    def _part(self, part: Entries, depth: int) -> Law:
        """The law of a step, or of one of those together."""
        if ("gait" in part) == ("together" in part):
            self._fail(part, "gait", "must be given, or together or steps in its place, and only one of them")
        law = self._together(part, depth) if "together" in part else self._gait(part)
        law = self._tried(part, "scale", law.__mul__, part.get("scale", 1.0))
        law = self._tried(part, "delay", law.delayed, part.get("delay", 0.0))
        return self._tried(part, "mirror", law.mirrored, part["mirror"]) if "mirror" in part else law

    def _together(self, part: Entries, depth: int) -> Law:
        if "set" in part:
            self._fail(part, "set", "goes with gait")
        laws = []
        for each in self._list(part, "together"):
            self._check_mapping(each, part, "together")
            self._check_keys(each, PART)
            if depth >= DEEPEST:
                self._fail(part, "together", f"must be at most {DEEPEST} levels deep")
            laws.append(self._part(each, depth + 1))
        return sum(laws[1:], laws[0])

    def _gait(self, part: Entries) -> Law:
        given = part.get("set", Entries(part.line))
        make = self._tried(part, "gait", find, part["gait"])
        if not isinstance(given, Entries):
            self._fail(part, "set", f"must be a mapping of names to numbers, got {shown(given)}")
        try:
            law: Law = make(**given)
            return law
        except ValueError as error:
            words = re.findall(r"\w+", str(error))
            guilty = min((name for name in given if name in words), key=words.index, default=None)
            return self._fail(given, guilty, error) if guilty else self._fail(part, "gait", error)

    # -- places and errors

    def _list(self, entries: Entries, key: str) -> list[Any]:
        if not isinstance(entries.get(key), list) or not entries[key]:
            self._fail(entries, key, f"must be a list, got {shown(entries.get(key))}")
        return list(entries[key])

    def _check_mapping(self, value: Any, above: Entries, key: str) -> None:
        if not isinstance(value, Entries):
            self._fail(above, key, f"must hold mappings, such as {{gait: straight, duration: 8}}, got {shown(value)}")

    def _check_keys(self, entries: Entries, known: tuple[str, ...]) -> None:
        for key in entries:
            if key not in known:
                self._fail(entries, key, f"is unknown, must be one of {', '.join(known)}")

    def _tried(self, entries: Entries, key: str, make: Callable[..., Made], *arguments: Any, **options: Any) -> Made:
        try:
            return make(*arguments, **options)
        except (ValueError, TypeError) as error:
            if isinstance(error, Misplaced):
                raise
            return self._fail(entries, key, error)

    def _fail(self, entries: Entries, key: str, reason: object) -> NoReturn:
        line = entries.lines.get(key, entries.line)
        raise Misplaced(f"line {line}, key {shown(key)}", str(reason)) from None
