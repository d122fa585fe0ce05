# SPDX-License-Identifier: Apache-2.0
"""Body files: what cannot be is one line that names the file and the column; what is meant is read."""

import os

import numpy as np
import pytest
from eel_dynamics.model import Body

GOOD = "x,half_width,half_height\n0,0,0\n0.3,0.02,0.03\n0.6,0.02,0.03\n1,0.01,0.01\n"


def body_of(tmp_path, text, name="fish.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_text(text, encoding=encoding)
    return Body.from_file(path)


@pytest.mark.fault("parameters", "a body file with a byte order mark, as spreadsheets write it", "read")
def test_a_byte_order_mark_is_no_part_of_the_first_name(tmp_path):
    plain, marked = body_of(tmp_path, GOOD), body_of(tmp_path, GOOD, encoding="utf-8-sig")
    x = np.linspace(0.0, 1.0, 11)
    assert np.array_equal(plain.half_width(x), marked.half_width(x)) and marked.half_width(0.3) == 0.02


@pytest.mark.fault(
    "parameters",
    "a body file with complex columns, an open quote, a cell of 200 kB, rows of different lengths or no rows; a FIFO",
    "one short line that names the file, the line and the column; status 2",
)
@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (GOOD.replace("0.02", "0.02+1j", 1), "line 3: half_width must be a number, got '0.02+1j'"),
        (GOOD.replace("0.02", '"0.02', 1), "line 5: unexpected end of data"),
        (GOOD.replace("0.02", "9" * 200_000, 1), "line 3: field larger than field limit"),
        (GOOD.replace("0.02", "x" * 100_000, 1), f"line 3: half_width must be a number, got '{'x' * 37}"),
        (GOOD.replace("0.02,", "", 1), "line 3: a row must have 3 fields, as the header has, got 2"),
        (GOOD.replace("0.02", "1e308", 1), "line 3: half_width must be at most 1e+06, got 1e+308"),
        (GOOD.replace("0.02", "nan", 1), "line 3: half_width must be finite, got nan"),
        (GOOD.replace("\n", ",0\n").replace("height,0", "height,x"), "there must be one column x, got 2 in"),
        (GOOD.replace("half_width", "width"), "must have columns x, half_width, half_height; half_width missing"),
        ("x,half_width,half_height\n", "it has a header and no row"),
        ("", "it is empty"),
    ],
)
def test_what_a_csv_file_cannot_hold_is_one_short_line(tmp_path, text, reason):
    with pytest.raises(ValueError) as refused:
        body_of(tmp_path, text)
    told = str(refused.value)
    assert reason in told and "\n" not in told and len(told) < 300


def test_complex_columns_of_an_archive_are_refused(tmp_path):
    x = np.linspace(0.0, 1.0, 5)
    width = 0.02 * np.sqrt(x)
    columns = {"x": x, "half_width": width + 1e-3j, "half_height": width}
    np.savez(tmp_path / "fish.npz", **columns)
    with pytest.raises(ValueError, match=r"fish.npz': 'half_width' must be an array of real numbers, got '<c16'"):
        Body.from_file(tmp_path / "fish.npz")
    with pytest.raises(ValueError, match="body half_width must be real numbers"):
        Body(**columns)


def test_a_fifo_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "fish.csv")
    with pytest.raises(ValueError, match=r"fish\.csv': it is no regular file"):
        Body.from_file(tmp_path / "fish.csv")


@pytest.mark.fault(
    "parameters", "a body file whose body is longer than 100 m", "one warning that asks whether its columns are in m"
)
def test_a_body_in_millimetres_is_asked_about(tmp_path, recwarn):
    body_of(tmp_path, GOOD)
    assert not recwarn.list
    rows = [line.split(",") for line in GOOD.splitlines()[1:]]
    text = "x,half_width,half_height\n" + "\n".join(",".join(str(1e3 * float(cell)) for cell in row) for row in rows)
    with pytest.warns(UserWarning, match=r"fish\.csv is 1000 m long: are its columns in m\?"):
        body_of(tmp_path, text)
