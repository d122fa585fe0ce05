# SPDX-License-Identifier: Apache-2.0
"""Reads the stamps of messages as seconds of simulation time."""

from builtin_interfaces.msg import Time

LATEST = 2**31 - 61  # s: a minute before the last second that a stamp holds, so that what answers it has a stamp too


def seconds_of(stamp: Time, name: str = "header.stamp") -> float:
    """The time [s] of a stamp. `ValueError` for one that is not valid, or so late that no answer can follow it.

    name: of the field, for the error.
    """
    if not 0 <= stamp.sec < LATEST or stamp.nanosec >= 1_000_000_000:
        rule = f">= 0 s and < {LATEST} s, with nanosec < 1e9"
        raise ValueError(f"{name} must be {rule}, got sec {stamp.sec}, nanosec {stamp.nanosec}")
    return stamp.sec + 1e-9 * stamp.nanosec
