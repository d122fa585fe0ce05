# SPDX-License-Identifier: Apache-2.0
"""Tables of text: whatever the form, the numbers and times that went in come out; what is in doubt is refused."""

import numpy as np
import pytest
from eel_common.files.table import UNITS, split_name
from eel_common.files.tables import is_table, read_table
from eel_common.files.times import time_of

TIME = np.arange(40) / 50.0
VALUES = np.stack((np.sin(9.0 * TIME), 1e3 + np.cos(9.0 * TIME)), axis=1)
HEAD = "time_s", "x_m", "y_m"


def text_of(head=HEAD, stamps=None, by=1.0, separator=",", comma=False, end="\n"):
    """A table of TIME and VALUES, these times `by`."""
    stamps = [f"{each:.3f}" for each in TIME] if stamps is None else stamps
    rows = [[stamp, *(f"{by * each:.6f}" for each in row)] for stamp, row in zip(stamps, VALUES, strict=True)]
    body = end.join(separator.join(row) for row in rows)
    return f"{separator.join(head)}{end}{body.replace('.', ',') if comma else body}{end}"


def read(tmp_path, text, name="a.csv", encoding="utf-8", **options):
    (tmp_path / name).write_bytes(text.encode(encoding))
    return read_table(tmp_path / name, **options)


