# SPDX-License-Identifier: Apache-2.0
"""The settings of the gait generator: a gait, its numbers and the transition. Together they make the law.

Settings never change. `changed` returns new ones, or raises a `ValueError` with the reason. Numbers are kept by name: a
number that the user has set carries over to another gait with a number of that name. Defaults do not.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any

from eel_common.quantity import Quantities, quantity
from eel_common.wording import shown

from eel_gaits.gaits.cpg import Oscillation
from eel_gaits.gaits.registry import GAITS, Transition, find, named_instead
from eel_gaits.gaits.sequence import sequence_from_file
from eel_gaits.laws.law import Law
from eel_gaits.sources.motion_file import read_motion
from eel_gaits.sources.sampled_law import SampledLaw

SEQUENCES = (".yaml", ".yml")  # suffixes of files of sequences


@dataclass(frozen=True, kw_only=True)
class MeasuredBody(Quantities):
    """The numbers of the gait `file`, for a measured motion."""

    length: float = quantity(1.0, "m", "body length L", 1e-4, 1e3)
    scale: float = quantity(1.0, "", "metres in the file's unit of length", 1e-9, 1e9)


FILE_GAITS: dict[str, type[Any]] = {"file": MeasuredBody, "sequence": Quantities}  # of gaits in files


@dataclass(frozen=True, kw_only=True)
class Settings:
    """A gait and the numbers that the user has set. `ValueError` if they make no law.

    Attributes:
        gait: name of the gait, or one of `FILE_GAITS`.
        chosen: the numbers that the user has set, by name, including those of other gaits.
        file: a sequence or a motion, read when the settings are made.
    """

    gait: str = "falling"
    chosen: dict[str, float] = field(default_factory=dict)
    file: str = ""
    _law: Law | SampledLaw = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "chosen", MappingProxyType(dict(self.chosen)))
        object.__setattr__(self, "_law", self._made_law())

    @classmethod
    def known_names(cls) -> set[str]:
        """The names of all parameters of all gaits."""
        numbers = {entry.name for name in (*GAITS, *FILE_GAITS) for entry in fields(numbers_of(name))}
        return {"gait", "file", "transition"} | numbers

    @classmethod
    def start(cls, overrides: Mapping[str, Any]) -> "Settings":
        """The settings at start, from a mapping of name to value. Names unknown to all gaits are ignored."""
        names = cls.known_names()
        known = {name: value for name, value in overrides.items() if name in names}
        return cls(gait=known.pop("gait", cls.gait), file=known.pop("file", cls.file), chosen=known)

    def changed(self, changes: Mapping[str, Any]) -> "Settings":
        """The settings after `changes`, a mapping of name to value. `ValueError` if one does not fit."""
        changes = dict(changes)
        gait, file = changes.pop("gait", self.gait), changes.pop("file", self.file)
        own_names = ["transition", *(entry.name for entry in fields(numbers_of(gait)))]
        for name in changes:
            if name not in own_names:
                raise ValueError(f"gait {shown(gait)} has no parameter {shown(name)}{named_instead(name, own_names)}")
        return Settings(gait=gait, file=file, chosen={**self.chosen, **changes})

    def groups(self) -> tuple[Any, ...]:
        """The transition and the gait's numbers: two `Quantities`, with the user's numbers over the defaults."""
        return Transition.among(self.chosen), numbers_of(self.gait).among(self.chosen)

    def numbers(self) -> dict[str, Any]:
        """The value of each number of this gait, by name."""
        return {entry.name: getattr(group, entry.name) for group in self.groups() for entry in fields(group)}

    def law(self) -> Law | SampledLaw:
        """The law of this gait with these numbers."""
        return self._law

    def oscillation(self) -> Oscillation | None:
        """The numbers of the oscillators whose curvature the node streams; None for any other gait."""
        return Oscillation.among(self.chosen) if self.gait == "cpg" else None

    def _made_law(self) -> Law | SampledLaw:
        if not (isinstance(self.gait, str) and self.gait in FILE_GAITS):
            law: Law = find(self.gait)(**self.numbers())
            return law
        transition, numbers = self.groups()
        if not isinstance(self.file, str) or not self.file:
            raise ValueError(f"gait {shown(self.gait)} needs the parameter file, got {shown(self.file)}")
        if self.gait == "sequence" or self.file.endswith(SEQUENCES):
            law = sequence_from_file(self.file)
            return Law(*law.terms, name=law.name, transition=transition.transition)
        return read_motion(self.file, length=numbers.length, scale=numbers.scale)


def numbers_of(gait: str) -> type[Any]:
    """The class of a gait's numbers. `ValueError` for an unknown gait."""
    kind: type[Any] = FILE_GAITS[gait] if isinstance(gait, str) and gait in FILE_GAITS else find(gait).numbers
    return kind
