# SPDX-License-Identifier: Apache-2.0
"""Equality of objects with arrays: every number the same to the last bit, NaN equal to NaN."""

from dataclasses import fields
from typing import Any

import numpy as np


def same(one: Any, other: Any) -> bool:
    """Whether two values are equal: numbers, texts, arrays, errors, and dicts, tuples and lists of such values."""
    if isinstance(one, float) and isinstance(other, float):
        return one == other or (one != one and other != other)
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    if isinstance(one, BaseException):
        return one.args == other.args and same(vars(one), vars(other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[name], other[name]) for name in one)
    if isinstance(one, (tuple, list)):
        return len(one) == len(other) and all(map(same, one, other))
    return bool(one == other)


def same_fields(one: Any, other: Any) -> bool:
    """Whether two dataclass instances are of one class, and all their fields are the same."""
    return type(one) is type(other) and all(
        same(getattr(one, item.name), getattr(other, item.name)) for item in fields(one)
    )


class EqualByFields:
    """Base of dataclasses with arrays: two are equal if all their fields are, and none can be hashed."""

    def __eq__(self, other: object) -> bool:
        return same_fields(self, other)

    __hash__ = None  # type: ignore[assignment]  # typeshed has `object` hashable
