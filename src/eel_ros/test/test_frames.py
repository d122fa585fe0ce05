# SPDX-License-Identifier: Apache-2.0
"""Frame ids below a namespace, and headings."""

import math

import pytest
from eel_ros.frames import frame_in, heading


@pytest.mark.parametrize(
    ("namespace", "expected"), [("/", "odom"), ("", "odom"), ("/eel1", "eel1/odom"), ("/tank/eel1", "tank/eel1/odom")]
)
def test_a_frame_lies_below_its_namespace_without_a_leading_slash(namespace, expected):
    assert frame_in(namespace, "odom") == expected


@pytest.mark.parametrize("angle", [-3.0, -0.5, 0.0, 1.0, 3.1])
def test_heading_is_the_angle_to_the_left_whatever_pitch_and_norm(angle):
    c, s = math.cos(angle / 2), math.sin(angle / 2)
    assert heading((0.0, 0.0, s, c)) == pytest.approx(angle)
    pitched = (-0.4 * s, 0.4 * c, 0.9 * s, 0.9 * c)  # yaw after a pitch with cos 0.9 and sin 0.4 of its half, unscaled
    assert heading(pitched) == pytest.approx(angle)
