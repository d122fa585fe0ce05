# SPDX-License-Identifier: Apache-2.0
"""Curvature laws of elongated swimmers, and a ROS 2 node that publishes them. Nothing imported here needs ROS."""

from eel_gaits.gaits.bursts import burst_and_coast, c_start
from eel_gaits.gaits.cpg import cpg
from eel_gaits.gaits.diving import diving, falling, rising, spiral
from eel_gaits.gaits.fish import anguilliform, carangiform
from eel_gaits.gaits.kern import kern_efficient, kern_fast
from eel_gaits.gaits.registry import GAITS, gait
from eel_gaits.gaits.rolling import helix, roll_over, rolling
from eel_gaits.gaits.sequence_file import sequence_from_file
from eel_gaits.gaits.snakes import joint_wave, serpenoid
from eel_gaits.gaits.swimming import backward, still, straight, turning
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.sequence import sequence
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import Term

__all__ = [
    "GAITS",
    "Law",
    "Ramp",
    "Term",
    "anguilliform",
    "backward",
    "burst_and_coast",
    "c_start",
    "carangiform",
    "cpg",
    "diving",
    "falling",
    "gait",
    "helix",
    "joint_wave",
    "kern_efficient",
    "kern_fast",
    "natural_spline",
    "rising",
    "roll_over",
    "rolling",
    "sequence",
    "sequence_from_file",
    "serpenoid",
    "spiral",
    "still",
    "straight",
    "turning",
]
