# SPDX-License-Identifier: Apache-2.0
"""Sequences: laws that follow one another, in Python or from a YAML file.

    sequence([(straight(), 8.0), (turning(), 4.0), (still(), None)], blend=0.5)

    name: patrol              # of the law; the file's name by default
    blend: 0.5                # s, from one step to the next (0.5)
    steps:
      - gait: straight        # any gait, with `set` as in `eel simulate --set`
        set: {period: 0.8}
        duration: 8.0         # s; the last step may leave it out, and then lasts
      - gait: turning
        set: {left_bend: 0.5}
        duration: 4.0
        blend: 1.0            # into this step
        scale: 0.8            # times the curvature (1)
        mirror: yaw           # or pitch
        delay: 0.5            # s, by which the gait starts later (0)
      - together:             # the sum of several
          - gait: straight
          - gait: rolling
            scale: 0.2
        duration: 3.0
      - repeat: 2             # times (1)
        steps:                # nested steps, each with a duration
          - {gait: straight, duration: 2.0}
          - {gait: still, duration: 1.0}

The curvature is twice differentiable in time.
"""

import os
from collections.abc import Iterable, Sequence
from typing import Any

from eel_common.files.input_file import Misplaced, reading
from eel_common.files.yaml_tree import Entries, check_keys, fail, read_yaml, tried
from eel_common.quantity import checked_instance, checked_path, positive
from eel_common.wording import shown

from eel_gaits.gaits.registry import find
from eel_gaits.laws.law import MAXIMUM_NAME, MAXIMUM_TERMS, Law
from eel_gaits.laws.term import Term

BLEND = 0.5  # s
DEEPEST, MOST_STEPS = 8, 1000
FILE = ("name", "blend", "steps")
PART = ("gait", "set", "together", "scale", "mirror", "delay")
STEP = (*PART, "steps", "repeat", "duration", "blend")


def sequence(steps: Iterable[Sequence[Any]], *, blend: float = BLEND, name: str = "sequence") -> Law:
    """The law that plays the `steps` one after the other.

    steps: rows (law, duration [s]) or (law, duration [s], blend [s] into this step). The last duration may be None: the
    step then lasts. Otherwise the body becomes straight at its end.
    blend: [s], into each step without its own, and at the end. `ValueError` names the step at fault.
    """
    listed = enumerate(checked_instance("steps", steps, Iterable))
    rows = [(*checked_instance(f"steps[{index}]", step, Sequence), blend)[:3] for index, step in listed]
    for index, (_, _, into) in enumerate(rows):
        positive(f"steps[{index}]: blend", into)
    fades = [float(into) for _, _, into in rows[1:]] + [positive("blend", blend)]  # the blend out of each step
    terms: list[Term] = []
    at = 0.0
    for index, (law, duration, into) in enumerate(rows):
        try:
            if not isinstance(law, Law):
                raise ValueError(f"a step must begin with a Law, got {shown(law)}")
            law = law.delayed(at)
            if index:
                law = law.ramped_in(at, at + float(into))
            if duration is not None:
                at += positive("duration", duration)
                law = law.ramped_out(at, at + fades[index])
            elif index + 1 < len(rows):
                raise ValueError("duration must be given for all steps but the last, got None")
            terms += law.terms
            if len(terms) > MAXIMUM_TERMS:
                raise ValueError(f"the law has more than {MAXIMUM_TERMS} terms")
        except ValueError as error:
            raise ValueError(f"steps[{index}]: {error}") from None
    return Law(*terms, name=name)


def sequence_from_file(path: str | os.PathLike[str]) -> Law:
    """The `Law` of the sequence in a YAML file. `ValueError` in one line names file, line and key."""
    path = checked_path("path", path)
    with reading(shown(str(path))):
        return SequenceReader().law(read_yaml(path), path.stem[:MAXIMUM_NAME])


