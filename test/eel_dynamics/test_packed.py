"""What is packed comes out as it went in, in Python and in compiled loops."""

from copy import deepcopy
from typing import NamedTuple

import numpy as np
import pytest
from eel_dynamics.kernel import fields_of
from eel_dynamics.packed import Layout, opener
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


open_outer = opener(outer)


@njit
def look_and_change(packed):
    value = open_outer(packed)
    value.cube[1, 2, 3] += 100.0
    value.step[0] -= 1
    numbers = value.inner.row[1], value.inner.count, value.number, value.switch
    return numbers, value.cube.shape, value.cube.sum(), value.index[0], len(value.inner.row)


def test_python_sees_what_was_packed():
    space = Layout(outer()).space()
    for got, wanted in zip(space.views, outer(), strict=True):
        np.testing.assert_equal(got, wanted)
        assert type(got) is type(wanted)
    assert np.signbit(space.views.inner.row[0])
    np.testing.assert_array_equal(space.view("step"), outer().step)


def test_compiled_loops_see_it_and_change_it_in_place():
    space = Layout(outer()).space()
    numbers, shape, total, index, length = look_and_change(space.packed)
    assert numbers == (1e-300, -7, -2.5e-310, True)
    assert (shape, total, index, length) == ((2, 3, 4), 276.0 + 100.0, 2**63 + 5, 3)
    assert space.views.cube[1, 2, 3] == 123.0 and space.view("step").tolist() == [-2, 4]


def test_spaces_have_memory_of_their_own():
    layout = Layout(outer())
    first, second = layout.space(), layout.space()
    first.views.cube[:] = 0.0
    np.testing.assert_array_equal(second.views.cube, outer().cube)
    np.testing.assert_array_equal(layout.space().views.cube, outer().cube)


def test_arrays_begin_where_eight_numbers_are_loaded_at_once():
    fields = Layout(fields_of(13, 3, 7)).space().views
    for array in (fields.turn, fields.R, fields.factor, fields.kinks.density):
        assert array.__array_interface__["data"][0] % 64 == 0


def test_what_is_neither_array_nor_number_is_refused():
    with pytest.raises(TypeError, match="what is packed must be arrays, whole numbers or floats, got 'text'"):
        Layout(Inner(np.zeros(3), "text"))


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
