# SPDX-License-Identifier: Apache-2.0
"""Driven anywhere, a run finishes or says why it stopped: nothing that is not finite comes back, nothing hangs."""

from types import SimpleNamespace

import numpy as np
import pytest
from draws import few, numbers
from eel_dynamics.accuracy.error_estimate import floors_of
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.simulation.stopping import first_bad_sample
from hypothesis import given
from hypothesis import strategies as st
from random_scenes import fixed, pointed

from eel_dynamics import Accuracy, Body, Scene, Simulation, SimulationStopped, simulate, simulate_batch
from eel_gaits import Law, Ramp, Term, falling, helix, still, straight


@pytest.mark.parametrize("ledger", [False, True])
def test_steps_are_counted_over_the_run_however_often_it_is_sampled(ledger, monkeypatch):
    """A run of 40 steps to spare and 20 per simulated second, which needs more, is stopped at the same place by 3 as by
    3,000 samples."""
    monkeypatch.setattr("eel_dynamics.accuracy.step_bounds.SPARE_STEPS", 40.0)
    monkeypatch.setattr("eel_dynamics.accuracy.step_bounds.LEAST_SPARE", 40.0)
    stopped = []
    for period in (1.0, 0.1, 0.001):
        with pytest.raises(
            SimulationStopped, match=r"more steps per simulated second.*raise most_evaluations"
        ) as caught:
            scene = Scene(ledger=ledger, internal_wrench=ledger)
            swim = {"sample_period": period, "stations": 2, "most_evaluations": 120.0}
            simulate(falling(), 3.0, scene=scene, accuracy=1e-6, **swim)
        stopped.append((caught.value.time, caught.value.run.steps))
    assert stopped[2][0] < 3.0 and len({steps for _, steps in stopped}) == 1
    assert stopped[2][0] - stopped[1][0] < 0.1 and stopped[2][0] - stopped[0][0] < 1.0


@few(40)
@given(
    st.sampled_from((falling, straight, helix)),
    numbers(0.02, 50.0),
    numbers(0.01, 8.0),
    numbers(0.0, 1.0),
    st.tuples(*[numbers(-300.0, 300.0)] * 3, *[numbers(-100.0, 100.0)] * 3),
)
def test_only_the_documented_exception(gait, period, step, viscosity, twist):
    """Fixed steps of any length, initial velocities of any size."""
    try:
        run = simulate(
            gait(period=period), 1.0, accuracy=fixed(step), scene=Scene(viscosity=viscosity), twist=twist, stations=5
        )
    except SimulationStopped as stopped:
        run = stopped.run
        assert stopped.hint and len(run.time) < 21
        assert not len(run.time) or run.time[-1] == stopped.time
    for array in (run.position, run.orientation, run.twist, run.torque, run.force, run.energy.residual):
        assert np.isfinite(array).all()


@pytest.mark.parametrize("step", [0.75, 1.0])
def test_a_fixed_step_that_is_too_long_is_told(step):
    """The head would end metres to 1e25 m from where it swims to, with numbers that all look like numbers."""
    with pytest.raises(SimulationStopped, match=r"energy from nowhere.*a step of [\d.]+ s is stable"):
        simulate(straight(), 3.0, accuracy=fixed(step))


@pytest.mark.parametrize("speed, told", [(1.0, "energy from nowhere"), (20.0, "momentum is not finite")])
def test_fixed_steps_of_a_target_that_do_not_do_are_told(speed, told):
    """The number of them was measured with gaits from rest: it does not hold for a large initial velocity and spin."""
    with pytest.raises(SimulationStopped, match=f"{told}.*take the accuracy without fixed steps"):
        simulate(straight(), 1.0, accuracy="draft, fixed steps", twist=(0.0, 0.0, speed, 0.0, -speed, 0.0))


def test_a_fixed_step_that_is_stable_and_inexact_is_warned_of():
    good, poor = (simulate(straight(), 3.0, accuracy=fixed(step)) for step in (0.1, 0.5))
    assert good.position[-1, 0] == pytest.approx(0.779, abs=1e-3) and good.warnings == ()
    assert abs(poor.position[-1, 0] - good.position[-1, 0]) > 0.01
    assert any("energy ledger" in text for text in poor.warnings)


