# SPDX-License-Identifier: Apache-2.0
"""The natural cubic spline against scipy's, and its limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from eel_gaits import natural_spline


@given(count=st.integers(3, 60), rows=st.integers(1, 6), seed=st.integers(0, 10**6))
def test_agrees_with_scipy_between_the_knots(count, rows, seed):
    random = np.random.default_rng(seed)
    knots = np.cumsum(random.uniform(0.05, 1.0, count))
    values = random.normal(size=(rows, count))
    x = random.uniform(knots[0], knots[-1], 50)
    expected = CubicSpline(knots, values, axis=-1, bc_type="natural")(x)
    np.testing.assert_allclose(natural_spline(knots, values, x), expected, rtol=0.0, atol=1e-11)


@given(count=st.integers(3, 20), seed=st.integers(0, 10**6))
def test_goes_on_straight_beyond_the_knots(count, seed):
    random = np.random.default_rng(seed)
    knots = np.cumsum(random.uniform(0.05, 1.0, count))
    values = random.normal(size=count)
    spline = CubicSpline(knots, values, bc_type="natural")
    below, above = knots[0] - np.array([0.5, 0.1, 0.0]), knots[-1] + np.array([0.0, 0.1, 2.0])
    np.testing.assert_allclose(
        natural_spline(knots, values, below), values[0] + spline(knots[0], 1) * (below - knots[0]), atol=1e-10
    )
    np.testing.assert_allclose(
        natural_spline(knots, values, above), values[-1] + spline(knots[-1], 1) * (above - knots[-1]), atol=1e-10
    )


def test_two_knots_are_a_straight_line():
    x = np.array([-1.0, 0.0, 0.25, 1.0, 3.0])
    np.testing.assert_allclose(natural_spline([0.0, 1.0], [2.0, 6.0], x), 2.0 + 4.0 * x, atol=1e-14)


def test_reproduces_a_straight_line_and_meets_its_knots_exactly():
    knots = np.array([0.0, 0.1, 0.4, 1.0])
    np.testing.assert_allclose(natural_spline(knots, 3.0 - 2.0 * knots, [0.05, 0.7, 2.0]), [2.9, 1.6, -1.0], atol=1e-14)
    values = np.array([1.51, 0.48, 5.74, 2.73])
    np.testing.assert_allclose(natural_spline(knots, values, knots), values, atol=1e-14)


def test_rows_are_independent_and_give_the_matrix_of_the_spline():
    random = np.random.default_rng(3)
    knots, x = np.linspace(0.0, 1.0, 9), np.linspace(-0.2, 1.2, 31)
    values = random.normal(size=(2, 3, 9))
    together = natural_spline(knots, values, x)
    assert together.shape == (2, 3, 31)
    matrix = natural_spline(knots, np.eye(9), x).T
    np.testing.assert_allclose(together, values @ matrix.T, atol=1e-13)
    np.testing.assert_array_equal(together[1, 2], natural_spline(knots, values[1, 2], x))


@pytest.mark.parametrize(
    ("knots", "values", "named"),
    [
        ([0.0], [1.0], "knots must be a row of at least 2"),
        ([0.0, 0.0], [1.0, 2.0], "knots must be finite and strictly increasing"),
        ([0.0, np.nan], [1.0, 2.0], "knots must be finite"),
        ([[0.0, 1.0]], [1.0, 2.0], "knots must be a row"),
        ([0.0, 1.0], [1.0, 2.0, 3.0], "values must have 2 entries per row"),
        ([0.0, 1.0], 1.0, "values must have 2 entries per row"),
    ],
)
def test_refuses_what_does_not_fit(knots, values, named):
    with pytest.raises(ValueError, match=named):
        natural_spline(knots, values, [0.5])
