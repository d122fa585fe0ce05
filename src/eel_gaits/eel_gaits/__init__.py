# SPDX-License-Identifier: Apache-2.0
"""Curvature laws of elongated swimmers, and a ROS 2 node that publishes them. Nothing imported here needs ROS."""

from eel_gaits.gaits import (
    backward,
    falling,
    helix,
    kern_efficient,
    kern_fast,
    rising,
    rolling,
    still,
    straight,
    turning,
)
from eel_gaits.law import Law, Ramp, Term
from eel_gaits.registry import GAITS, gait
from eel_gaits.spline import natural_spline

__all__ = [
    "GAITS",
    "Law",
    "Ramp",
    "Term",
    "backward",
    "falling",
    "gait",
    "helix",
    "kern_efficient",
    "kern_fast",
    "natural_spline",
    "rising",
    "rolling",
    "still",
    "straight",
    "turning",
]
