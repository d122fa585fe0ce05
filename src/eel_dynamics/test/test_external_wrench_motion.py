# SPDX-License-Identifier: Apache-2.0
"""External wrenches: towed and free bodies in closed form, the internal wrench, planar scenes, frames."""

import numpy as np
import pytest
from eel_dynamics.model.body.appendages import Appendage
from library_state import distance, rotation
from scipy.integrate import quad, solve_ivp
from test_appendages import carrying
from wrench_cases import NO_WATER, STRAIGHT, about_centre, three

from eel_dynamics import Body, ExternalWrench, Scene, Simulation, simulate
from eel_gaits import falling, straight


def test_a_tow_comes_to_the_speed_at_which_the_known_drag_holds_it():
    """m dU/dt = F - c U^2: U = sqrt(F/c) tanh(sqrt(F c) t/m), with c = 1/2 rho_f A of an element at the head."""
    force, mass, c = 0.8, 1.48, 0.5 * 1000.0 * 4e-3
    body = carrying(Appendage(0.0, drag1=4e-3), mass_per_length=mass)
    still = Scene(friction="none")
    tow = ExternalWrench(0.0, force=(force, 0.0, 0.0))
    run = simulate(STRAIGHT, 12.0, body=body, scene=still, wrenches=[tow], accuracy=1e-7, sample_period=0.1)
    exact = np.sqrt(force / c) * np.tanh(np.sqrt(force * c) * run.time / mass)
    assert exact[-1] == pytest.approx(np.sqrt(force / c), rel=2e-6)
    assert run.twist[:, 3] == pytest.approx(exact, abs=1e-6 * exact[-1])
    assert np.abs(run.twist[:, [0, 1, 2, 4, 5]]).max() < 1e-12  # round-off
    assert run.energy.external_power == pytest.approx(force * run.twist[:, 3], rel=1e-12, abs=1e-15)
    # towed at the tail instead, the same motion; the body is then pushed: its sections bear the drag of the head
    pushed = simulate(
        STRAIGHT, 12.0, body=body, scene=still, wrenches=[ExternalWrench(1.0, (force, 0, 0))], accuracy=1e-7
    )
    assert pushed.twist[-1, 3] == pytest.approx(exact[-1], abs=1e-6 * exact[-1])
    assert run.force[-1, 1:, 0] == pytest.approx(np.zeros(50), abs=1e-5)
    assert pushed.force[-1, :, 0] == pytest.approx(np.full(51, -force), abs=1e-5)


def test_a_torque_on_a_free_body_turns_it_about_its_centre_of_mass():
    """Without water: omega = T t / I, whatever the station; the centre of mass rests."""
    body, torque = Body.boyer2010(), 0.05
    _, _, inertia = about_centre(body, "z")
    for station, frame in ((0.0, "section"), (0.4, "world"), (1.0, "section")):
        given = ExternalWrench(station, torque=(0.0, 0.0, torque), frame=frame)
        run = simulate(STRAIGHT, 3.0, scene=NO_WATER, wrenches=[given], accuracy=1e-9)
        assert run.twist[:, 2] == pytest.approx(torque / inertia * run.time, rel=1e-8, abs=1e-14)
        assert np.abs(run.center_of_mass - run.center_of_mass[0]).max() < 1e-8
        assert run.energy.external_work == pytest.approx(0.5 * (torque * run.time) ** 2 / inertia, rel=1e-7, abs=1e-14)


def test_a_force_off_the_centre_of_a_free_body_is_euler_s():
    """In section axes at X: omega = F d t / I, and the centre of mass goes along the integral of the turned force."""
    body, force, station = Body.boyer2010(), 0.3, 0.9
    centre, mass, inertia = about_centre(body, "z")
    rate = force * (centre - station) / inertia  # rad/s^2, about z, of a force along y
    given = ExternalWrench(station, force=(0.0, force, 0.0))
    run = simulate(STRAIGHT, 2.0, scene=NO_WATER, wrenches=[given], accuracy=1e-9, sample_period=0.1)
    assert run.twist[:, 2] == pytest.approx(rate * run.time, rel=1e-8, abs=1e-14)
    moved = np.array(
        [
            [
                force / mass * quad(lambda s, t=t, f=f: (t - s) * f(0.5 * rate * s**2), 0.0, t)[0]
                for f in (np.sin, np.cos)
            ]
            for t in run.time
        ]
    ) * (-1.0, 1.0)
    assert run.center_of_mass[:, :2] - run.center_of_mass[0, :2] == pytest.approx(moved, abs=1e-8)
    # the internal force of a free rod behind the point of the force: the mass there times its acceleration
    assert distance(run.force[-1, -1], np.zeros(3), force) < 1e-12