def test_what_is_not_finite_is_found_with_its_sample():
    arrays = {"energies": np.ones((5, 2)), "position": np.zeros((5, 3))}
    arrays["position"][3, 1] = np.nan
    whole = np.concatenate([array.ravel() for array in arrays.values()])
    out, works = SimpleNamespace(arrays=lambda: arrays, whole=whole, **arrays), np.zeros((5, 4))
    sample, quantity, value = first_bad_sample(out, works, 5, 2.0, np.inf)
    assert (sample, quantity) == (3, "position is not finite") and np.isnan(value)
    assert first_bad_sample(out, works, 3, 2.0, 0.0) is None
    sample, quantity, value = first_bad_sample(out, works, 5, 0.5, 0.0)
    assert (sample, value) == (0, pytest.approx(1.5 / 2.0)) and "energy from nowhere" in quantity


@pytest.mark.parametrize("planar", [False, True])
def test_from_rest_and_with_ramps_of_a_microsecond_no_step_collapses(planar):
    sudden = Ramp(0.0, 1e-6, 1.0), Ramp(0.5e-6, 1.5e-6, -0.5), Ramp(0.01, 0.02, 0.5)  # the first two overlap
    law = Law(Term(axis="yaw", amplitude=(1.0, 0.5, 2.0), wavelength=1.0, period=1.0, envelope=sudden))
    run = simulate(law, 0.05, scene=Scene(planar=planar), sample_period=0.005, accuracy=1e-3)
    assert run.steps < 2000 and np.isfinite(run.twist).all()
    assert np.abs(run.energy.residual).max() < 1e-3 * np.abs(run.energy.actuator_work).max()
    rest = simulate(still(), 10.0, scene=Scene(planar=planar), accuracy=1e-3)
    assert not rest.position.any() and rest.steps < 200


@pytest.mark.parametrize("density", [1.0, 1e6])
def test_bodies_a_thousandth_and_a_thousand_times_as_dense_as_water(density):
    """The added mass is implicit: the step of a body of 2 g is that of water's inertia."""
    run = simulate(straight(), 3.0, scene=Scene(density=density), accuracy=1e-4)
    fine = simulate(straight(), 3.0, scene=Scene(density=density), accuracy=1e-6)
    assert run.evaluations < 2000
    assert np.abs(run.position - fine.position).max() < 1e-4 * max(1.0, run.path_length)


@pytest.mark.parametrize("settings", ["draft", fixed(0.05)])
def test_what_is_beyond_numbers_is_told(settings):
    with pytest.raises(ValueError, match=r"body density must be 1e-30 to 1e\+30 in size, got 1e\+200"):
        Body.boyer2010().changed(density=1e200)
    for body in (Body.boyer2010().changed(density=1e30), Body.spindle(1e30, 10.0), Body.spindle(1e-30, 10.0)):
        assert np.isfinite(simulate(still(), 0.1, body=body, accuracy=settings).twist).all()
    with pytest.raises(ValueError, match="body is too large or too dense for numbers"):
        simulate(still(), 0.1, body=pointed(1e100, 1e100), accuracy=settings)
    assert floors_of(straight(), mass=1.0, length=1e160, duration=1.0).torque == np.inf


def test_a_tail_of_zero_section_sheds_no_wake():
    run = simulate(straight(), 2.0, body=pointed(0.03, 0.05))
    assert np.isfinite(run.position).all() and not run.energy.wake_power.any()
    assert np.abs(run.energy.residual[-1]) < 1e-4 * run.energy.actuator_work[-1]


@pytest.mark.parametrize(("half_width", "half_height"), [(0.0, 0.05), (0.05, 0.0), (0.0, 0.0)])
def test_a_body_without_inertia_is_refused(half_width, half_height):
    """A needle or a sheet: its matrix of inertia is singular."""
    with pytest.raises(ValueError, match=r"half_(width|height).*singular, without inertia along axes 1 and [23]"):
        pointed(half_width, half_height)


