# SPDX-License-Identifier: Apache-2.0
"""Gradients of runs: central differences on one grid with one sequence of steps, and their own stated error."""

import warnings

import numpy as np
import pytest
import scipy.optimize
from eel_dynamics.batches.simulate_batch import swum
from eel_dynamics.runs.swim import Swim
from eel_studies.gradients.fixed_discretisation import common_step, on_one_grid, step_of
from eel_studies.gradients.gradient import share_across_jump
from eel_studies.points import point_at

from eel_dynamics import Accuracy, Body, Scene, SimulationStopped, simulate
from eel_gaits import Law, Term, falling, sampled, straight
from eel_studies import gradient

SMOOTH = Scene(friction="laminar")
SHORT = {"duration": 2.5, "accuracy": 1e-3, "stations": 11}
OF = ("head_x", "mean_speed", "actuator_work", "cost_of_transport", "greatest_torque")
AT = {
    "period": 0.8,
    "amplitude_0": 1.0,
    "wavelength": 1.0,
    "scene.density": 990.0,
    "body.lateral_drag": 1.98,
    "initial.v_x": 0.1,
}


def scaled(scale: float, **numbers):
    """The straight gait, all of its amplitude by `scale`."""
    return straight(amplitude_0=scale, amplitude_1=0.5 * scale, amplitude_2=2.0 * scale, **numbers)


def test_derivatives_are_those_of_finer_swims_within_their_stated_error():
    found = gradient(OF, AT, scene=SMOOTH, **SHORT)
    finer = gradient(OF, AT, scene=SMOOTH, **SHORT | {"accuracy": 1e-7}, estimate=False)
    assert found.derivative.shape == found.error.shape == (5, 6) and np.isnan(finer.error).all()
    missed = np.abs(found.derivative - finer.derivative) / found.error
    assert np.all(missed < 2.0) and np.mean(missed > 1.0) <= 0.1
    assert np.all(found.error <= 0.05 * np.abs(found.derivative))
    assert found.warnings == () and found.value[1] == found.run.mean_speed
    assert found["mean_speed"]["period"] == found.derivative[1, 0] < 0.0
    plain = [
        simulate(straight(period=period), 2.5, scene=SMOOTH, stations=11, accuracy=1e-8) for period in (0.79, 0.81)
    ]
    at_rest = gradient("head_x", {"period": 0.8}, scene=SMOOTH, **SHORT)
    change = (plain[1].position[-1, 0] - plain[0].position[-1, 0]) / 0.02
    assert at_rest.derivative[0, 0] == pytest.approx(change, rel=1e-3)


def test_derivatives_that_are_known_exactly():
    place = {"initial.position_x": 0.3, "initial.position_z": 0.0}
    found = gradient(("head_x", "head_z", "mean_speed"), place, scene=SMOOTH, estimate=False, **SHORT)
    assert found.derivative == pytest.approx(np.array([[1, 0], [0, 1], [0, 0]]), abs=1e-7)
    # without drag, the motion depends on the ratio of the densities alone, and the work grows with them
    perfect, at = Scene(resistive=False), {"scene.density": 1000.0, "scene.fluid_density": 1000.0}
    found = gradient(("head_x", "actuator_work"), at, scene=perfect, estimate=False, **SHORT)
    assert found.derivative[0] @ found.at == pytest.approx(0.0, abs=1e-6)
    assert found.derivative[1] @ found.at == pytest.approx(found.value[1], rel=1e-5)


def test_neighbouring_swims_share_grid_and_steps():
    base = Swim(None, Body.boyer2010(), SMOOTH, Accuracy.of("1e-3, fixed steps").in_scene(SMOOTH))
    values = [{"period": 1.0, "wavelength": 0.5}] + [
        {"period": 1.0 + a, "wavelength": 0.5 + b} for a, b in ((1e-4, 0), (-1e-4, 0), (0, 1e-4), (0, -1e-4))
    ]
    points = [point_at(each, "straight", {}, base) for each in values]
    points = on_one_grid(points, step_of(points[0]))
    runs = [simulate(each.law, 2.0, scene=SMOOTH, accuracy=each.accuracy, estimate=False) for each in points]
    assert len({(run.nodes, run.steps) for run in runs}) == 1
    assert common_step([[0.0, 1.0], [0.0, 1.001], [0.0, 0.999]], 0.1) < 0.1  # ten steps would become eleven
    assert common_step([[0.0, 1.0], [0.0, 0.5, 1.0]], 0.1) == 0.1


KNOTS = tuple(np.linspace(0.0, 1.0, 15).tolist())


