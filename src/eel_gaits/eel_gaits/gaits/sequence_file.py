# SPDX-License-Identifier: Apache-2.0
"""Reads a sequence from a YAML file (`laws.sequence` has the format). An error names file, line and key."""

from pathlib import Path

import yaml
from eel_base.quantity import number
from eel_base.wording import one_line, shown

from eel_gaits.gaits.numbers import TURNS
from eel_gaits.gaits.registry import find
from eel_gaits.laws.law import MAXIMUM_NAME, Law
from eel_gaits.laws.sequence import BLEND, positive, sequence

MOST_BYTES, DEEPEST, MOST_STEPS = 1_000_000, 8, 1000
FILE = ("name", "blend", "steps")
PART = ("gait", "set", "together", "scale", "mirror", "delay")
STEP = (*PART, "steps", "repeat", "duration", "blend")


class SequenceError(ValueError):
    """What is wrong in a sequence, with file, line and key."""


class Entries(dict):
    """A mapping of the file: keys to values. `line` is its own line, `lines` those of its keys."""

    def __init__(self, line):
        super().__init__()
        self.line, self.lines = line, {}


def sequence_from_file(path):
    """The `Law` of the sequence in a YAML file.

    `SequenceError`, a `ValueError`, names file, line and key. `OSError` where the file cannot be read.
    """
    path = Path(path)
    with path.open("rb") as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise SequenceError(f"{path}: a sequence must have at most {MOST_BYTES} bytes")
    try:
        node = yaml.compose(data.decode("utf-8"), Loader=yaml.SafeLoader)
    except (yaml.YAMLError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{path}, line {mark.line + 1}" if mark is not None else f"{path}"
        raise SequenceError(f"{place}: {one_line(getattr(error, 'problem', None) or error)}") from None
    return SequenceReader(path).law(node)


class SequenceReader:
    """Makes a law of the nodes of a YAML document. path: of the file, for errors and for the name of the law."""

    def __init__(self, path):
        self._path, self._steps = path, 0

    def law(self, node):
        """The law of the document's root."""
        root = self._value(node, 1) if node is not None else None
        if not isinstance(root, Entries):
            raise SequenceError(f"{self._path}, line 1: a sequence must have the key steps, got {shown(root)}")
        self._check_keys(root, FILE)
        name = root.get("name", self._path.stem[:MAXIMUM_NAME])
        blend = self._tried(root, "blend", positive, "blend", root.get("blend", BLEND))
        rows = [
            self._step(each, root, blend, 1, last=index == len(root["steps"]) - 1)
            for index, each in enumerate(self._list(root, "steps"))
        ]
        self._tried(root, "name", Law, name=name)
        return self._tried(root, "steps", sequence, rows, blend=blend, name=name)

    def _step(self, step, above, blend, depth, *, last=False):
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

    def _repeated(self, step, blend, depth):
        """The law and the duration of a step that has steps of its own."""
        for key in (*PART, "duration"):
            if key in step:
                self._fail(step, key, "does not go with steps")
        times = self._tried(step, "repeat", positive, "repeat", step.get("repeat", 1))
        if times != int(times) or times > MOST_STEPS:
            self._fail(step, "repeat", f"must be a whole number up to {MOST_STEPS}, got {times:g}")
        rows = [self._step(each, step, blend, depth + 1) for each in self._list(step, "steps")] * int(times)
        return self._tried(step, "steps", sequence, rows, blend=blend), sum(row[1] for row in rows)

    def _part(self, part, depth):
        """The law of a step, or of one of those together."""
        if ("gait" in part) == ("together" in part):
            self._fail(part, "gait", "must be given, or together or steps in its place, and only one of them")
        law = self._together(part, depth) if "together" in part else self._gait(part)
        law = self._tried(part, "scale", law.__mul__, part.get("scale", 1.0))
        law = self._tried(part, "delay", law.delayed, part.get("delay", 0.0))
        return self._tried(part, "mirror", law.mirrored, part["mirror"]) if "mirror" in part else law

    def _together(self, part, depth):
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

    def _gait(self, part):
        given = part.get("set", {})
        make = self._tried(part, "gait", find, part["gait"])
        if not isinstance(given, dict):
            self._fail(part, "set", f"must be a mapping of names to numbers, got {shown(given)}")
        numbers = {}
        for name, value in given.items():
            if name in TURNS:
                name, value = TURNS[name], -self._tried(given, name, number, name, value)
            numbers[name] = value
        try:
            return make(**numbers)
        except ValueError as error:
            names = {TURNS.get(name, name): name for name in given}
            guilty = next((name for own, name in names.items() if own in str(error).split()[0:1]), None)
            guilty = guilty or next((name for own, name in names.items() if own in str(error)), None)
            return self._fail(given, guilty, error) if guilty else self._fail(part, "gait", error)

    # -- places and errors

    def _value(self, node, depth):
        """What a node stands for: `Entries`, a list, or a scalar."""
        if depth > 4 * DEEPEST:
            raise SequenceError(f"{self._path}, line {node.start_mark.line + 1}: too many levels")
        if isinstance(node, yaml.MappingNode):
            entries = Entries(node.start_mark.line + 1)
            for key_node, value_node in node.value:
                key = self._value(key_node, depth + 1)
                if not isinstance(key, str) or key in entries:
                    wrong = "comes twice" if isinstance(key, str) else "is no text"
                    raise SequenceError(f"{self._path}, line {key_node.start_mark.line + 1}, key {shown(key)}: {wrong}")
                entries[key], entries.lines[key] = self._value(value_node, depth + 1), key_node.start_mark.line + 1
            return entries
        if isinstance(node, yaml.SequenceNode):
            return [self._value(each, depth + 1) for each in node.value]
        try:
            value = yaml.SafeLoader("").construct_object(node)
        except (yaml.YAMLError, ValueError) as error:
            line = node.start_mark.line + 1
            raise SequenceError(f"{self._path}, line {line}: {getattr(error, 'problem', None) or error}") from None
        if isinstance(value, str) and node.style is None and _is_number(value):
            return float(value)  # such as 1e-3, which YAML 1.1 calls a text
        return value

    def _list(self, entries, key):
        if not isinstance(entries.get(key), list) or not entries[key]:
            self._fail(entries, key, f"must be a list, got {shown(entries.get(key))}")
        return entries[key]

    def _check_mapping(self, value, above, key):
        if not isinstance(value, Entries):
            self._fail(above, key, f"must hold mappings, such as {{gait: straight, duration: 8}}, got {shown(value)}")

    def _check_keys(self, entries, known):
        for key in entries:
            if key not in known:
                self._fail(entries, key, f"is unknown, must be one of {', '.join(known)}")

    def _tried(self, entries, key, make, *arguments, **options):
        try:
            return make(*arguments, **options)
        except (ValueError, TypeError) as error:
            if isinstance(error, SequenceError):
                raise
            return self._fail(entries, key, error)

    def _fail(self, entries, key, reason):
        line = entries.lines.get(key, entries.line)
        raise SequenceError(f"{self._path}, line {line}, key {shown(key)}: {one_line(reason)}") from None


def _is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True
