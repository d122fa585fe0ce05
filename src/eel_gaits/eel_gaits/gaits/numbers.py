# SPDX-License-Identifier: Apache-2.0
"""Numbers that several gaits have, and their smooth start from rest."""

import math

from eel_base.quantity import quantity

from eel_gaits.laws.ramp import Ramp
from eel_gaits.laws.term import Term

# number of the node and of sequence files, positive to the left: that of the gait, which has the opposite sign
TURNS = {"left_bend": "yaw_bend", "left_angle": "yaw_angle"}


def period_quantity(default):
    """The period of a wave [s]."""
    return quantity(default, "s", "period T of the wave", 1e-3, 1e4)


def wavelength_quantity(default, description="wavelength of the wave"):
    """The wavelength of a wave [m]."""
    return quantity(default, "m", description, 1e-4, 1e4)


def start_periods_quantity():
    """The duration of the start from rest, in periods."""
    description = "length of the smooth start from rest, in periods of the wave"
    return quantity(1.0, "periods", description, 0.01, 1e3)


def bend_quantity(default, description):
    """A curvature [rad/m]."""
    return quantity(default, "rad/m", description, -1e5, 1e5)


def instant_quantity(default, description):
    """A time of the law [s]."""
    return quantity(default, "s", description + ", in the law's own time", 0.0, 1e6)


def length_quantity():
    """The length of the body [m]."""
    return quantity(1.0, "m", "body length L", 1e-4, 1e3)


def waves_quantity(default):
    """The number of waves on the body."""
    return quantity(default, "", "waves on the body, L / wavelength", 1e-3, 100.0)


def constant_bend(axis, bend, envelope):
    """The terms of a `bend` [rad/m] of the whole body about an `axis`, with an `envelope`. None where it is 0."""
    return (Term(axis=axis, amplitude=(bend,), phase=0.5 * math.pi, envelope=envelope),) if bend else ()


def start_ramp(numbers):
    """The envelope of a start from rest, of `numbers` that have `period` and `start_periods`."""
    return (Ramp(0.0, numbers.start_periods * numbers.period, 1.0),)


def check_order(numbers, earlier, later):
    """`ValueError` unless the instant `later` lies after the instant `earlier`. Both are names in `numbers`."""
    before, after = getattr(numbers, earlier), getattr(numbers, later)
    if not after > before:
        raise ValueError(f"{later} must be > {earlier} ({before:g} s), got {after}")
