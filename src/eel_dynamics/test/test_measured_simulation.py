# SPDX-License-Identifier: Apache-2.0
"""A simulation that measures its own error as it goes: it moves like any other, and its estimate bounds its error."""

import numpy as np
import pytest
from eel_gaits.laws.law import Law
from eel_gaits.laws.term import Term
from scipy.spatial.transform import Rotation

from eel_dynamics import Accuracy, Scene, Simulation, SimulationStopped
from eel_gaits import falling, helix, straight, turning

FINE = Accuracy(name="fine settings", resolution=70.0, tolerance=1e-11)
SENSITIVE = {"scene": Scene(density=3000.0, friction="laminar"), "accuracy": 1e-3}
POINTS = np.linspace(0.0, 1.0, 21)


def send(simulation, number: int):
    """A controller's sample of a yaw wave at number / 20 s."""
    turn, none = 6.0 * POINTS - 5.0 * number / 20.0, np.zeros(len(POINTS))
    wave = np.sin(turn), -5.0 * np.cos(turn), -25.0 * np.sin(turn)
    simulation.add_samples(number / 20.0, POINTS, none, none, none, *wave)


def with_laws(simulation):
    """Two laws, the second in mid-motion, a refused one, and a reset."""
    simulation.adopt(falling())
    simulation.advance(0.33)
    with pytest.raises(ValueError, match="period"):
        simulation.adopt(Law(Term(axis="yaw", amplitude=(1.0,), period=1e-9)))
    simulation.adopt(turning(), transition=0.7)
    simulation.advance(1.5)
    yield simulation
    simulation.reset()
    simulation.advance(1.0)
    yield simulation


def with_controller(simulation):
    """Samples sent one at a time, each just before it is needed; then silence; then samples again."""
    for number in range(60):
        if not 30 <= number < 50:
            send(simulation, number + 1)
        if number:
            simulation.advance(number / 20.0)
    yield simulation


@pytest.mark.parametrize("motion", [with_laws, with_controller])
@pytest.mark.parametrize("accuracy", ["draft", "standard", "1e-3, fixed steps"])
def test_it_moves_to_the_same_bits_as_any_other(motion, accuracy):
    for measured, bare in zip(
        motion(Simulation(measure_error=True, accuracy=accuracy)), motion(Simulation(accuracy=accuracy)), strict=True
    ):
        assert measured.state.tobytes() == bare.state.tobytes() and measured.time == bare.time
        assert measured.observe().whole.tobytes() == bare.observe().whole.tobytes()
        assert 0.0 < measured.error_estimate.position < 1.0
    assert bare.error_estimate is None


def test_the_head_is_nearer_to_the_true_motion_than_its_errors_say():
    scene = Scene(friction="laminar")
    simulation = Simulation(measure_error=True, law=helix(), accuracy="standard", scene=scene)
    reference = Simulation(law=helix(), accuracy=FINE, scene=scene)
    greatest = np.zeros(4)
    assert np.isinf(simulation.head_errors.position) and simulation.head_errors.relative == 0.0
    for number in range(1, 61):
        this, true = (each.observe() for each in (simulation, reference) if each.advance(number / 10.0))
        angle = (Rotation.from_quat(this.orientation).inv() * Rotation.from_quat(true.orientation)).magnitude()
        far, twist = np.linalg.norm(this.position - true.position), this.twist - true.twist
        greatest = np.maximum(greatest, (far, angle, np.linalg.norm(twist[3:]), np.linalg.norm(twist[:3])))
    errors = simulation.head_errors
    assert errors.relative == simulation.error_estimate.position
    assert np.all(greatest < errors[1:]) and np.all(np.array(errors[1:]) < 1e-3), (greatest, errors)
    estimate = simulation.error_estimate
    assert estimate.orientation == errors.orientation and 0.0 < estimate.twist < 1e-3 and estimate.joint_angle is None


def test_a_head_whose_position_was_lost_has_no_absolute_errors():
    simulation = Simulation(measure_error=True, law=falling(period=0.4), **SENSITIVE)
    while simulation.lost_at is None:
        simulation.advance(simulation.time + 0.1)
    assert np.isinf(simulation.head_errors[1:]).all() and np.isfinite(simulation.head_errors.relative)
    simulation.reset()
    simulation.advance(0.1)
    assert np.isfinite(simulation.head_errors).all()


