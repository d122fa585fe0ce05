# SPDX-License-Identifier: Apache-2.0
"""Texts of named fields, and objects of them: what does not fit is one `ValueError` that names it."""

from dataclasses import dataclass

import pytest
from eel_common.files.input_file import reading
from eel_common.texts import made, named_fields, parts_of_text, value_of


@dataclass
class Plate:
    area: float
    ratio: float = 2.0


def test_names_of_files_may_hold_spaces_signs_and_pluses(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert named_fields("body", "name", "my fish.csv  drag=by shape mass=7.2") == {
        "name": "my fish.csv",
        "drag": "by shape",
        "mass": "7.2",
    }
    assert parts_of_text("a.nc + gust start=3") == ["a.nc", "gust start=3"]
    for name in ("my fish a=1.csv", "a + b.nc"):
        (tmp_path / name).touch()
        assert named_fields("body", "name", name) == {"name": name} and parts_of_text(name) == [name]
    long = "links " + " ".join(f"field_{n}={n}" for n in range(100))  # longer than a name of a file may be
    assert len(named_fields("body", "name", long)) == 101 and parts_of_text(long) == [long]


@pytest.mark.parametrize("text", ["left left=", "left a=1 a=2", "left a=1 side=right", "left =2 b=3 b=4"])
def test_a_field_that_is_empty_or_comes_twice_is_named(text):
    with pytest.raises(ValueError, match="must have fields NAME=VALUE, each once, got"):
        named_fields("fins", "side", text)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3.0),
        ("1_0", "1_0"),
        ("on", True),
        ("1,x", (1.0, "x")),
        ("0,1;2,3", ((0.0, 1.0), (2.0, 3.0))),
        ("by shape", "by shape"),
    ],
)
def test_a_value_is_a_truth_a_number_rows_or_a_word(text, value):
    assert value_of(text) == value


def test_a_field_that_is_unknown_or_missing_is_named():
    assert made(Plate, {"area": 1.0}, "plate") == Plate(1.0)
    with pytest.raises(ValueError, match=r"plate has no field 'areas' \(did you mean 'area'\?\), it has: area, ratio"):
        made(Plate, {"areas": 1.0}, "plate")
    with pytest.raises(ValueError, match="plate area must be given"):
        made(Plate, {"ratio": 1.0}, "plate")


@pytest.mark.parametrize("error", [ZeroDivisionError("x"), TypeError("y"), OverflowError(34, "z")])
def test_whatever_is_raised_becomes_one_line(error):
    with pytest.raises(ValueError, match=r"^flow: it does not fit \((Zero|Type|Overflow)"), reading("flow"):
        raise error
