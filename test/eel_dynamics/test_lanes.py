"""Eight numbers at once give what numbers one by one give; and the small pieces of an evaluation that are built of
them."""

import numpy as np
import pytest
from eel_dynamics.drag import inverse_fifth_root
from eel_dynamics.drive import cosine_and_sine
from eel_dynamics.kernel import integrate
from eel_dynamics.lanes import (
    ALIGNMENT,
    aligned,
    aligned_zeros,
    any_of,
    below,
    bits,
    first,
    floor,
    following,
    last,
    lowest,
    moved1,
    moved2,
    moved4,
    padded,
    put,
    root,
    signed,
    size,
    spread,
    take,
    total,
    where,
    work_space,
)
from eel_dynamics.momentum import factors_of, is_definite, solve, solved
from eel_dynamics.quadrature import Grid, Panel
from eel_dynamics.rotations import turns
from numba import njit

A = np.array([3.0, -1.5, 0.25, -0.0, 7.0, -2.0, 1e-3, 40.0])
B = np.array([-2.0, 0.5, 8.0, 1.0, -0.125, 3.0, -1.0, 0.7])
GRID = Grid.of(
    (
        Panel(start=0.0, end=0.3, points=7, graded="start"),
        Panel(start=0.3, end=0.9, points=11),
        Panel(start=0.9, end=1.0, points=6, graded="end"),
    )
)


@njit
def arithmetic(a, b, out):
    x, y = take(a, 0), take(b, 0)
    put(out, 0, 0, x + y)
    put(out, 1, 0, x - 2.0)
    put(out, 2, 0, 3 * x * y)
    put(out, 3, 0, 1.0 / y)
    x += y
    x -= 1.0
    x *= y
    x /= 4.0
    put(out, 4, 0, -x)
    return first(y), last(y), total(y)


@njit
def functions(a, b, out):
    x, y = take(a, 0), take(b, 0)
    put(out, 0, 0, size(x))
    put(out, 1, 0, root(size(x)))
    put(out, 2, 0, floor(x))
    put(out, 3, 0, signed(x, y))
    put(out, 4, 0, where(x > y, x, spread(9.0)))
    put(out, 5, 0, following(x))
    put(out, 6, 0, moved1(x, 5.0))
    put(out, 7, 0, moved2(x, 5.0))
    put(out, 8, 0, moved4(x, 5.0))
    put(out, 9, 0, where(below(3), x, y))
    return bits(x < y), bits(x >= 0.0), bits(x <= -1.5), any_of(x > 50.0), any_of(x > 39.0)


def test_arithmetic_is_that_of_the_numbers():
    out = aligned_zeros(5, 8)
    one, eight, whole = arithmetic(A, B, out)
    np.testing.assert_allclose(out, [A + B, A - 2.0, 3.0 * A * B, 1.0 / B, -(A + B - 1.0) * B / 4.0], rtol=4e-16)
    assert (one, eight) == (B[0], B[7])
    assert whole == pytest.approx(B.sum(), rel=1e-15)


def test_functions_and_choices_are_those_of_the_numbers():
    out = aligned_zeros(10, 8)
    *masks, above, within = functions(A, B, out)
    expected = [np.abs(A), np.sqrt(np.abs(A)), np.floor(A), np.copysign(A, B), np.where(A > B, A, 9.0)]
    expected += [np.append(A[1:], A[7]), *(np.append(np.full(k, 5.0), A[: 8 - k]) for k in (1, 2, 4))]
    expected += [np.append(A[:3], B[3:])]
    np.testing.assert_array_equal(out, expected)
    assert masks == [sum(1 << k for k in np.flatnonzero(mask)) for mask in (A < B, A >= 0.0, A <= -1.5)]
    assert not above and within


def test_lowest_bit():
    @njit
    def of(value):
        return lowest(value)

    assert [of(value) for value in (1, 6, 128, 200, 1 << 40)] == [0, 1, 7, 3, 40]


def test_arrays_are_taken_from_any_of_their_numbers():
    values = aligned(np.arange(36.0).reshape(2, 18), 24)

    @njit
    def third_of_second_row(values, out):
        put(out, 0, take(values, 1, 3))

    out = np.zeros(8)
    third_of_second_row(values, out)
    np.testing.assert_array_equal(out, values[1, 3:11])
    assert values.ctypes.data % ALIGNMENT == 0


@pytest.mark.parametrize("nodes", [1, 8, 9, 17, 200])
def test_eight_can_be_taken_from_the_last_node(nodes):
    assert padded(nodes) % 8 == 0
    assert nodes - 1 + 8 <= padded(nodes) < nodes + 15
    rows = list(work_space(((3,), (), (2, 3)), nodes))
    assert [row.shape for row in rows] == [(3, padded(nodes)), (padded(nodes),), (2, 3, padded(nodes))]
    assert all(row.ctypes.data % ALIGNMENT == 0 for row in rows)