@pytest.mark.parametrize("law", [falling(), straight(), helix()])
@pytest.mark.parametrize("accuracy", ["draft", "standard"])
def test_its_estimate_is_above_its_error(law, accuracy):
    simulation = Simulation(measure_error=True, law=law, accuracy=accuracy, scene=Scene(friction="laminar"))
    reference = Simulation(law=law, accuracy=FINE, scene=Scene(friction="laminar"))
    position, torque, path, largest = 0.0, 0.0, 0.0, 0.0
    before = np.zeros(3)
    for number in range(1, 81):
        this, true = (each.observe() for each in (simulation, reference) if each.advance(number / 10.0))
        position = max(position, float(np.linalg.norm(this.position - true.position)))
        torque = max(torque, float(np.linalg.norm(this.torque - true.torque, axis=1).max()))
        largest = max(largest, float(np.linalg.norm(true.torque, axis=1).max()))
        path, before = path + float(np.linalg.norm(true.position - before)), true.position.copy()
    estimate = simulation.error_estimate
    assert position / max(path, 1.0) < estimate.position < simulation.accuracy.target
    assert torque / largest < estimate.torque < simulation.accuracy.target


def test_the_error_of_a_controller_s_motion_is_small_though_it_rests_and_resumes():
    """If the companion took over, rested or resumed at another time, it would be far away."""
    (simulation,) = with_controller(Simulation(measure_error=True))
    assert simulation.sampled and simulation.measured_since == 0.0
    assert simulation.error_estimate.position < 1e-3


def test_what_errors_have_spoilt_is_said_and_measured_anew():
    simulation = Simulation(measure_error=True, law=falling(period=0.4), **SENSITIVE)
    for number in range(1, 91):
        simulation.advance(number / 10.0)
    assert simulation.lost_at == pytest.approx(simulation.measured_since) and simulation.lost_at > 1.0
    assert simulation.error_estimate.growth_rate > 0.5
    true = Simulation(law=falling(period=0.4), accuracy=FINE, scene=SENSITIVE["scene"])
    true.advance(9.0)
    assert np.linalg.norm(true.state[:3] - simulation.state[:3]) > 0.03
    simulation.reset()
    assert simulation.lost_at is None and simulation.error_estimate.position == 0.0


def test_a_companion_that_stops_leaves_the_motion_alone(monkeypatch):
    simulation, bare = Simulation(measure_error=True, law=falling()), Simulation(law=falling())
    simulation.advance(0.5)

    def stop(companion, time, interrupted=None):
        raise SimulationStopped(companion.time, "twist", np.inf, "for this test")

    companion = simulation._meter._companion
    monkeypatch.setattr(companion, "advance", stop.__get__(companion))
    for each in (simulation, bare):
        each.advance(1.0)
    assert simulation.state.tobytes() == bare.state.tobytes()
    assert simulation.error_estimate.position == np.inf
    assert "not known" in simulation.error_estimate.over_target(1e-4, 1.0)
    simulation.reset()
    simulation.advance(1.0)
    assert simulation.error_estimate.position < 1e-4


def test_a_copy_with_other_settings_goes_on_from_the_present():
    simulation = Simulation(law=falling(), accuracy="draft")
    simulation.advance(1.0)
    simulation.adopt(turning(), transition=0.5)
    fine = simulation.copy_with(FINE)
    assert fine.time == 1.0 and fine.observe().position == pytest.approx(simulation.observe().position, abs=1e-15)
    assert fine.observe().twist == pytest.approx(simulation.observe().twist, abs=1e-9)
    before = simulation.state
    fine.advance(3.0)
    assert np.array_equal(simulation.state, before)
    simulation.advance(3.0)
    distance = np.linalg.norm(fine.state[:3] - simulation.state[:3])
    assert 0.0 < distance < 1e-2


def test_a_recorded_motion_is_measured_too():
    simulation = Simulation(measure_error=True, law=straight(), accuracy="draft")
    simulation.record(np.linspace(0.0, 4.0, 41), True, False)
    stepped = Simulation(measure_error=True, law=straight(), accuracy="draft")
    for time in np.linspace(0.1, 4.0, 40):
        stepped.advance(float(time))
    assert 0.3 < simulation.error_estimate.position / stepped.error_estimate.position < 3.0
    for times, told in (([np.nan], "times must be finite"), ([3.9], "times must not fall"), (None, "times must be")):
        with pytest.raises(ValueError, match=told):
            simulation.record(times, True, False)
    assert simulation.time == 4.0
    simulation.record([np.nextafter(4.0, 0.0), 4.1], True, False)
    assert simulation.time == pytest.approx(4.1)
