# SPDX-License-Identifier: Apache-2.0
"""Values of fields as users give them: taken in the field's type, or refused with name, bound and value."""

from array import array
from dataclasses import dataclass, field, fields

import pytest
from eel_common.quantity import checked


@dataclass
class Fields:
    yes: bool = False
    name: str = field(default="a", metadata={"choices": ("a", "b")})
    target: str = field(default="fine", metadata={"number": True})
    count: int = field(default=2, metadata={"minimum": 1, "unit": ""})
    rate: float = field(default=1.0, metadata={"minimum": 0.0, "exclusive": True, "maximum": 9.0, "unit": "Hz"})
    none: float | None = None
    place: tuple = (0.0, 0.0)
    sinks: tuple = ("a",)


ITEMS = {item.name: item for item in fields(Fields)}


@pytest.mark.parametrize(
    ("name", "given", "taken"),
    [
        ("yes", True, True),
        ("name", "b", "b"),
        ("target", 1, 1.0),
        ("count", 3, 3),
        ("rate", 9, 9.0),
        ("none", 0, None),
        ("place", array("d", [1.0, 2.0]), (1.0, 2.0)),
        ("sinks", "a, b", ("a", "b")),
    ],
)
def test_a_value_comes_in_the_type_of_the_field(name, given, taken):
    found = checked(ITEMS[name], given, name)
    assert found == taken and type(found) is type(taken)


@pytest.mark.parametrize(
    ("name", "given", "words"),
    [
        ("yes", 1, "n must be true or false, got 1"),
        ("name", "c", "n must be one of a, b, got 'c'"),
        ("name", 1, "n must be a text, got 1"),
        ("target", True, "n must be a text or a number, got True"),
        ("count", 2.0, "n must be an integer, got 2.0"),
        ("count", 0, "n must be >= 1, got 0"),
        ("rate", 0, "n must be > 0 Hz, got 0"),
        ("rate", 10, "n must be <= 9 Hz, got 10"),
        ("rate", float("nan"), "n must be finite, got nan"),
        ("place", [1.0], r"n must be 2 finite numbers, got \[1.0\]"),
        ("sinks", [1], r"n must be a list of texts, got \[1\]"),
    ],
)
def test_a_value_that_does_not_fit_is_named_with_its_bound(name, given, words):
    with pytest.raises(ValueError, match=f"^{words}$"):
        checked(ITEMS[name], given, "n")
