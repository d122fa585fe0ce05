"""The drag's kinks along the body: where they are found, and which of them, by the accuracy."""

import numpy as np
import pytest
from eel_dynamics.kinks import HEIGHT, RATIO, ROLL, SIDE, ZERO, zero_between
from numba import njit

from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling, straight

SWIMMER = Simulation(accuracy=Accuracy(name="panels", resolution=13.0), law=straight()).swimmer
PANEL = int(SWIMMER.first[np.argmax(SWIMMER.count[: len(SWIMMER.x)])])  # the first node of the widest
NODES = int(SWIMMER.count[PANEL])
FRACTION = SWIMMER.fraction[PANEL : PANEL + NODES]


@njit(error_model="numpy")
def place(swimmer, values, begin, count, node, before):
    return zero_between(swimmer, values, ZERO, np.uintp(begin), count, np.uintp(node), before, True)


def zero_of(function, before=None) -> float:
    """Where the search finds the zero of a `function` of the panel's fraction; `before`: its value at the panel's
    start."""
    values = np.zeros((1, len(SWIMMER.fraction)))
    values[0, PANEL : PANEL + NODES] = function(FRACTION)
    signs = function(FRACTION) > 0.0
    known = function(0.0) if before is None else before
    node = int(np.argmax(signs != (known > 0.0)))
    return place(SWIMMER, values, PANEL, NODES, PANEL + node, known if node == 0 else values[0, PANEL + node - 1])


@pytest.mark.parametrize("zero", [1e-9, 0.003, 0.2, 0.5, 0.77, 0.999, 1.0 - 1e-9])
@pytest.mark.parametrize(
    "shape",
    [
        lambda s: s,
        lambda s: -s * (1.0 + s),
        lambda s: np.expm1(3.0 * s),
        lambda s: s**3 + 1e-3 * s,
        lambda s: np.tanh(4.0 * s),
    ],
    ids=["linear", "square", "exponential", "cubic", "steep"],
)
def test_zero_of_the_panels_polynomial(shape, zero):
    polynomial = np.polynomial.Polynomial.fit(FRACTION, shape(FRACTION - zero), NODES - 1)
    found = zero_of(lambda s: shape(s - zero))
    assert abs(polynomial(found)) < 1e-11
    if shape(1.0) == 1.0:
        assert found == pytest.approx(zero, abs=1e-12)


def test_zero_before_the_panel_counts_as_its_start():
    assert zero_of(lambda s: 0.3 + s, before=-1e-6) == 0.0


def kinds(friction: str, kinks: str) -> set[int]:
    accuracy = Accuracy(name="some", resolution=13.0, kinks=kinks, tolerance=1e-4)
    swimmer, found = Simulation(scene=Scene(friction=friction), accuracy=accuracy, law=falling()), set()
    for time in np.arange(2.0, 4.0, 0.1):
        swimmer.advance(time)
        swimmer.observe()
        steps = swimmer.fields.kinks
        found |= set(steps.kind[: steps.number[0]].tolist())
    return found


@pytest.mark.parametrize("friction", ["printed", "laminar"])
def test_accuracy_says_which_are_looked_for(friction):
    smooth, jump = {int(SIDE), int(HEIGHT), int(ROLL)}, {int(RATIO)} if friction == "printed" else set()
    assert kinds(friction, "all") == smooth | jump
    assert kinds(friction, "jumps") == jump
    assert kinds(friction, "none") == set()


def test_what_is_not_looked_for_costs_accuracy():
    exact = simulate(falling(), 3.0, accuracy=1e-7)
    error = {}
    for kinks in ("all", "jumps", "none"):
        run = simulate(falling(), 3.0, accuracy=Accuracy(name=kinks, resolution=30.0, kinks=kinks, tolerance=1e-8))
        error[kinks] = np.linalg.norm(run.position[-1] - exact.position[-1])
    assert error["all"] < 0.1 * error["jumps"] < 0.1 * error["none"]


def test_other_kinks_are_refused():
    with pytest.raises(ValueError, match="accuracy kinks must be one of all, jumps, none, got 'some'"):
        Accuracy(name="some", resolution=13.0, kinks="some")
