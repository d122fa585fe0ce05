# SPDX-License-Identifier: Apache-2.0
"""The stamps of messages from other nodes, as simulation time."""

from builtin_interfaces.msg import Time
from eel_common.ros.headers import Stamp, seconds_of

STAMP_ERROR = 1.5e-9  # s: rounding error of a stamp that a controller computes from another stamp
FAR_AHEAD = 3600.0  # s: a stamp further ahead of the simulation is wall time by mistake


def stamped(stamp: Time | Stamp, now: float) -> float:
    """The `stamp` [s] of a message. now: simulation time [s]. `ValueError` for an invalid stamp, or one far ahead."""
    time = seconds_of(stamp)
    if time > now + FAR_AHEAD:
        raise ValueError(
            f"header.stamp must be simulation time, at most {FAR_AHEAD:g} s ahead of {now:g} s, got {time:.3f} s: "
            "that looks like wall time, does its publisher have use_sim_time set?"
        )
    return time


def on_sample(stamp: float, rate: float) -> float:
    """A controller's `stamp` [s], or the time [s] of a sample at `rate` [Hz] if the two differ by rounding alone."""
    instant = round(stamp * rate) / rate
    return instant if abs(instant - stamp) < STAMP_ERROR else stamp