@pytest.mark.parametrize(
    ("half_width", "half_height", "scene", "none"),
    [
        (1e-8, 1e-8, {}, "roll"),
        (1e-15, 0.05, {"nose": False}, "pitch, surge, heave"),
        (0.05, 1e-15, {"nose": False}, "yaw, surge, sway"),
        (0.05, 0.05, {"nose": False, "density": 1e-12}, "roll, surge"),
    ],
)
def test_a_singular_body_is_refused_with_the_direction_that_has_no_inertia(half_width, half_height, scene, none):
    body = pointed(half_width, half_height)
    with pytest.raises(ValueError, match=rf"no inertia in {none}: its matrix of inertia is singular"):
        simulate(straight(), 1.0, body=body, scene=Scene(**scene))
    batch = simulate_batch([straight()], 1.0, bodies=body, scenes=Scene(**scene))
    assert "singular" in str(batch.error[0])


def test_a_needle_without_inertia_in_roll_swims_in_the_plane():
    run = simulate(straight(), 1.0, body=pointed(1e-8, 1e-8), scene=Scene(planar=True, resistive=False), accuracy=1e-3)
    assert np.isfinite(run.position).all() and run.path_length > 0.01


@pytest.mark.parametrize("thickness", [1e-3, 1e-5])
def test_a_thin_needle_swims_or_says_why_not(thickness):
    try:
        run = simulate(falling(), 2.0, body=pointed(thickness, thickness), accuracy=1e-3)
    except SimulationStopped as stopped:
        assert stopped.hint
        run = stopped.run
    assert np.isfinite(run.position).all()


def test_a_light_body_in_strong_drag_does_not_collapse_the_steps():
    """Drag coefficients of some thousand on a body of 2 g: the stiff corner."""
    robot = Body.boyer2010()
    body = Body(
        length=1.0,
        half_width=robot.half_width,
        half_height=robot.half_height,
        kinks=robot.kinks,
        nose=robot.nose,
        density=1.0,
        lateral_drag=1e3,
        vertical_drag=1e3,
        roll_drag=1e3,
    )
    run = simulate(falling(), 3.0, body=body, accuracy=1e-3)
    assert run.evaluations < 100_000
    assert np.abs(run.energy.residual).max() < 1e-2 * np.abs(run.energy.actuator_work).max()


def test_a_large_initial_velocity_keeps_the_target_without_a_ledger_too():
    """The errors of Adams' steps add up in a spin: the pair of Dormand and Prince takes over."""
    spins = [(2.0, 15.0), (-100.0, 60.0), (-10.0, 600.0), (-100.0, 0.1)]  # m/s, rad/s
    twists = np.array([[*np.full(3, spin / np.sqrt(3.0)), speed, 0.0, 0.0] for speed, spin in spins])
    scene = Scene(ledger=False, internal_wrench=False)
    swims = {"duration": 0.2, "sample_period": 0.0125, "scenes": scene, "twists": twists}
    batch = simulate_batch(straight(), **swims, accuracy=1e-4)
    fine = simulate_batch(straight(), **swims, accuracy=Accuracy(name="fine", resolution=60.0, tolerance=1e-10))
    apart = np.linalg.norm(batch.position - fine.position, axis=2).max(axis=1)
    path = np.linalg.norm(np.diff(fine.position, axis=1), axis=2).sum(axis=1)
    assert (apart < 1e-4 * np.maximum(path, 1.0)).all()


@pytest.mark.parametrize(
    ("length", "viscosity", "twist"),
    [(0.01, 0.012, (0.0, 0.0, 0.0, 0.01, -0.014, 0.0)), (0.1, 1.0, (0, 0, 16.0, 0.1, 0, 0))],
)
def test_light_bodies_that_the_water_stops_in_the_plane_keep_the_target(length, viscosity, twist):
    """At tolerances of 2e-3, which leave a gait its longest steps, their ledgers are open by the whole energy."""
    scene, body = Scene(planar=True, density=6.0, viscosity=viscosity), pointed(0.04 * length, 0.06 * length, length)
    swims = {"duration": 1.0, "body": body, "scene": scene, "twist": twist, "stations": 2, "sample_period": 0.0625}
    run, fine = (simulate(still(), accuracy=accuracy, **swims) for accuracy in (1e-2, 1e-6))
    apart = np.linalg.norm(run.position - fine.position, axis=1).max()
    assert apart < 2e-3 * max(length, fine.path_length)
    assert np.abs(run.energy.residual).max() < 0.02 * fine.energy.kinetic_fluid[0]


