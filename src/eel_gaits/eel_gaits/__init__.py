# SPDX-License-Identifier: Apache-2.0
"""Curvature laws of elongated swimmers, and a ROS 2 node that publishes them. Nothing imported here needs ROS."""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports
from eel_common.quantity import Quantities, quantity

from eel_gaits.gaits.cpg import cpg
from eel_gaits.gaits.diving import diving, falling, helix, rising, roll_over, rolling, spiral
from eel_gaits.gaits.fish import anguilliform, carangiform, kern_efficient, kern_fast
from eel_gaits.gaits.registry import GAITS, gait, load_gaits, register
from eel_gaits.gaits.sequence import sequence, sequence_from_file
from eel_gaits.gaits.snakes import joint_wave, serpenoid
from eel_gaits.gaits.swimming import backward, burst_and_coast, c_start, still, straight, turning
from eel_gaits.laws.law import Law
from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import Term
from eel_gaits.sources.function_law import sampled
from eel_gaits.sources.motion_file import read_midlines, read_motion, save_law
from eel_gaits.sources.sampled_law import SampledLaw

__all__ = [
    "GAITS",
    "Law",
    "Quantities",
    "Ramp",
    "SampledLaw",
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
    "quantity",
    "read_midlines",
    "read_motion",
    "register",
    "rising",
    "roll_over",
    "rolling",
    "sampled",
    "save_law",
    "sequence",
    "sequence_from_file",
    "serpenoid",
    "spiral",
    "still",
    "straight",
    "turning",
]

load_gaits()  # last: they import the names above
