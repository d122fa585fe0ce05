# SPDX-License-Identifier: Apache-2.0
"""The model's own limits: each is found where it lies, said once, and not found where it does not."""

import numpy as np
import pytest
from eel_dynamics.analysis.model_limits import ModelLimits, cross_axes
from eel_dynamics.ros.loop.limits_monitor import LimitsMonitor
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term

from eel_dynamics import Body, Scene, simulate
from eel_gaits import backward, falling, still, straight

ROBOT = Body.boyer2010()


def bent(axis: str, curvature: float) -> Law:
    """A constant bend [rad/m]."""
    return Law(Term(axis=axis, amplitude=(curvature,), phase=np.pi / 2))


def swum(law, duration=1.0, **rest):
    return simulate(law, duration, sample_period=0.05, **rest)


def stubby(length: float, thickness: float) -> Body:
    return Body(
        length=length,
        half_width=lambda x: 0.5 * thickness * np.sqrt(np.clip(x / length * (1.0 - x / length), 0.0, None)) * 2.0,
        half_height=lambda x: thickness * np.sqrt(np.clip(x / length * (1.0 - x / length), 0.0, None)) * 2.0,
    )


@pytest.mark.parametrize("law", [falling(), straight()])
def test_the_robots_gaits_are_within_the_model(law):
    assert simulate(law, 10.0).warnings == ()


def test_a_still_swimmer_has_nothing_to_be_warned_of():
    assert swum(still()).warnings == ()


@pytest.mark.parametrize(("axis", "half"), [("yaw", ROBOT.half_width), ("pitch", ROBOT.half_height)])
def test_a_bend_is_held_against_the_half_axis_that_lies_in_its_plane(axis, half):
    widest = float(np.max(half(np.linspace(0.0, 1.0, 51))))
    for share, found in ((0.98, False), (1.02, True)):
        warnings = ModelLimits(ROBOT, Scene(), np.linspace(0.0, 1.0, 51)).of_bending(
            np.array([2.0]), np.full((1, 51, 1), share / widest) * (np.array([0.0, axis == "pitch", axis == "yaw"]))
        )
        assert bool(warnings) == found
        assert not found or f"{share:.3g} >= 1" in warnings


def test_skin_of_a_section_folds_just_where_the_limit_says():
    """A point of the skin moves along t1 by (1 + K2 z - K3 y) per length: by differences of a bent body's skin."""
    x, bend = np.linspace(0.0, 1.0, 2001), 7.0
    run = swum(bent("yaw", bend), 0.0, stations=x, scene=Scene(internal_wrench=False, ledger=False))
    side, _ = cross_axes(run.section_orientation[0])
    for across in (0.9 / bend, 1.1 / bend):
        skin = run.backbone[0] + across * side
        along = np.sum(np.diff(skin, axis=0) * np.diff(run.backbone[0], axis=0), axis=1)
        assert (along > 0.0).all() == (across * bend < 1.0)
        assert (along < 0.0).all() == (across * bend > 1.0)


def circle(x, turns, rise=0.0):
    """A helix about the world's z of `turns` turns, and the orientation of its sections (axis 3 close to z)."""
    angle = 2.0 * np.pi * turns * x
    radius = 1.0 / (2.0 * np.pi * turns)
    backbone = np.column_stack((radius * np.sin(angle), -radius * np.cos(angle), rise * x))
    orientation = np.column_stack((0 * x, 0 * x, np.sin(0.5 * angle), np.cos(0.5 * angle)))
    curvature = np.column_stack((0 * x, 0 * x, np.full_like(x, 1.0 / radius)))
    return curvature[None], backbone[None], orientation[None]


@pytest.mark.parametrize(("turns", "rise", "touches"), [(0.85, 0.0, False), (1.2, 0.0, True), (1.2, 0.2, False)])
def test_the_body_touches_itself_where_it_closes_a_ring(turns, rise, touches):
    """In a ring of more than a turn nose and tail meet; a helix that rises by more than its height passes over."""
    x = np.linspace(0.0, 1.0, 101)
    text = ModelLimits(ROBOT, Scene(), x).of_contact(np.array([3.0]), *circle(x, turns, rise))
    assert bool(text) == touches
    assert not touches or ("overlap at t = 3 s" in text and "touches itself" in text)


def test_a_coil_is_found_in_a_run():
    found = swum(bent("yaw", 8.0), 0.1).warnings
    assert any("touches itself" in text for text in found)


@pytest.mark.parametrize(("thickness", "found"), [(0.09, False), (0.12, True)])
def test_slenderness(thickness, found):
    body = stubby(1.0, thickness)
    assert any(text.startswith("slenderness") for text in swum(still(), 0.1, body=body).warnings) == found
    assert not swum(still(), 0.1, body=body, scene=Scene(reactive=False)).warnings


@pytest.mark.parametrize(("viscosity", "found"), [(1e-6, False), (2e-3, True)])
def test_reynolds_number(viscosity, found):
    warnings = simulate(straight(), 4.0, scene=Scene(viscosity=viscosity)).warnings
    assert any(text.startswith("Reynolds number") for text in warnings) == found


def test_reynolds_number_counts_the_speed_over_the_water():
    """Adrift in a current, or held against it: only what flows past the body counts."""
    scene = Scene(viscosity=2e-4, current=(2.0, 0.0, 0.0))
    adrift = swum(still(), 1.0, scene=scene, twist=(0.0, 0.0, 0.0, 2.0, 0.0, 0.0))
    held = swum(still(), 1.0, scene=scene)
    assert adrift.warnings == ()
    assert held.warnings == ()  # up to 2 m/s past a body of 1 m: Re > 1000
    slow = swum(still(), 1.0, scene=Scene(viscosity=1e-3), twist=(0.0, 0.0, 0.0, -0.5, 0.0, 0.0))
    assert any("Reynolds number" in text for text in slow.warnings)


def test_the_tail_leads_in_a_body_that_starts_backwards():
    run = swum(still(), 1.0, twist=(0.0, 0.0, 0.0, 0.5, 0.1, 0.0))
    assert any("the tail leads" in text for text in run.warnings)
    assert not swum(still(), 1.0, twist=(0.0, 0.0, 0.0, -0.5, 0.1, 0.0)).warnings
    assert any("the tail leads" in text for text in simulate(backward(), 6.0).warnings)


def test_warnings_stand_in_the_summary():
    run = swum(bent("yaw", 8.0), 0.1)
    assert "beyond the model    the body touches itself" in run.summary()


class Lines:
    """A report that keeps what lasts."""

    def __init__(self):
        self.lasting, self.logged = {}, []

    def begin(self, kind, text):
        self.lasting[kind] = text
        self.logged.append(kind)

    def end(self, kind, text=""):
        self.lasting.pop(kind, None)


def test_the_node_says_each_once_and_keeps_it_until_a_reset():
    from eel_dynamics import Simulation

    swimmer, report = Simulation(twist=(0.0, 0.0, 0.0, 0.5, 0.1, 0.0)), Lines()
    monitor = LimitsMonitor(swimmer, report)
    swimmer.adopt(bent("yaw", 8.0))
    for sample in range(20):
        swimmer.advance(0.01 * sample)
        monitor.add(swimmer.observe(), check=sample % 5 == 4)
    assert sorted(report.logged) == ["contact", "tail"]
    assert set(report.lasting) == {"contact", "tail"}
    monitor.restart()
    assert not report.lasting
