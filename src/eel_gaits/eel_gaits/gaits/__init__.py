# SPDX-License-Identifier: Apache-2.0
"""Gaits and manoeuvres by name. Each is a function that makes a `Law` from a few numbers, and starts from rest.

The numbers of a gait are the fields of a frozen dataclass. Each has a unit, a default, bounds and a description.

    falling()                         # the paper's gait
    falling(period=2.0)               # with one number changed
    gait("turning", left_bend=0.5)    # by name

A new gait is a function in a file here, with the decorator `register` (registry.py). eel_gaits/__init__.py names it.
"""
