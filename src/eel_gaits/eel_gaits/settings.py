"""The settings of the gait generator: a gait, its numbers and the transition. They give the law.

Settings never change. `changed` returns new ones, or raises a `ValueError` that gives the reason. Numbers are kept by
name. A number that the user has set carries over to another gait that has a number of that name. Defaults do not.
"""

from dataclasses import dataclass, field, fields
from types import MappingProxyType

from eel_gaits.registry import GAITS, Transition, find
from eel_gaits.wording import shown


@dataclass(frozen=True, kw_only=True)
class Settings:
    """A gait and the numbers that the user has set. `ValueError` where they give no law.

    Attributes:
        gait: name of the gait.
        chosen: the numbers that the user has set, by name, including those of other gaits.
    """

    gait: str = "falling"
    chosen: dict[str, float] = field(default_factory=dict)

    def __post_init__(self):
        object.__setattr__(self, "chosen", MappingProxyType(dict(self.chosen)))
        self.law()

    @classmethod
    def known_names(cls):
        """The names of all parameters of all gaits."""
        numbers = {entry.name for make in GAITS.values() for entry in fields(make.numbers)}
        return {"gait", "transition"} | numbers

    @classmethod
    def start(cls, overrides):
        """The settings at start, from a mapping of name to value. Names that no gait has are ignored."""
        known = {name: value for name, value in overrides.items() if name in cls.known_names()}
        return cls(gait=known.pop("gait", cls.gait), chosen=known)

    def changed(self, changes):
        """The settings after `changes`, a mapping of name to value. `ValueError` where one of them does not fit."""
        changes = dict(changes)
        gait = changes.pop("gait", self.gait)
        own_names = ["transition", *(entry.name for entry in fields(find(gait).numbers))]
        for name in changes:
            if name not in own_names:
                raise ValueError(f"gait {shown(gait)} has no parameter {shown(name)}, it has: {', '.join(own_names)}")
        return Settings(gait=gait, chosen={**self.chosen, **changes})

    def groups(self):
        """The transition and the gait's numbers: two `Quantities`. The user's numbers replace the defaults."""
        return tuple(
            kind(**{entry.name: self.chosen[entry.name] for entry in fields(kind) if entry.name in self.chosen})
            for kind in (Transition, find(self.gait).numbers)
        )

    def numbers(self):
        """The value of each number that can be set with this gait, by name."""
        return {entry.name: getattr(group, entry.name) for group in self.groups() for entry in fields(group)}

    def law(self):
        """The law of this gait with these numbers."""
        return find(self.gait)(**self.numbers())
