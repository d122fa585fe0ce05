# SPDX-License-Identifier: Apache-2.0
"""The model's own limits: each is found where it lies, said once, and not found where it does not."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.analysis.model_limits import ModelLimits, cross_axes, ledger_tolerance
from eel_dynamics.ros.loop.limits_monitor import LimitsMonitor
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term
from random_scenes import pointed

from eel_dynamics import Body, FlowField, Scene, Shear, Simulation, Uniform, Vortex, simulate
from eel_gaits import backward, falling, gait, still, straight

ROBOT = Body.boyer2010()
OBSERVED = "curvature", "backbone", "section_orientation", "center_of_mass"  # what the monitor checks besides the tail


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
        skin = run.backbone[0] - across * side  # axis 2 of the section is to the right
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
    scene = Scene(viscosity=2e-4, current=(-2.0, 0.0, 0.0))
    adrift = swum(still(), 1.0, scene=scene, twist=(0.0, 0.0, 0.0, -2.0, 0.0, 0.0))
    held = swum(still(), 1.0, scene=scene)
    assert adrift.warnings == ()
    assert held.warnings == ()  # up to 2 m/s past a body of 1 m: Re > 1000
    slow = swum(still(), 1.0, scene=Scene(viscosity=1e-3), twist=(0.0, 0.0, 0.0, 0.5, 0.0, 0.0))
    assert any("Reynolds number" in text for text in slow.warnings)


def test_the_tail_is_not_judged_by_the_power_of_the_wake_in_water_that_moves():
    run = simulate(straight(), 6.0, flow=Uniform((1.0, 0.0, 0.0)))
    assert np.mean(run.energy.wake_power[len(run.time) // 2 :] > 0.0) > 0.5
    assert not any("the tail leads" in text for text in run.warnings)


def test_the_tail_leads_in_a_body_that_starts_backwards():
    run = swum(still(), 1.0, twist=(0.0, 0.0, 0.0, -0.5, 0.1, 0.0))
    assert any("the tail leads" in text for text in run.warnings)
    assert not swum(still(), 1.0, twist=(0.0, 0.0, 0.0, 0.5, 0.1, 0.0)).warnings
    assert any("the tail leads" in text for text in simulate(backward(), 6.0).warnings)


@pytest.mark.parametrize(
    ("flow", "found"),
    [
        (Vortex(core=0.2, centre=(-0.5, 0.0, 0.0)), True),
        (Vortex(core=2.0), False),
        (Shear(width=0.2), False),
        (Shear(width=0.05), True),
    ],
)
def test_a_flow_is_held_against_the_size_of_the_sections(flow, found):
    run = swum(still(), 0.5, flow=flow)
    assert any("flow is too fine for the body" in text for text in run.warnings) == found
    assert run.in_axes("paper").warnings == run.warnings


def test_the_change_of_a_gradient_is_that_of_the_formula():
    """u = (0, q y^2 / 2, 0): across a section of half-width b at y = d it changes by 2 b q, of q (d + b)."""
    body, far = pointed(0.04, 0.01), 0.1
    flow = FlowField(lambda x, t: 0.05 * (x[:, 1:2] ** 2) * [0.0, 1.0, 0.0])
    limits = ModelLimits(body, Scene(), np.array([0.25, 0.5, 0.75]))
    backbone = np.array([[[-0.25, far, 0.0], [-0.5, far, 0.0], [-0.75, far, 0.0]]])
    text = limits.of_flow(flow, np.array([1.5]), backbone, np.tile([0.0, 0.0, 0.0, 1.0], (1, 3, 1)))
    assert f"changes by {0.08 / 0.14:.2g} of its greatest across the section at X = 0.5 m, t = 1.5 s" in text


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
    swimmer, report = Simulation(twist=(0.0, 0.0, 0.0, -0.5, 0.1, 0.0)), Lines()
    monitor = LimitsMonitor(swimmer, report)
    swimmer.adopt(bent("yaw", 8.0))
    for sample in range(20):
        swimmer.advance(0.01 * sample)
        monitor.add(swimmer.observe(), check=sample % 5 == 4)
    assert report.logged == ["contact"]
    assert set(report.lasting) == {"contact"}
    monitor.end()
    monitor = LimitsMonitor(swimmer, report)
    assert not report.lasting


def watched(swimmer, report, powers, per_second=10, check_every=7):
    """Adds samples with the wake's `powers` [W] to a monitor of `swimmer`, from t = 0 on."""
    monitor, snapshot = LimitsMonitor(swimmer, report), swimmer.observe()
    for sample, power in enumerate(powers):
        told = SimpleNamespace(**{name: getattr(snapshot, name) for name in OBSERVED}, time=sample / per_second)
        told.energy = SimpleNamespace(wake_power=power)
        monitor.add(told, check=sample % check_every == 0)
    return monitor