class SequenceReader:
    """Makes a law from a YAML document."""

    def __init__(self) -> None:
        self._steps = 0  # so far

    def law(self, root: Any, name: str) -> Law:
        """The law of the document. name: used if the document gives none."""
        if not isinstance(root, Entries):
            raise Misplaced("line 1", f"a sequence must have the key steps, got {shown(root)}")
        check_keys(root, FILE)
        name = root.get("name", name)
        blend = tried(root, "blend", positive, "blend", root.get("blend", BLEND))
        rows = [
            self._step(each, root, blend, 1, last=index == len(root["steps"]) - 1)
            for index, each in enumerate(self._list(root, "steps"))
        ]
        tried(root, "name", Law, name=name)
        return tried(root, "steps", sequence, rows, blend=blend, name=name)

    def _step(self, step: Any, above: Entries, blend: float, depth: int, *, last: bool = False) -> tuple[Any, ...]:
        """A row for `sequence`."""
        self._steps += 1
        if self._steps > MOST_STEPS or depth > DEEPEST:
            fail(above, "steps", f"must be at most {MOST_STEPS}, in at most {DEEPEST} levels")
        self._check_mapping(step, STEP, above, "steps")
        into = tried(step, "blend", positive, "blend", step.get("blend", blend))
        if "steps" in step:
            return *self._repeated(step, into, depth), into
        if "repeat" in step:
            fail(step, "repeat", "needs steps of its own")
        law, duration = self._part(step, depth), step.get("duration")
        if duration is None and not last:
            fail(step, "duration", "must be given for all steps but the last, got none")
        return law, None if duration is None else tried(step, "duration", positive, "duration", duration), into

    def _repeated(self, step: Entries, blend: float, depth: int) -> tuple[Law, float]:
        """The law and the duration of a step with nested steps."""
        for key in (*PART, "duration"):
            if key in step:
                fail(step, key, "does not go with steps")
        times = tried(step, "repeat", positive, "repeat", step.get("repeat", 1))
        if times != int(times) or times > MOST_STEPS:
            fail(step, "repeat", f"must be a whole number up to {MOST_STEPS}, got {times:g}")
        rows = [self._step(each, step, blend, depth + 1) for each in self._list(step, "steps")] * int(times)
        return tried(step, "steps", sequence, rows, blend=blend), sum(row[1] for row in rows)

    def _part(self, part: Entries, depth: int) -> Law:
        """The law of a step, or of one part of a step `together`."""
        if ("gait" in part) == ("together" in part):
            fail(part, "gait", "must be given, or together or steps in its place, and only one of them")
        law = self._together(part, depth) if "together" in part else self._gait(part)
        law = tried(part, "scale", law.__mul__, part.get("scale", 1.0))
        law = tried(part, "delay", law.delayed, part.get("delay", 0.0))
        return tried(part, "mirror", law.mirrored, part["mirror"]) if "mirror" in part else law

    def _together(self, part: Entries, depth: int) -> Law:
        if "set" in part:
            fail(part, "set", "goes with gait")
        laws = []
        for each in self._list(part, "together"):
            self._check_mapping(each, PART, part, "together")
            if depth >= DEEPEST:
                fail(part, "together", f"must be at most {DEEPEST} levels deep")
            laws.append(self._part(each, depth + 1))
        return sum(laws[1:], laws[0])

    def _gait(self, part: Entries) -> Law:
        given = part.get("set", Entries(part.line))
        make = tried(part, "gait", find, part["gait"])
        if not isinstance(given, Entries):
            fail(part, "set", f"must be a mapping of names to numbers, got {shown(given)}")
        law: Law = tried(given, "", make, **given)
        return law

    # -- places and errors

    def _list(self, entries: Entries, key: str) -> list[Any]:
        if not isinstance(entries.get(key), list) or not entries[key]:
            fail(entries, key, f"must be a list, got {shown(entries.get(key))}")
        return list(entries[key])

    def _check_mapping(self, value: Any, known: tuple[str, ...], above: Entries, key: str) -> None:
        if not isinstance(value, Entries):
            fail(above, key, f"must hold mappings, such as {{gait: straight, duration: 8}}, got {shown(value)}")
        check_keys(value, known)
