# SPDX-License-Identifier: Apache-2.0
"""A copy of a simulation goes on by itself, to the same bits, and leaves the original as it was."""

import copy

import numpy as np
import pytest
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

import eel_core
from eel_dynamics import Scene, Simulation
from eel_gaits import falling, straight

SHORT_WAVES = Law(Term(axis="yaw", amplitude=(6.0,), wavelength=0.2, period=0.5, envelope=(Ramp(0.0, 0.5, 1.0),)))
POINTS = np.linspace(0.0, 1.0, 21)


def present(simulation: Simulation) -> tuple:
    """All that a simulation tells of its present, as bytes and numbers."""
    numbers = simulation.state, simulation.works, simulation.observe().whole
    told = simulation.time, simulation.evaluations, simulation.accuracy, len(simulation.grid.x)
    return *(array.tobytes() for array in numbers), *told, simulation.law, simulation.samples_until


def add_samples(simulation: Simulation, first: int, last: int):
    """A controller's samples of a yaw wave at number `first` to `last` of 1/20 s."""
    for number in range(first, last):
        turn = 6.0 * POINTS - 5.0 * number / 20.0
        none, wave = np.zeros(len(POINTS)), (np.sin(turn), -5.0 * np.cos(turn), -25.0 * np.sin(turn))
        simulation.add_samples(number / 20.0, POINTS, none, none, none, *wave)


def swimming(**arguments) -> Simulation:
    simulation = Simulation(law=straight(), stations=7, **arguments)
    simulation.advance(0.53)
    return simulation


def blending(**arguments) -> Simulation:
    simulation = swimming(**arguments)
    simulation.adopt(SHORT_WAVES, transition=0.7)
    simulation.advance(0.8)
    return simulation


def led(**arguments) -> Simulation:
    simulation = swimming(**arguments)
    add_samples(simulation, 11, 30)
    simulation.advance(0.72)
    return simulation


@pytest.mark.parametrize("scene", [Scene(), Scene(planar=True), Scene(ledger=False, internal_wrench=False)])
@pytest.mark.parametrize("accuracy", ["draft", 1e-5, "1e-3, fixed steps"])
@pytest.mark.parametrize("make", [swimming, blending, led])
def test_a_copy_goes_on_to_the_same_bits_and_leaves_the_original_untouched(make, accuracy, scene):
    original = make(accuracy=accuracy, scene=scene)
    before = present(original)
    first, second = copy.deepcopy(original), copy.deepcopy(original)
    assert present(first) == before
    for each in (1.0, 1.9):
        first.advance(each)
    second.adopt(straight(period=0.6))
    second.advance(1.0)
    second.reset()
    assert present(original) == before
    for each in (1.0, 1.9):
        original.advance(each)
    assert present(original) == present(first)
    assert present(original) != before


def test_samples_of_a_copy_are_its_own():
    original = led()
    changed = copy.deepcopy(original)
    add_samples(changed, 30, 40)
    assert (original.samples_until, changed.samples_until) == (1.45, 1.95)


def test_a_copy_of_a_march_shares_what_never_changes():
    simulation = Simulation(law=falling())
    for constant in (simulation.discretisation.swimmer, simulation.law_on_grid):
        assert copy.copy(constant) is constant and copy.deepcopy(constant) is constant
    march = eel_core.March(simulation.discretisation.swimmer, "adams", 4, False)
    assert copy.copy(march).counts == (0, 0, 0)
    with pytest.raises(RuntimeError, match="follows no law"):
        copy.copy(march).advance(1.0)
