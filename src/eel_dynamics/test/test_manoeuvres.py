# SPDX-License-Identifier: Apache-2.0
"""Each manoeuvre does what its name says, on the robot of the paper: heading, depth and roll."""

import math

import numpy as np
import pytest

from eel_dynamics import simulate
from eel_gaits import gait


class Swim:
    """A run of a gait. course: displacement (3,) [m]; forward, left, up (T, 3): the head's axes."""

    def __init__(self, name, duration, **numbers):
        self.run = simulate(
            gait(name, **numbers), duration, accuracy="draft", estimate=False, sample_period=0.05, stations=11
        )
        x, y, z, w = self.run.orientation.T
        first = np.stack((1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)), axis=1)
        third = np.stack((2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)), axis=1)
        self.forward, self.up = first, third
        self.path = self.run.center_of_mass
        self.speed = np.linalg.norm(np.gradient(self.path, self.run.time, axis=0), axis=1)

    @property
    def course(self):
        return self.path[-1] - self.path[0]

    def heading(self, start, end):
        """Mean heading [rad] of the head from `start` to `end` [s]; positive: left."""
        angle = np.unwrap(np.arctan2(self.forward[:, 1], self.forward[:, 0]))
        return np.mean(angle[(self.run.time >= start) & (self.run.time < end)])


@pytest.mark.parametrize("name", ["serpenoid", "joint_wave", "carangiform", "anguilliform", "burst_and_coast"])
def test_swims_forward(name):
    swim = Swim(name, 8.0)
    assert swim.course[0] > 2.0 and abs(swim.course[1]) < 0.2 * swim.course[0] and abs(swim.course[2]) < 1e-9


@pytest.mark.parametrize("bend", [4.0, -4.0])
def test_a_c_start_turns_to_its_side_and_is_faster_than_the_plain_start(bend):
    swim, plain = Swim("c_start", 3.0, left_bend=bend), Swim("straight", 3.0)
    assert math.copysign(1.0, swim.heading(2.0, 3.0)) == math.copysign(1.0, bend)
    assert abs(swim.heading(2.0, 3.0)) > math.radians(60.0)
    assert np.max(swim.speed[:31]) > 3.0 * np.max(plain.speed[:31])


def test_a_body_that_coasts_keeps_its_course_and_loses_speed():
    swim = Swim("burst_and_coast", 12.0)
    coasting = (swim.run.time > 9.0) & (swim.run.time < 12.0)
    assert np.all(np.diff(swim.speed[coasting][1:-1]) < 0.0)


def test_diving_goes_down_a_slope_and_a_negative_bend_goes_up():
    down, up = Swim("diving", 12.0), Swim("diving", 12.0, pitch_bend=-0.4)
    last = down.path[-1] - down.path[-61]
    slope = math.degrees(math.atan2(last[2], np.hypot(last[0], last[1])))
    assert -50.0 < slope < -30.0
    np.testing.assert_allclose(up.course, down.course * [1.0, 1.0, -1.0], atol=0.02)


def test_a_spiral_is_a_helix_about_a_steep_axis_that_goes_down():
    """In each period the body makes the same screw motion: the mean velocities lie on a cone about the helix's axis."""
    right, left = Swim("spiral", 30.0), Swim("spiral", 30.0, left_bend=2.0)
    steps = right.path[200::20] - right.path[180:-20:20]  # of 1 s, one period, from 10 s on
    np.testing.assert_allclose(np.linalg.norm(steps, axis=1), np.linalg.norm(steps[-1]), rtol=1e-3)
    changes = np.diff(steps, axis=0)  # all across the axis
    axis = np.mean(np.cross(changes[:-1], changes[1:]), axis=0)
    axis /= np.linalg.norm(axis)
    np.testing.assert_allclose(changes @ axis, 0.0, atol=2e-3 * np.linalg.norm(changes[-1]))
    assert axis[2] < -0.95  # it turns to the right
    assert right.path[-1, 2] - right.path[200, 2] < -2.5
    np.testing.assert_allclose(left.path, right.path * [1.0, -1.0, 1.0], atol=1e-3)


@pytest.mark.parametrize("bend", [0.3, -0.3])
def test_a_roll_over_turns_the_body_on_its_back(bend):
    swim = Swim("roll_over", 7.2, bend=bend)
    assert swim.up[-1, 2] < -0.95 and swim.forward[-1, 0] > 0.99
    assert math.copysign(1.0, swim.up[40, 1]) == -math.copysign(1.0, bend)  # the left side rises: up leans to the right