def test_a_free_body_tumbles_by_the_laws_of_newton_and_euler():
    """All six components at once, at three stations, one wrench in the axes of the world, for a second."""
    wrenches, spin = three(), np.array([1.0, 2.0, 3.0])
    start = (*spin, 0.0, 0.0, 0.0)
    how = {"accuracy": 1e-8, "sample_period": 0.25, "twist": start, "estimate": False}
    run = simulate(STRAIGHT, 1.0, scene=NO_WATER, wrenches=wrenches, **how)
    centre, mass, _ = about_centre(Body.boyer2010(), "z")
    inertia = np.array([about_centre(Body.boyer2010(), axis)[2] for axis in "xyz"])

    def rates(time, state):
        q, omega, v = state[3:7] / np.linalg.norm(state[3:7]), state[7:10], state[10:]
        turn, force, torque = rotation(q), np.zeros(3), np.zeros(3)
        for wrench in wrenches:
            own = np.reshape([*wrench.force, *wrench.torque], (2, 3))
            pull, twisted = own @ turn if wrench.frame == "world" else own
            force, torque = force + pull, torque + twisted + np.cross([centre - wrench.station, 0.0, 0.0], pull)
        spun = (torque - np.cross(omega, inertia * omega)) / inertia
        turned = np.concatenate([q[3] * omega + np.cross(q[:3], omega), [-q[:3] @ omega]]) / 2
        return np.concatenate([v, turned, spun, turn @ force / mass])

    begin = np.concatenate([[-centre, 0, 0, 0, 0, 0, 1], spin, np.cross(spin, [-centre, 0.0, 0.0])])
    end = solve_ivp(rates, (0.0, 1.0), begin, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    assert run.center_of_mass[-1] == pytest.approx(end[:3], abs=1e-7)
    assert abs(end[3:7] @ run.orientation[-1]) == pytest.approx(np.linalg.norm(end[3:7]), abs=1e-10)
    assert run.twist[-1, :3] == pytest.approx(end[7:10], abs=1e-7 * np.abs(end[7:10]).max())


def test_the_internal_wrench_jumps_by_the_wrench():
    """Stations 2e-8 m to both sides see of the loads per length some 1e-6 N; at the place it is that behind."""
    inner = (*three()[1:2], ExternalWrench(0.64, (0.2, -0.5, 0.1), (0.01, 0.02, -0.03)))
    stations = np.sort([wrench.station + d for wrench in inner for d in (-2e-8, 0.0, 2e-8)])
    start = {"law": falling(), "twist": (0.3, -0.2, 0.5, 0.4, 0.2, 0.1), "stations": stations}
    bare = Simulation(**start)
    swims = Simulation(**start, wrenches=inner)
    for each in (bare, swims):
        each.advance(1.3)
    seen = swims.observe()
    for k, wrench in enumerate(inner):
        ahead, at, behind = 3 * k, 3 * k + 1, 3 * k + 2
        jump = np.array([seen.force[behind] - seen.force[ahead], seen.torque[behind] - seen.torque[ahead]])
        axes = rotation(seen.section_orientation[at])
        given = np.reshape([*wrench.force, *wrench.torque], (2, 3))
        local = given @ axes if wrench.frame == "world" else given
        assert jump == pytest.approx(-local * (-1.0, -1.0, 1.0), abs=1e-6)
        assert seen.force[at] == pytest.approx(seen.force[behind], abs=1e-6)
    assert max(seen.closure_force, seen.closure_torque) < 1e-13 * 10.0  # round-off of some N


def test_a_wrench_at_an_end_is_what_the_end_bears():
    law, twist = STRAIGHT, (0.0, 0.0, 0.0, 0.2, 0.0, 0.0)
    plain, at_nose, at_tail = (
        Simulation(law=law, twist=twist, scene=NO_WATER, wrenches=[each] if each else None).observe()
        for each in (None, ExternalWrench(0.0, (1.0, 0, 0)), ExternalWrench(1.0, (1.0, 0, 0), (0.0, 0.0, 0.1)))
    )
    assert np.abs(plain.force).max() < 1e-13
    assert at_nose.force[0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)  # the rest hangs on it: tension
    assert at_nose.force[-1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    assert at_tail.force[-1] == pytest.approx([-1.0, 0.0, 0.0], abs=1e-12)
    assert at_tail.torque[-1] == pytest.approx([0.0, 0.0, 0.1], abs=1e-12)
    assert at_tail.force[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_a_planar_scene_gives_what_space_gives():
    wrenches = [ExternalWrench(x, (0.3, -0.2, 0.0), (0.0, 0.0, 0.02), "world") for x in (0.0, 0.62)]
    plane, space = (
        simulate(straight(), 1.0, scene=Scene(planar=planar), wrenches=wrenches, accuracy=1e-6, load=True)
        for planar in (True, False)
    )
    assert np.abs(plane.position - space.position).max() < 1e-7
    assert np.abs(plane.torque - space.torque).max() < 1e-6
    assert np.abs(plane.energy.external_power - space.energy.external_power).max() < 1e-7


def test_a_wrench_turns_with_its_frame():
    """A swimmer that starts in another pose swims likewise under wrenches of its section and one turned with it."""
    q = np.array([0.1, -0.4, 0.3, 0.8])
    q /= np.linalg.norm(q)
    options = {"law": falling(), "duration": 0.6, "accuracy": 1e-5}
    own, world = (0.3, 0.2, -0.4), np.array([0.1, -0.3, 0.2])
    here = [ExternalWrench(0.4, own), ExternalWrench(1.0, world, frame="world")]
    there = [here[0], ExternalWrench(1.0, rotation(q) @ world, frame="world")]
    plain, turned = simulate(**options, wrenches=here), simulate(**options, wrenches=there, orientation=q)
    assert turned.position == pytest.approx(plain.position @ rotation(q).T, abs=1e-10)
    assert turned.torque == pytest.approx(plain.torque, abs=1e-9)