@pytest.mark.parametrize("check_every", [1, 7, 1000])
def test_the_node_watches_the_tail_over_simulated_time(check_every):
    """However often wall time lets it check: after 5 s of settling, in windows of 5 s, while they last."""
    report = Lines()
    start = [1.0] * 40 + [-1.0] * 10
    swim = [0.0, 1.0, -1.0, -1.0, -1.0] * 10  # leads for 20 %
    leads = [1.0, 1.0, -1.0, -1.0, -1.0] * 10  # leads for 40 %
    watched(Simulation(law=straight()), report, start + swim * 2 + [0.0], check_every=check_every)
    assert "tail" not in report.logged
    watched(Simulation(law=straight()), report, start + leads + [0.0], check_every=check_every)
    assert "for 39% of the time from t = 5 s to 10 s" in report.lasting["tail"]
    watched(Simulation(law=straight()), report, start + leads + swim + [0.0], check_every=check_every)
    assert report.logged.count("tail") == 2 and "tail" not in report.lasting


def test_the_node_watches_the_tail_over_whole_periods_and_leaves_out_the_start_of_each_law():
    slow = Law(Term(axis="yaw", amplitude=(1.0,), period=20.0))
    report, powers = Lines(), [-1.0] * 160 + [1.0] * 40  # each period of 20 s leads for 20 % of it
    watched(Simulation(law=slow), report, powers * 3)
    assert report.logged == []
    swimmer = Simulation(law=straight())
    monitor = watched(swimmer, report, [-1.0] * 80)
    swimmer.adopt(falling())
    for sample in range(80, 129):
        monitor.add(SimpleNamespace(time=0.1 * sample, energy=SimpleNamespace(wake_power=1.0)), check=False)
    assert report.logged == []


def test_the_node_has_no_warning_of_a_swim_from_rest_and_has_one_of_a_swim_backwards():
    for law, found in ((straight(), []), (backward(), ["tail"])):
        swimmer, report = Simulation(law=law, accuracy="draft"), Lines()
        monitor = LimitsMonitor(swimmer, report)
        for sample in range(241):
            swimmer.advance(0.05 * sample)
            monitor.add(swimmer.observe(), check=sample % 30 in {0, 1})
        assert report.logged == found


def test_the_ledger_of_a_swim_that_has_hardly_begun_is_checked():
    """Its energy is small beside that of the gait, for which the steps are chosen: the works are exact to 1 to 8 %."""
    for accuracy, least in ((1e-2, 1e-2), ("standard", 1e-3)):
        (told,) = simulate(gait("joint_wave"), 0.1, accuracy=accuracy).warnings
        share = float(re.search(r"ledger is open by ([\d.e-]+) of what passed, more than", told)[1])
        assert least < share < 0.1
        assert not any("ledger" in text for text in simulate(gait("joint_wave"), 1.0, accuracy=accuracy).warnings)


def test_the_tolerance_of_the_ledger_follows_the_target():
    assert [ledger_tolerance(target) for target in (1e-1, 1e-3, 5e-4, 1e-4, 1e-8)] == pytest.approx(
        [1e-2, 1e-2, 5e-3, 1e-3, 1e-4]
    )
    run = simulate(straight(), 1.0, accuracy=1e-4)
    energy = run.energy
    passed = energy.kinetic_body[-1] + energy.kinetic_fluid[-1] + energy.actuator_work[-1]
    for share, warned in ((0.8e-3, False), (4e-3, True)):
        told = replace(run, energy=replace(energy, residual=energy.residual + share * passed)).warnings
        assert any("ledger is open" in text for text in told) == warned


def test_round_off_does_not_open_the_ledger():
    for scene in (Scene(), Scene(current=(0.3, -0.2, 0.1))):
        twist = (0.0, 0.0, 0.0, *scene.current)
        assert simulate(still(), 1.0, scene=scene, twist=twist).warnings == ()
