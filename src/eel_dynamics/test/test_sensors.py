# SPDX-License-Identifier: Apache-2.0
"""Sensors in the library: the motion that they feel against closed forms and differences, and their readings."""

from itertools import pairwise

import numpy as np
import pytest
from eel_dynamics.model.robot.robot import robot_of
from eel_dynamics.sensors.sensor import Motion, Sensor, Surroundings
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from eel_dynamics import Accuracy, Body, Imu, Scene, Shear, Simulation, simulate
from eel_gaits import Law, backward, falling

ALONE = Scene(reactive=False, resistive=False, nose=False)  # no water but for its pressure
G = 9.80665
STRAIGHT = Law(name="straight")


def sections(body):
    """Mass, centre of mass behind the nose, and inertia about it (3,) of a straight body, by adaptive quadrature."""

    def along(density):
        ends = [0.0, *body.kinks[1:-1], body.length]
        return sum(quad(density, a, b, epsabs=0.0, epsrel=1e-13, limit=500)[0] for a, b in pairwise(ends))

    def line(x):
        return body.density * np.pi * float(body.half_width(np.array([x]))[0] * body.half_height(np.array([x]))[0])

    mass = along(line)
    centre = along(lambda x: x * line(x)) / mass
    wide, high = (
        along(lambda x, of=of: line(x) * float(of(np.array([x]))[0]) ** 2 / 4.0)
        for of in (body.half_width, body.half_height)
    )
    lever = along(lambda x: line(x) * (x - centre) ** 2)
    return mass, centre, np.array([wide + high, high + lever, wide + lever])  # about x, y (pitch), z (yaw)


def smooth_body():
    """An ellipsoid-like body whose sections are smooth."""
    return Body(
        length=1.0,
        half_width=lambda x: 0.03 * np.sqrt(np.maximum(0.0, 4.0 * x * (1.0 - x))),
        half_height=lambda x: 0.05 * np.sqrt(np.maximum(0.0, 4.0 * x * (1.0 - x))),
        nose=(0.03, 0.05, 0.05),
        name="ellipsoid",
    )


@pytest.mark.parametrize("axis", [1, 2], ids=["pitching", "turning"])
def test_a_towed_body_that_turns_about_a_principal_axis_feels_the_centripetal_and_the_weight(axis):
    """f = R^T (g z) - omega^2 r along the body for all time; 1e-10 of a quadrature and of steps of 1e-14."""
    body, rate = smooth_body(), 1.7
    _, centre, _ = sections(body)
    omega = np.zeros(3)
    omega[axis] = rate
    towed = np.array([0.4, -0.3, 0.2])
    start = (*omega, *(towed + np.cross(omega, [centre, 0.0, 0.0])))  # of the head, at +centre from the centre of mass
    run = simulate(
        STRAIGHT,
        0.5,
        body=body,
        scene=ALONE,
        twist=start,
        sample_period=0.05,
        accuracy=Accuracy(name="rigid", resolution=60.0, tolerance=1e-14),
        estimate=False,
    )
    for station in (0.0, 0.37, 1.0):
        read = run.imu(station, orientation=True)
        turned = Rotation.from_rotvec(np.outer(run.time, omega))
        expected = turned.inv().apply([0.0, 0.0, G])
        expected[:, 0] += -(rate**2) * (centre - station)
        np.testing.assert_allclose(read.specific_force, expected, rtol=0.0, atol=1e-10)
        np.testing.assert_allclose(read.angular_velocity, np.tile(omega, (11, 1)), rtol=0.0, atol=1e-10)
        assert (turned.inv() * Rotation.from_quat(read.orientation)).magnitude().max() < 1e-10
        place = towed * run.time[:, None] + turned.apply([centre - station, 0.0, 0.0]) - [centre, 0.0, 0.0]
        np.testing.assert_allclose(run.depth(station), -place[:, 2], rtol=0.0, atol=1e-10)
        over_ground = turned.inv().apply(np.tile(towed, (11, 1))) + np.cross(omega, [centre - station, 0.0, 0.0])
        np.testing.assert_allclose(run.velocity(station).velocity, over_ground, rtol=0.0, atol=1e-10)


