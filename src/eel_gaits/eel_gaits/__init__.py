# SPDX-License-Identifier: Apache-2.0
"""Curvature laws of elongated swimmers, and a ROS 2 node that publishes them. Nothing imported here needs ROS."""

from eel_gaits.gaits.diving import falling, rising
from eel_gaits.gaits.kern import kern_efficient, kern_fast
from eel_gaits.gaits.registry import GAITS, gait
from eel_gaits.gaits.rolling import helix, rolling
from eel_gaits.gaits.swimming import backward, still, straight, turning
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import Term

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
