# SPDX-License-Identifier: Apache-2.0
"""The drag's kinks along the body: which of them are integrated exactly, by the accuracy. How they are found is tested
in eel_core."""

import numpy as np
import pytest

import eel_core
from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling

KINDS = np.array(["friction", "lateral", "vertical", "roll", "links", "base"])


def drag_powers(friction: str, kinks: str) -> np.ndarray:
    """Powers (T, 6) [W] of the kinds of drag along the body, at some instants of one swim."""
    scene, law = Scene(friction=friction), falling()
    swimmer = Simulation(scene=scene, law=law, accuracy=Accuracy(name="some", resolution=13.0, tolerance=1e-4))
    other = Simulation(scene=scene, law=law, accuracy=Accuracy(name="some", resolution=13.0, kinks=kinks))
    times, seen = np.arange(2.0, 4.0, 0.1), []
    for time in times:
        swimmer.advance(time)
        seen.append(swimmer.observe())
    twists = np.array([each.twist for each in seen])
    poses = np.array([[*each.position, *each.orientation] for each in seen])
    powers, instant = np.empty((len(times), 6)), eel_core.Instant(other.discretisation.swimmer)
    water = other.swimmer.current, other.swimmer.core_flow
    instant.drag_powers(other.law_on_grid, times, twists, powers, *water, poses, np.empty((len(times), 2, 0)))
    return powers


@pytest.mark.parametrize("friction", ["printed", "laminar"])
def test_accuracy_says_which_are_integrated_exactly(friction):
    summed = drag_powers(friction, "none")

    def exact(kinks: str) -> set[str]:
        """Kinds of drag that differ from their sum over the nodes as they are."""
        differ = ~np.isclose(drag_powers(friction, kinks), summed, rtol=1e-12, atol=0.0).all(axis=0)
        return set(KINDS[differ])

    smooth, jump = {"lateral", "vertical", "roll"}, {"friction"} if friction == "printed" else set()
    assert exact("all") == smooth | jump
    assert exact("jumps") == jump
    assert exact("none") == set()


def test_what_is_not_looked_for_costs_accuracy():
    exact = simulate(falling(), 3.0, accuracy=1e-8)
    error = {}
    for kinks in ("all", "jumps", "none"):
        fine_in_time = Accuracy(name=kinks, resolution=30.0, kinks=kinks, tolerance=1e-10)
        run = simulate(falling(), 3.0, accuracy=fine_in_time)
        error[kinks] = np.linalg.norm(run.position[-1] - exact.position[-1])
    assert error["all"] < 0.1 * error["jumps"] < 0.1 * error["none"]


def test_other_kinks_are_refused():
    with pytest.raises(ValueError, match="accuracy kinks must be one of all, jumps, none, got 'some'"):
        Accuracy(name="some", resolution=13.0, kinks="some")
