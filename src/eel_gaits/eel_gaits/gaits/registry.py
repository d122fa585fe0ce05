# SPDX-License-Identifier: Apache-2.0
"""Gaits by name, of this package and others.

A gait is written as a function that makes terms from its numbers. `register` lists it, and turns it into a function
that takes the numbers as keywords and returns a `Law`. `load_gaits` imports all files of this folder.
`eel_gaits/__init__.py` has the names for users of the library. Another installed package adds a gait by an entry point,
whose value is a function with the decorator `eel_gaits.register`:

    [project.entry-points."eel_gaits.gaits"]
    wiggle = "my_package.gaits:wiggle"
"""

import functools
import importlib
import inspect
import os
import pkgutil
import warnings
from collections.abc import Callable, Collection
from dataclasses import dataclass
from importlib.metadata import entry_points
from typing import Any

from eel_common.quantity import Quantities, described_fields, quantity
from eel_common.wording import did_you_mean, one_line, shown

from eel_gaits.laws.law import Law


@dataclass(frozen=True, kw_only=True)
class Transition(Quantities):
    """How a swimmer that is already moving changes to the law."""

    transition: float = quantity(0.0, "s", "duration of the blend into the law; 0: the receiver's default", 0.0, 1e4)


GROUP = "eel_gaits.gaits"  # the group of entry points
GAITS: dict[str, Any] = {}  # name: the gait's function; its attribute `numbers` is the class of its numbers


def gait(name: str, *, transition: float = 0.0, **numbers: float) -> Law:
    """The law of the gait called `name`. `numbers` replace its defaults.

    transition: [s], of the law. `ValueError` for an unknown gait lists the known ones.
    """
    law: Law = find(name)(transition=transition, **numbers)
    return law


def find(name: object) -> Any:
    """The function of the gait called `name`. `ValueError` for an unknown gait lists the known ones."""
    if not isinstance(name, str) or name not in GAITS:
        hint = did_you_mean(name, GAITS) if isinstance(name, str) else ""
        raise ValueError(f"unknown gait {shown(name)}{hint}, must be one of {', '.join(sorted(GAITS))}")
    return GAITS[name]


def named_instead(name: str, known: Collection[str]) -> str:
    """The end of an error about an unknown number `name`: the names that are `known`."""
    return f"{did_you_mean(name, known)}, it has: {', '.join(known) or 'none'}"


def register(numbers_class: type[Quantities]) -> Callable[[Callable[..., Any]], Any]:
    """Decorator: list `terms_of(numbers) -> terms` as a gait, which takes keyword numbers and returns a `Law`."""

    def decorate(terms_of: Callable[..., Any]) -> Any:
        name = terms_of.__name__
        if name in GAITS and GAITS[name].__module__ != terms_of.__module__:
            raise ValueError(f"gait {shown(name)} is there already, in {GAITS[name].__module__}")
        own_names = tuple(inspect.signature(numbers_class).parameters)

        @functools.wraps(terms_of)
        def made(*, transition: float = 0.0, **numbers: float) -> Law:
            unknown = [key for key in numbers if key not in own_names]
            if unknown:
                hint = named_instead(unknown[0], own_names)
                raise ValueError(f"gait {shown(name)} has no number {shown(unknown[0])}{hint}")
            return Law(*terms_of(numbers_class(**numbers)), name=name, transition=transition)

        keyword = inspect.Parameter("transition", inspect.Parameter.KEYWORD_ONLY, default=0.0)
        make: Any = made  # it gets its own signature and class of numbers
        make.__signature__ = inspect.Signature(
            [keyword, *inspect.signature(numbers_class).parameters.values()], return_annotation=Law
        )
        make.numbers = numbers_class
        make.__doc__ = (
            f"{inspect.getdoc(terms_of)}\n\nNumbers, with default, meaning, unit and bounds:\n"
            f"{described_fields(Transition)}\n{described_fields(numbers_class)}\n"
        )
        GAITS[name] = make
        return make

    return decorate


def load_gaits() -> None:
    """Load the gaits of this folder, and those of other packages. Each registers itself.

    A gait of another package that cannot be loaded causes a warning.
    """
    for module in pkgutil.iter_modules([os.path.dirname(__file__)], "eel_gaits.gaits."):
        importlib.import_module(module.name)
    for entry in entry_points(group=GROUP):
        try:
            function = entry.load()
            if GAITS.get(entry.name) is not function:
                raise ValueError(f"{entry.value} is no function of that name with the decorator eel_gaits.register")
        except Exception as error:  # foreign code
            warnings.warn(f"gait {entry.name!r} is left out: {one_line(error)}", stacklevel=2)
