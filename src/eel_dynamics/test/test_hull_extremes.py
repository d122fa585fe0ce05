# SPDX-License-Identifier: Apache-2.0
"""Hulls at their extremes run, and close their ledger within what they tell, or are refused."""

import numpy as np
import pytest

from eel_dynamics import Appendage, Body, simulate
from eel_gaits import still, straight

FORWARDS, BACKWARDS, HOVER = 0.3, -0.3, 0.0  # m/s
TARGET = 1e-3


def robot(links: int = 8, drag: float | None = None, law: str = "axis", joints: float = 0.65) -> Body:
    """A robot of 1 m; with an appendage above its third part whose drag areas are `drag` [m^2]."""
    arms = [] if drag is None else [Appendage(x=0.3, z=0.05, drag1=drag, drag2=drag, drag3=drag, law=law)]
    return Body.of_links(1.0, links, 0.03, 0.04, joints=joints, appendages=arms)


def swum(body: Body, gait, speed: float = HOVER, duration: float = 2.0):
    """From a speed [m/s] on: of the target, or told, with a closed ledger."""
    run = simulate(gait, duration, body=body, twist=(0.0, 0.0, 0.0, speed, 0.0, 0.0), accuracy=TARGET)
    amounts = [np.abs(each).max() for name, each in vars(run.energy).items() if name.endswith(("work", "energy"))]
    assert np.isfinite(run.torque).all() and np.isfinite(run.position).all()
    assert run.error_estimate.worst <= TARGET or run.warnings
    assert np.abs(run.energy.residual).max() <= 0.02 * max(*amounts, 1e-12)
    return run


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("law", ["axis", "speed"])
@pytest.mark.parametrize("drag", [1e-12, 1e-4, 0.1, 0.999])
def test_any_area_of_an_appendage_is_swum(drag, law):
    """Up to the square of the body's length, which is 200 times its own section's area."""
    run, bare = swum(robot(drag=drag, law=law), straight()), swum(robot(), straight())
    travelled = [np.linalg.norm(each.position[-1] - each.position[0]) for each in (run, bare)]
    assert travelled[0] <= travelled[1] * (1.0 + TARGET), "drag alone"


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("links", [1, 2, 40, 64])
@pytest.mark.parametrize("joints", ["flush", 0.87])
def test_any_number_of_links_is_swum(links, joints):
    swum(robot(links, joints=joints), straight())


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("speed", [FORWARDS, BACKWARDS, 1e-3, -1e-9, HOVER])
def test_a_body_that_coasts_only_slows_down(speed):
    """Forwards, backwards, where |V| V1 is almost a kink, and at rest."""
    run = swum(robot(drag=1e-3), still(), speed)
    forwards = run.twist[:, 3]
    assert np.all(np.diff(np.abs(forwards)) <= 1e-12 + TARGET * abs(speed))
    assert np.all(forwards * speed >= 0.0), "it does not turn round"
    assert speed != HOVER or not run.position.any()


@pytest.mark.filterwarnings("ignore")
def test_a_swimmer_that_is_turned_round_swims_on():
    """It begins backwards, faster than it swims: the flow along it changes its sign at every station."""
    run = swum(robot(drag=1e-3), straight(), BACKWARDS, duration=6.0)
    forwards = run.twist[:, 3]
    assert forwards.min() < 0.0 < forwards.max()


@pytest.mark.parametrize("drag", [1.001, 1e4, np.inf, np.nan, -1e-9])
def test_areas_that_cannot_be_are_refused(drag):
    with pytest.raises(ValueError, match="appendage drag") as refused:
        robot(drag=drag)
    assert "\n" not in str(refused.value)