FORMS = {
    "commas": (text_of(), "utf-8", ""),
    "commas and blanks": (text_of(separator=", "), "utf-8", ""),
    "semicolons": (text_of(separator=";", comma=True, end="\r\n"), "utf-8-sig", "semicolons, decimal commas"),
    "tabs": (text_of(separator="\t", comma=True), "utf-16", "tabs, decimal commas, utf-16"),
    "blanks": ("# " + text_of(separator="  "), "utf-8", "blanks"),
    "bars": (text_of(separator="|", end="\r"), "utf-8", "bars"),
    "quotes": (f'"{text_of()[:-1]}"'.replace(",", '","').replace("\n", '"\n"'), "utf-8", ""),
    "latin-1": (text_of(head=("Uhrzeit_für / s", "x [m]", "y [m]")), "latin-1", "latin-1"),
    "empty cells at the end": (text_of().replace("\n", ",,\n"), "utf-8", ""),
    "units below": (text_of(head=("t", "x", "y")).replace("\n", "\ns,(mm),[mm]\n", 1).replace(
        text_of(head=("t", "x", "y"))[6:], text_of(by=1e3)[len("time_s,x_m,y_m\n"):]), "utf-8", ""),
    "lines above": ("eel, 2026\n\n" + text_of(), "utf-8", "1 lines above left out"),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_all_forms_of_a_table_give_the_same_numbers(tmp_path, form):
    text, encoding, notes = FORMS[form]
    table = read(tmp_path, text, encoding=encoding)
    found = np.stack([table.column(name, "m") for name in "xy"], axis=1)
    assert np.allclose(found, VALUES, atol=1e-6) and np.allclose(time_of(table), TIME)
    assert ", ".join(table.notes[: notes.count(",") + bool(notes)]) == notes


def test_names_of_columns_end_in_their_units():
    names = ["time_ms", "t [ms]", "time(ms)", "timeMs", "Zeit / ms", "header.stamp.ms", "time in ms"]
    assert {split_name(name)[1] for name in names} == {"ms"}
    assert split_name("yaw_1 [°]") == ("yaw_1", "°") and split_name("half_width_mm") == ("half_width", "mm")
    for name in ("time [ms] (raw)", "time_milliseconds", "time_millisecond"):
        assert UNITS[split_name(name)[1]] == ("s", 1e-3)
    for word, si, by in (
        ("metres", "m", 1.0),
        ("degree", "rad", np.pi / 180.0),
        ("minute", "s", 60.0),
        ("h", "s", 3600.0),
    ):
        assert UNITS[split_name(f"x_{word}")[1]] == (si, by)
    assert split_name("position[3]") == ("position_3", "") and split_name("s") == ("s", "")
    assert is_table("A.CSV") and not is_table("a.npz") and is_table("a.NPZ", ".npz")


def test_arrays_of_an_archive_are_columns_row_by_row_also_where_they_are_square(tmp_path):
    square, time, arc = np.arange(9.0).reshape(3, 3), np.array([0.0, 0.1, 0.2]), np.array([0.0, 0.5, 1.0])
    np.savez(tmp_path / "a.npz", time=time, arc=arc, y=square)
    table = read_table(tmp_path / "a.npz")
    assert np.array_equal(table.column("y"), square.ravel())
    assert np.array_equal(table.column("time"), np.repeat(time, 3))
    assert np.array_equal(table.column("arc"), np.tile(arc, 3))


DATES = 1764340000.0 + TIME


@pytest.mark.parametrize(
    ("name", "stamps", "about"),
    [
        ("time_us", [f"{1e6 * each:.0f}" for each in TIME], "time from time_us, us"),
        ("t", [f"{each:.2f}" for each in DATES], "time from t, s since 1970"),
        ("stamp", [f"{1e3 * each:.0f}" for each in DATES], "time from stamp, ms since 1970"),
        ("%time", [f"{1e9 * each:.0f}" for each in DATES], "time from time, ns since 1970"),
        ("date", [f"2026-11-28T17:00:{each:06.3f}+01:00" for each in TIME], "time from date, stamps"),
        ("clock", [f"23:59:59.{n:02d}" if n < 100 else f"0:00:00.{n - 100:02d}" for n in range(80, 160, 2)],
         "time from clock, stamps"),
        ("when", [f"{each:.2f}" for each in TIME], "time from when, s"),
    ],
)  # fmt: skip
def test_times_are_read_as_people_write_them(tmp_path, name, stamps, about):
    table = read(tmp_path, text_of(head=(name, "x", "y"), stamps=stamps))
    found = time_of(table, besides=[1, 2])
    assert np.allclose(found - found[0], TIME, atol=1e-6) and table.notes == [about]
    assert np.array_equal(time_of(table, "1"), found) and table.notes == [about]


def test_seconds_and_their_parts_may_stand_in_two_columns(tmp_path):
    text = text_of(head=("x", "y", "q"), stamps=[f"{int(each)},{1e9 * (each % 1.0):.0f}" for each in 1764340000 + TIME])
    for head in ("stamp.sec,stamp.nanosec,x,y\n", ""):  # ROS 2 prints none
        table = read(tmp_path, head + text.partition("\n")[2])
        assert np.allclose(time_of(table, besides=[2, 3]), TIME, atol=1e-6)

    degrees = ",".join(f"{0.01 * row:.2f}" for row in range(40))
    rows = "\n".join(f"{row},{angle},0" for row, angle in enumerate(degrees.split(",")))
    assert np.array_equal(time_of(read(tmp_path, f"sec,deg,x\n{rows}\n")), np.arange(40.0))  # no part of a second


@pytest.mark.parametrize(
    ("head", "first", "column"),
    [
        ("lifetime,time,x,y", "{n}", "time"),
        ("update_rate,min,ns,t,x", "{n},{n},{n}", "t"),
        ("altimeter,validated,elapsed time,x", "{n},{n}", "elapsed time"),
        ("start time,header.stamp,x", "5", "header.stamp"),
        ("Date,Time,x", "2026-11-28", "Time"),
        ("start time,when", "5", "when"),
        ("reaction time,time,x", "{n}", "time"),
    ],
)
def test_the_column_of_times_is_found_by_whole_words_of_its_name(tmp_path, head, first, column):
    stamp = "17:00:{t:06.3f}" if column == "Time" else "{t:.3f}"
    rows = [f"{first.format(n=7 * n)},{stamp.format(t=t)}" for n, t in enumerate(TIME)]
    table = read(tmp_path, "\n".join([head, *(f"{row}{',1' * (head.count(',') - row.count(','))}" for row in rows)]))
    found = time_of(table)
    assert np.allclose(found - found[0], TIME, atol=1e-6)
    assert not table.notes or f"time from {column}," in table.notes[0]


def test_rows_that_begin_with_a_hash_are_left_out(tmp_path):
    table = read(tmp_path, "a,b\n1,2\n#3,4\n# note,5\n6,7\n")
    assert table.column("b").tolist() == [2.0, 7.0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (text_of().replace(f"{VALUES[3, 0]:.6f}", '"1.234,5"'), "line 5: x_m must be a number, got '1.234,5'"),
        (text_of(separator=";", comma=True).replace(f"{VALUES[3, 1]:.6f}".replace(".", ","), "1.000"),
         "line 5: y_m must be a number, got '1.000'"),
        ('n\tx\n1\t"1,234"\n2\t"1,235"\n', "'1,234' may have a decimal comma or one of thousands"),
        (text_of(comma=True), "line 1: 3 names stand above 6 numbers: decimal commas need another separator"),
        (text_of().replace("x_m", "x_px"), "x_px must be in m, or units of it, got px"),
        (text_of().replace("y_m", "x_m"), "there must be one column x, got 2 in"),
        (text_of().replace("time_s", "time_ms (ticks)"), "must have a known unit in brackets, got 'ticks'"),
        (text_of().replace(f"{VALUES[3, 0]:.6f}", "1_0"), "line 5: x_m must be a number, got '1_0'"),
        (text_of().partition("\n")[2].replace(f"{VALUES[0, 0]:.6f}", "err", 1), "line 1: column 2 must be a number"),
        (text_of().replace("\n0.000", "\n#VALUE!", 1), "line 2: time_s must be a time, got '#VALUE!'"),
    ],
)  # fmt: skip
def test_what_may_mean_two_things_is_refused(tmp_path, text, words):
    with pytest.raises(ValueError) as refused:
        table = read(tmp_path, text)
        time_of(table)
        x, y = "23" if "2" in table else "xy"
        assert table.column(x, "m").size + table.column(y, "m").size
    assert words in str(refused.value) and "a.csv" in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("head", "stamps", "words"),
    [
        ("time_s", [f"{1e3 * each:.0f}" for each in DATES], "time_s must be a time before the year 2100 in s"),
        ("sample", [f"{n}" for n in range(40)], "its time is not plain from"),
        ("time", ["now"] * 40, "line 2: time must be a time, got 'now'"),
    ],
)
def test_times_that_are_not_plain_are_refused(tmp_path, head, stamps, words):
    with pytest.raises(ValueError, match=words):
        time_of(read(tmp_path, text_of(head=(head, "x", "y"), stamps=stamps)), besides=[1, 2])


def test_columns_are_chosen_by_number_name_or_pattern(tmp_path):
    table = read(tmp_path, "time,a_1,a_2,b,note\n0,1,2,3,good\n1,4,5,6,\n")
    assert table.chosen("2-3,b", "columns") == table.chosen("a_*,4", "columns") == [1, 2, 3]
    assert table.texts(4) == ["good", ""] and not table.has_numbers(4)
    named = read(tmp_path, "time,1,2,3,note\n0,1,2,3,a\n1,4,5,6,b\n")
    assert named.chosen("1-3", "columns") == named.chosen("1,2,3", "columns") == [1, 2, 3]
    for text in ("c", "2,a_1", "4-9", "0"):
        with pytest.raises(ValueError, match="columns must name columns among the 5 of the file, each once"):
            table.chosen(text, "columns")
