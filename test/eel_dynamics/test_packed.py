"""What is packed comes out as it went in, in Python and in compiled loops."""

from copy import deepcopy
from typing import NamedTuple

import numpy as np
import pytest
from eel_dynamics.leg import scratch_layout
from eel_dynamics.packed import Form, Layout
from numba import njit

from eel_dynamics import Simulation
from eel_gaits import falling


class Inner(NamedTuple):
    row: np.ndarray
    count: int


class Outer(NamedTuple):
    cube: np.ndarray
    inner: Inner
    number: float
    switch: bool
    index: np.ndarray
    step: np.ndarray


def outer() -> Outer:
    return Outer(
        cube=np.arange(24.0).reshape(2, 3, 4),
        inner=Inner(np.array([-0.0, 1e-300, np.inf]), -7),
        number=-2.5e-310,
        switch=True,
        index=np.array([2**63 + 5, 3], dtype=np.uintp),
        step=np.array([-1, 4], dtype=np.int64),
    )


FORM = Form(outer)
open_outer, open_inner = FORM.opener(), FORM.opener("inner")


@njit
def look_and_change(row):
    value = open_outer(row)
    value.cube[1, 2, 3] += 100.0
    value.step[0] -= 1
    numbers = value.inner.row[1], value.inner.count, value.number, value.switch
    return numbers, value.cube.shape, value.cube.sum(), value.index[0], len(open_inner(row).row)


def test_python_sees_what_was_packed():
    space = Layout(FORM, outer()).space()
    for got, wanted in zip(space.views, outer(), strict=True):
        np.testing.assert_equal(got, wanted)
        assert type(got) is type(wanted)
    assert np.signbit(space.views.inner.row[0])
    np.testing.assert_array_equal(space.view("step"), outer().step)


@pytest.mark.parametrize("kind", ["in one piece of memory", "as it is"])
def test_compiled_loops_see_it_and_change_it_in_place(kind):
    if kind == "as it is":
        kept = FORM.packed(outer())
        value = kept.value
    else:
        kept = Layout(FORM, outer()).space()
        value = kept.views
    numbers, shape, total, index, length = look_and_change(kept.row)
    assert numbers == (1e-300, -7, -2.5e-310, True)
    assert (shape, total, index, length) == ((2, 3, 4), 276.0 + 100.0, 2**63 + 5, 3)
    assert value.cube[1, 2, 3] == 123.0 and value.step.tolist() == [-2, 4]


def test_spaces_have_memory_of_their_own():
    layout = Layout(FORM, outer())
    first, second = layout.space(), layout.space()
    first.views.cube[:] = 0.0
    np.testing.assert_array_equal(second.views.cube, outer().cube)
    np.testing.assert_array_equal(layout.space().views.cube, outer().cube)


@pytest.mark.parametrize("make", [lambda: FORM.packed(outer()), lambda: Layout(FORM, outer()).space()])
def test_the_row_of_a_copy_is_of_its_own_arrays(make):
    first = make()
    look_and_change(first.row)
    second = deepcopy(first)
    look_and_change(second.row)
    for kept, cube in ((first, 123.0), (second, 223.0)):
        assert (kept.value if hasattr(kept, "value") else kept.views).cube[1, 2, 3] == cube


def test_arrays_begin_where_eight_numbers_are_loaded_at_once():
    fields = scratch_layout(13, 7, 3, 5).space().views.fields
    for array in (fields.turn, fields.R, fields.factor, fields.kinks.density):
        assert array.__array_interface__["data"][0] % 64 == 0


def test_where_the_fields_lie():
    assert FORM.places["cube"] == slice(0, 4) and FORM.places["number"] == slice(7, 8) and FORM.words == 13


@pytest.mark.parametrize(
    "change, message",
    [
        ({"cube": np.zeros((2, 3, 4), dtype=np.float32)}, "array must be of type 'd', got 'f'"),
        ({"index": np.zeros(2, dtype=np.int64)}, "array must be of type 'L', got 'l'"),
        ({"step": np.zeros((2, 2), dtype=np.int64)}, "value must be of the form"),
        ({"number": "1.0"}, "value must be of the form"),
        ({"cube": np.zeros((4, 3, 2)).T}, "not C contiguous"),
        ({"number": np.zeros(1)}, "value must be of the form"),
    ],
)
def test_what_is_of_another_form_is_refused(change, message):
    with pytest.raises(TypeError, match=message):
        FORM.row(outer()._replace(**change))


def test_what_is_neither_array_nor_number_has_no_form():
    with pytest.raises(TypeError, match="arrays of eight-byte numbers, whole numbers or floats, got 'text'"):
        Form(lambda: Inner(np.zeros(3), "text")).row(outer().inner)


def test_a_copy_of_a_simulation_goes_on_by_itself():
    first = Simulation(law=falling())
    first.advance(1.0)
    first.observe()
    assert len(first.fields.kinks.kind) and first.step.time[0] > 0.0
    second = deepcopy(first)
    second.advance(2.0)
    there = second.observe().position.copy()
    assert first.time == 1.0 and first.step.time[0] < 1.1 < second.step.time[0] + 0.2
    first.advance(2.0)
    np.testing.assert_array_equal(first.observe().position, there)
