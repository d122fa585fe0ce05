# SPDX-License-Identifier: Apache-2.0
"""Properties that are computed once, for objects that one thread computes with.

`functools.cached_property` has a lock for all objects of a class before Python 3.12: what threads compute of objects of
their own, such as a measure of a run, then waits for each other, even while it lets go of Python's lock.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from functools import cached_property
else:

    class cached_property:
        """As `functools.cached_property`, without a lock."""

        def __init__(self, function):
            self.function, self.__doc__ = function, function.__doc__

        def __set_name__(self, owner, name):
            self.name = name

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            value = instance.__dict__[self.name] = self.function(instance)
            return value


__all__ = ["cached_property"]