def test_a_body_that_is_rolled_up_keeps_the_target():
    """Three turns of the backbone are as three waves: the model has left its limits, the numbers have not."""
    law = straight(wavelength=50.0, amplitude_0=10.0, amplitude_1=5.0, amplitude_2=20.0)
    run = simulate(law, 2.0, accuracy=1e-3)
    assert run.error_estimate.position < 1e-3
    assert any("touches itself" in text for text in run.warnings)


LOOSE = Accuracy(name="loose", resolution=26.0, tolerance=0.1, method="adams", order=2)


@pytest.mark.parametrize("accuracy", [fixed(0.4), LOOSE])
def test_settings_by_hand_that_are_too_coarse_are_told_by_warning_and_estimate(accuracy):
    run = simulate(straight(), 4.0, accuracy=accuracy, sample_period=0.25)
    assert any("energy ledger" in text for text in run.warnings)
    assert run.error_estimate.position > 1e-3


@pytest.mark.parametrize(("knots", "seed"), [(20, 1), (30, 0), (50, 3), (100, 2)])
def test_splines_of_many_knots_keep_the_target(knots, seed):
    """Rough ones, whose waves are in the amplitude alone."""
    amplitude = tuple(5.0 * np.random.default_rng(seed).standard_normal(knots))
    term = Term(amplitude=amplitude, knots=tuple(np.linspace(0.0, 1.0, knots)), period=1.0, envelope=(Ramp(0, 1, 1),))
    run = simulate(Law(term), 5.0, accuracy=1e-4)
    found = relative_errors(
        run, simulate(Law(term), 5.0, accuracy=Accuracy(name="fine", resolution=900.0, tolerance=1e-11))
    )
    assert found.worst < 1e-4


@pytest.mark.fault(
    "laws", "waves too short for any grid, or a ramp that is a jump", "refused by the law's name, with the limit"
)
@pytest.mark.parametrize(
    ("law", "said"),
    [
        (straight(wavelength=5e-4), "law 'straight' bends the body into 2e.03 waves or turns: at most 200"),
        (Law(Term(amplitude=(1e29,), period=1.0), name="x"), r"law 'x' bends the body into .*e\+28 waves or turns"),
        (
            Law(Term(amplitude=(2.0,), envelope=(Ramp(0.5, 0.5 + 1e-12, 1.0),)), name="x"),
            "law 'x' has a ramp at 0.5 s of 1e-12 s: at least 1e-09 s",
        ),
        (
            Law(Term(amplitude=(2.0,), envelope=(Ramp(1e3, 1e3 + 1e-9, 1.0),)), name="x"),
            "law 'x' has a ramp at 1000 s of 1e-09 s: at least 1e-06 s",
        ),
    ],
)
def test_a_law_that_cannot_be_resolved_is_refused(law, said):
    """Its motion would be of what the grid or the steps see of it, and both checks of a run would be content."""
    with pytest.raises(ValueError, match=said):
        simulate(law, 2.0)
    swimmer = Simulation(law=falling(), accuracy=1e-2)
    swimmer.advance(0.5)
    with pytest.raises(ValueError, match=said):
        swimmer.adopt(law)
    swimmer.advance(1.0)  # with the law that it had
    assert swimmer.law.name == "falling"


def test_waves_that_a_grid_just_carries():
    """The greatest torque goes with the cube of a short wave's length, down to the limit."""
    torques = [simulate(straight(wavelength=1.0 / waves), 2.0).greatest_torque()[0] for waves in (100.0, 200.0)]
    assert torques[0] / torques[1] == pytest.approx(8.0, rel=0.1)