def test_a_body_that_turns_about_all_axes_feels_euler_s_equations():
    """alpha = I^-1 (I omega x omega), f = g z + alpha x r + omega x (omega x r), level and at the start."""
    body = smooth_body()
    _, centre, inertia = sections(body)
    omega = np.array([0.9, -1.3, 2.1])
    twist = np.concatenate((omega, np.array([0.5, 0.1, -0.2]) + np.cross(omega, [centre, 0.0, 0.0])))
    simulation = Simulation(
        body=body, scene=ALONE, twist=twist, law=STRAIGHT, sensors=[0.8, 0.25], accuracy="reference"
    )
    seen = simulation.observe()
    alpha = np.cross(inertia * omega, omega) / inertia
    for index, station in enumerate((0.25, 0.8)):
        motion, r = Motion.of(seen, index), np.array([centre - station, 0.0, 0.0])
        sensor = Sensor(Imu(rate=1.0), Surroundings.of(ALONE, None), station)
        force = sensor.reading(0.0, lambda motion=motion: motion).specific_force
        expected = np.array([0.0, 0.0, G]) + np.cross(alpha, r) + np.cross(omega, np.cross(omega, r))
        np.testing.assert_allclose(force, expected, rtol=0.0, atol=1e-10)
        np.testing.assert_allclose(motion.acceleration[:3], alpha, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("bends", ["by the law", "by itself"])
def test_the_acceleration_of_a_bending_body_is_the_second_difference_of_its_backbone(bends):
    """The error of central differences falls with the square of the period, for sections in front and behind."""
    robot = robot_of("sixteen_servos") if bends == "by itself" else None
    law = backward() if robot is not None else falling()
    errors = []
    for period in (0.02, 0.01, 0.005):
        simulation = Simulation(
            law=law,
            robot=robot,
            stations=[0.3, 0.9],
            sensors=[0.3, 0.9],
            accuracy=Accuracy(name="fine", resolution=60.0, tolerance=1e-10 if robot is None else 1e-8),
        )
        times = 0.6 + period * np.arange(-1, 2)
        out, *_ = simulation.record(times, False, False)
        second = (out.backbone[2] - 2.0 * out.backbone[1] + out.backbone[0]) / period**2
        for index in range(2):
            motion = Motion.of(out, index, 1)
            acceleration = Rotation.from_quat(motion.orientation).apply(motion.acceleration[3:])
            velocity = Rotation.from_quat(motion.orientation).apply(motion.twist[3:])
            first = (out.backbone[2, index] - out.backbone[0, index]) / (2.0 * period)
            size = np.linalg.norm(acceleration)
            assert size > 0.05
            errors.append((np.linalg.norm(acceleration - second[index]) / size, np.linalg.norm(velocity - first)))
    coarse, middle, fine = (np.array(errors[k : k + 2]) for k in (0, 2, 4))
    for before, after in ((coarse, middle), (middle, fine)):
        order = np.log2(before / after)
        assert np.all(np.abs(order - 2.0) < 0.2), order
    assert fine[:, 0].max() < 2e-3


def test_through_the_water_is_relative_to_flow_and_current_at_the_sensor():
    current, shear = (0.1, -0.2, 0.05), Shear(velocity=(0.3, 0.0, 0.0), width=0.5)
    run = simulate(
        falling(), 1.5, scene=Scene(current=current), flow=shear, sample_period=0.5, twist=(0, 0, 0.5, 0.2, 0, 0)
    )
    station = run.x[30]
    ground, water = run.velocity(station).velocity, run.velocity(station, through_water=True).velocity
    flow = [shear.sample(run.backbone[k, 30], t).velocity + current for k, t in enumerate(run.time)]
    turned = Rotation.from_quat(run.section_orientation[:, 30])
    np.testing.assert_allclose(ground - water, turned.inv().apply(flow), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(run.velocity(0.0).velocity, run.twist[:, 3:], rtol=0.0, atol=1e-13)


def test_sensors_change_nothing_else():
    plain, sensed = (Simulation(law=falling(), sensors=where) for where in ((), (0.11, 0.7)))
    for simulation in (plain, sensed):
        simulation.advance(1.234)
    before, after = plain.observe(), sensed.observe()
    profiles = ("backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force")
    for name, values in before.arrays().items():
        tolerance = 1e-14 if name in (*profiles, "fluid_force", "resistive_force") else 0.0  # rows of other matrices
        np.testing.assert_allclose(after.arrays()[name], values, rtol=0.0, atol=tolerance, err_msg=name)
    assert before.sensor_twist is None and after.sensor_twist.shape == (2, 6)
    assert np.array_equal(plain.state, sensed.state)


def test_a_sensor_at_a_station_is_where_the_station_is():
    simulation = Simulation(law=falling(), stations=11, sensors=np.linspace(0.0, 1.0, 11))
    simulation.advance(2.0)
    seen = simulation.observe()
    np.testing.assert_allclose(seen.sensor_position, seen.backbone, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(seen.sensor_orientation, seen.section_orientation, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(seen.sensor_twist[0], seen.twist, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(seen.sensor_acceleration[0], seen.head_acceleration, rtol=0.0, atol=1e-13)
