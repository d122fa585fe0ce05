# SPDX-License-Identifier: Apache-2.0
"""`cached_property` without a lock, for objects that one thread uses.

Before Python 3.12, `functools.cached_property` holds one lock per class. Threads that compute a property of different
objects, such as a measure of a run, then wait for each other, even in code that releases the interpreter's lock.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from functools import cached_property
else:

    class cached_property:
        """`functools.cached_property` without its lock."""

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