def of_knots(**amplitudes: float) -> Law:
    """A wave whose amplitude is a spline through these values at fifteen places."""
    values = tuple(amplitudes[f"knot_{k}"] for k in range(len(KNOTS)))
    return Law(Term(amplitude=values, knots=KNOTS, wavelength=1.0, period=0.8), name="of knots")


FLAT = {f"knot_{k}": 0.5 for k in range(len(KNOTS))}


@pytest.mark.parametrize("apart", [1e-6, 1e-5, 1e-3, 2e-2])
def test_a_flat_spline_has_a_gradient_whatever_the_differences(apart):
    """The usual first guess. Beside it a spline has a dozen turns, which are smaller than the grid need resolve."""
    swim = {"gait": of_knots, "scene": SMOOTH} | SHORT
    found = gradient("head_x", FLAT, steps=dict.fromkeys(FLAT, apart), **swim)
    all_together = gradient("head_x", {"scale": 1.0}, **swim | {"gait": lambda scale: of_knots(**FLAT) * scale})
    assert found.derivative.sum() * 0.5 == pytest.approx(all_together.derivative[0, 0], rel=1e-3)
    assert (found.error <= 0.02 * np.abs(found.derivative).max()).all() and found.run.nodes <= 80


def test_the_grid_is_that_of_the_middle_however_many_waves_are_beside_it():
    base = Swim(None, Body.boyer2010(), SMOOTH, Accuracy.of("1e-3, fixed steps").in_scene(SMOOTH))
    beside = [FLAT | {"knot_7": 0.5 + apart} for apart in (0.0, 0.05, -0.05)]
    points = [point_at(each, lambda **own: of_knots(**own), {}, base) for each in beside]
    nodes = {len(each.simulation().grid.x) for each in on_one_grid(points, step_of(points[0]))}
    assert nodes == {len(points[0].simulation().grid.x)} != {len(points[1].simulation().grid.x)}


def test_swims_beside_the_values_have_one_grid_and_what_the_measures_need(monkeypatch):
    noted = []

    def noting(points, *others):
        batch = swum(points, *others)
        noted.append((points, [batch[index] for index in range(len(points))]))
        return batch

    monkeypatch.setattr("eel_studies.gradients.gradient.swum", noting)
    values = {"period": 0.8, "wavelength": 0.3}

    def beside(of, friction="laminar"):
        noted.clear()
        found = gradient(of, values, scene=Scene(friction=friction), estimate=False, **SHORT)
        (_, (middle,)), (points, runs) = noted
        assert found.run == middle and middle.energy is not None and middle.torque is not None
        assert len({(run.nodes, run.steps) for run in runs}) == 1
        scene = points[0].scene
        return scene.ledger, scene.internal_wrench, len(runs[0].time) == len(middle.time)

    assert beside("head_x") == (False, False, False)
    assert beside("head_x", friction="printed") == (False, False, True)  # a jump between two swims is looked for
    assert beside("mean_speed") == (False, False, True)
    assert beside(("head_x", "actuator_work")) == (True, False, True)
    assert beside("greatest_torque") == (False, True, True)
    assert beside(lambda run: {"x": run.position[-1, 0]}) == (True, True, True)


def test_an_optimiser_with_the_gradient_finds_what_a_scan_finds():
    scene = Scene(friction="laminar", planar=True, internal_wrench=False, ledger=False)
    swim = {"scene": scene, "duration": 5.0, "accuracy": 1e-3, "stations": 2}
    calls = []

    def slowness(x):
        found = gradient("mean_speed", {"scale": x[0]}, gait=scaled, numbers={"period": 0.8}, estimate=False, **swim)
        calls.append(x[0])
        return -found.value[0], -found.derivative[0]

    best = scipy.optimize.minimize(
        slowness, [0.8], jac=True, bounds=[(0.3, 3.0)], method="L-BFGS-B", options={"ftol": 1e-12}
    )
    scales = np.linspace(1.2, 2.0, 9)
    speeds = [simulate(scaled(scale, period=0.8), estimate=False, **swim).mean_speed for scale in scales]
    top = int(np.argmax(speeds))
    assert 0 < top < 8 and len(calls) < 20
    parabola = np.polyfit(scales[top - 1 : top + 2], speeds[top - 1 : top + 2], 2)
    assert best.success and best.x[0] == pytest.approx(-0.5 * parabola[1] / parabola[0], abs=0.02)
    assert -best.fun == pytest.approx(np.polyval(parabola, best.x[0]), rel=1e-3) and abs(best.jac[0]) < 1e-4


