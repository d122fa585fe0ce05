"""Gaits by name.

A gait is written as a function that makes terms from its numbers. `register` lists it, and turns it into a function
that takes the numbers as keywords and returns a `Law`. The gaits are in `eel_gaits.gaits`.
"""

import functools
import inspect

from eel_gaits.law import Law
from eel_gaits.wording import shown

GAITS = {}  # name of the gait: its function, whose attribute `numbers` is the class of its numbers


def gait(name, *, transition=0.0, **numbers):
    """The law of the gait called `name`. `numbers` replace its defaults.

    transition [s]: that of the law. `ValueError` for an unknown gait lists the known ones.
    """
    return find(name)(transition=transition, **numbers)


def find(name):
    """The function of the gait called `name`. `ValueError` for an unknown gait lists the known ones."""
    if not isinstance(name, str) or name not in GAITS:
        raise ValueError(f"unknown gait {shown(name)}, must be one of {', '.join(sorted(GAITS))}")
    return GAITS[name]


def register(numbers_class):
    """Decorator: list `terms_of(numbers) -> terms` as a gait, which takes keyword numbers and returns a `Law`."""

    def decorate(terms_of):
        name = terms_of.__name__
        own_names = tuple(inspect.signature(numbers_class).parameters)

        @functools.wraps(terms_of)
        def make(*, transition=0.0, **numbers):
            unknown = [key for key in numbers if key not in own_names]
            if unknown:
                raise ValueError(
                    f"gait {shown(name)} has no number {shown(unknown[0])}, it has: {', '.join(own_names) or 'none'}"
                )
            return Law(*terms_of(numbers_class(**numbers)), name=name, transition=transition)

        keyword = inspect.Parameter("transition", inspect.Parameter.KEYWORD_ONLY, default=0.0)
        make.__signature__ = inspect.Signature(
            [keyword, *inspect.signature(numbers_class).parameters.values()], return_annotation=Law
        )
        make.numbers = numbers_class
        GAITS[name] = make
        return make

    return decorate