@njit
def _by_eights(function, x, y):
    for i in range(0, len(x), 8):
        put(y, i, function(take(x, i)))


def test_inverse_fifth_root_to_round_off():
    x = np.exp(np.linspace(-69.0, 23.0, 8000))
    y = np.zeros_like(x)
    _by_eights(inverse_fifth_root, x, y)
    np.testing.assert_allclose(y, x**-0.2, rtol=4e-15)


def test_cosine_and_sine_to_round_off():
    angle = np.concatenate((np.linspace(-20.0, 20.0, 4000), np.linspace(9e4, 1e5, 4000)))

    @njit
    def both(angle, out):
        for i in range(0, len(angle), 8):
            c, s = cosine_and_sine(take(angle, i))
            put(out, 0, i, c)
            put(out, 1, i, s)
        return cosine_and_sine(angle[7])

    out = np.zeros((2, len(angle)))
    one = both(angle, out)
    np.testing.assert_allclose(out, (np.cos(angle), np.sin(angle)), atol=1e-15 + 1e-16 * np.abs(angle).max())
    np.testing.assert_allclose(out[:, :4000], (np.cos(angle[:4000]), np.sin(angle[:4000])), atol=5e-16)
    np.testing.assert_allclose(one, (np.cos(angle[7]), np.sin(angle[7])), atol=5e-16)


@pytest.mark.parametrize("at", [None, np.array([0.0, 0.01, 0.3, 0.31, 0.5, 0.77, 0.9, 0.93, 0.95, 0.99, 1.0])])
def test_blocks_integrate_polynomials_to_their_points(at):
    x = GRID.x if at is None else at
    integrand = aligned(np.array([np.ones_like(GRID.x), GRID.x, 1.0 + GRID.x**2]))
    known = aligned(np.array([GRID.x, GRID.x**2 / 2.0, GRID.x + GRID.x**3 / 3.0]))
    result = known * 0.0 if at is None else aligned_zeros(3, padded(len(at)))

    @njit
    def run(upto, integrand, known, head, result):
        integrate(upto, integrand, 0, known, head, result)

    upto = GRID.blocks(at)
    run(upto, integrand, result if at is None else known, (0.0, 0.0, 0.0), result)
    exact = np.array([x, x**2 / 2.0, x + x**3 / 3.0])
    np.testing.assert_allclose(result[:, : len(x)], exact, atol=2e-15)
    assert np.all(np.diff(upto.place[: len(x)]) > 0.0)


LOWER = np.tril_indices(6)


@njit
def _called(part, *arguments):
    return part(*arguments)


def test_factors_solve_and_know_what_is_not_positive():
    rng = np.random.default_rng(5)
    for _ in range(50):
        root_of_it = rng.normal(size=(6, 6)) * np.exp(rng.uniform(-4.0, 4.0, 6))[:, None]
        matrix, right = root_of_it @ root_of_it.T, rng.normal(size=6)
        factors = _called(factors_of, tuple(matrix[LOWER]))
        x = np.array(_called(solved, factors, tuple(right)))
        assert _called(is_definite, factors)
        np.testing.assert_allclose(matrix @ x, right, atol=1e-9 * np.abs(matrix).max() * np.abs(x).max())
        kept, again = np.zeros((6, 6)), right.copy()
        kept[LOWER] = factors
        _called(solve, kept, again)
        np.testing.assert_array_equal(again, x)
        negative = matrix.copy()
        index = rng.integers(6)
        negative[index, index] = -negative[index, index]
        assert not _called(is_definite, _called(factors_of, tuple(negative[LOWER])))
    for value in (np.nan, 0.0, np.inf):
        assert not _called(is_definite, _called(factors_of, tuple((value * np.ones((6, 6)))[LOWER])))


@pytest.mark.parametrize("angle", [1e-9, 0.3, 0.99, 1.01, 2.5, 9.0])
def test_a_turn_about_one_axis_is_exact_however_large(angle):
    bend, turn = aligned_zeros(3, 2, 16), aligned_zeros(4, 16)
    bend[0, 0], bend[0, 1] = 0.6 * angle, 0.8 * angle
    _called(turns, bend, 1, turn)
    expected = [0.0, 0.6 * np.sin(angle / 2.0), 0.8 * np.sin(angle / 2.0), np.cos(angle / 2.0)]
    np.testing.assert_allclose(turn[:, :8], np.repeat(expected, 8).reshape(4, 8), atol=3e-16)