@pytest.mark.fault(
    "names",
    "a gradient between two swims that lie on different sides of the printed friction's jump",
    "a warning that names the parameters; `Gradient.warnings` keeps it",
)
def test_a_jump_of_the_printed_friction_is_told():
    with pytest.warns(UserWarning, match="the printed friction jumps at Re = 80000 between the two swims for period"):
        found = gradient("mean_speed", {"period": 1.0}, steps={"period": 0.02}, duration=3.0, accuracy=1e-2)
    assert len(found.warnings) == 1
    runs = [simulate(straight(period=period), 3.0, accuracy=1e-2, sample_period=0.05) for period in (0.98, 1.02)]
    assert 0.0 < share_across_jump(*runs) < 0.2 and share_across_jump(runs[0], runs[0]) == 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gradient("mean_speed", {"period": 1.0}, scene=Scene(friction="blended"), duration=3.0, accuracy=1e-2)


def test_functions_of_the_user_and_two_swims_per_parameter():
    told = []

    def depth(run):
        return {"depth": -run.position[-1, 2], "path": run.path_length}

    at, swim = {"pitch_bend": 0.5, "initial.omega_y": 0.0}, {"gait": "falling", "duration": 1.5, "accuracy": 1e-2}
    found = gradient(depth, at, scene=SMOOTH, estimate=False, progress=lambda *pair: told.append(pair), **swim)
    assert found.of == ("depth", "path") and found["depth"]["pitch_bend"] > 0.0
    assert told == [(k, 5) for k in range(1, 6)]
    assert repr(found) == "Gradient(of depth, path; by pitch_bend, initial.omega_y)"
    assert found == gradient(depth, at, scene=SMOOTH, estimate=False, threads=1, **swim)
    assert found.steps.tolist() == [5e-6, 1e-5]


@pytest.mark.parametrize(
    "given, words",
    [
        ({"of": "speed"}, "of must be one of head_x,.* got 'speed'"),
        ({"of": "error_position"}, "of error_position needs the error estimate, which is off"),
        ({"parameters": {}}, "parameters must be a dict of names and values, got {}"),
        ({"parameters": {"period": "long"}}, "parameter period must be a number, got 'long'"),
        ({"parameters": {"colour": 1.0}}, "gradient at colour=1.0: gait 'straight' has no number 'colour'"),
        ({"parameters": {"scene.planar": 1.0}}, "scene planar must be true or false"),
        ({"parameters": {"body.lateral_drag": 0.0}}, "gradient at body.lateral_drag=-1e-05: body lateral_drag must be"),
        ({"steps": {"wavelength": 1.0}}, "steps must be one of period, got 'wavelength'"),
        ({"steps": {"period": 0.0}}, "steps period must be > 0, got 0.0"),
        (
            {"accuracy": Accuracy(name="mine", resolution=20.0)},
            "accuracy of a gradient must be a target, or .* got 'mine'",
        ),
        (
            {"gait": lambda period: sampled(straight(period=period).curvature, 2.5)},
            "gradient gait must return a Law, whose terms are known, got SampledLaw",
        ),
        ({"duration": 0.9}, "measure mean_speed is undefined"),
        ({"stations": 0}, "^stations must be 2 or more, or their X in m, got 0"),
        ({"most_evaluations": -1}, "^most_evaluations must be > 0 per simulated second, got -1"),
    ],
)
def test_bad_input_is_refused_in_one_line(given, words):
    with pytest.raises(ValueError, match=words) as error:
        gradient(**{"of": "mean_speed", "parameters": {"period": 1.0}, "scene": SMOOTH, **SHORT, **given})
    assert "\n" not in str(error.value)


def test_stations_are_as_of_a_batch():
    given = {"of": "head_x", "parameters": {"period": 1.0}, "estimate": False, "scene": SMOOTH, **SHORT}
    without, along = gradient(**given | {"stations": None}), gradient(**given)
    assert np.array_equal(without.derivative, along.derivative) and len(along.run.x) == 11


def test_a_swim_that_stops_is_told():
    light = Scene(reactive=False, density=10.0)
    with pytest.raises(SimulationStopped, match="energy from nowhere"):
        gradient("head_x", {"period": 1.0}, scene=light, accuracy=Accuracy(name="long", resolution=10.0, step=0.05))


def test_the_derivative_by_the_ballast_is_that_of_two_swims():
    def roll_rate(run):
        return {"roll": float(run.twist[-1, 0])}

    swims = [
        simulate(falling(), 1.5, scene=Scene(metacentric_height=height), sample_period=0.1) for height in (0.01, -0.01)
    ]
    found = gradient(roll_rate, {"scene.metacentric_height": 0.0}, gait=falling, duration=1.5, sample_period=0.1)
    difference = (swims[0].twist[-1, 0] - swims[1].twist[-1, 0]) / 0.02
    assert found.derivative[0, 0] == pytest.approx(difference, rel=0.05)
    assert found.error[0, 0] < 0.01 * abs(found.derivative[0, 0])
