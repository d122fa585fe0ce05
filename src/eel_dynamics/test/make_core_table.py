# SPDX-License-Identifier: Apache-2.0
"""Writes src/eel_core/test/reference_table.hpp: a bent body of equal sections by the reference, for the C++ tests.

From the root of the repository:

    source setup.bash && python src/eel_dynamics/test/make_core_table.py
"""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
from reference import Reference, scene

OUT = Path(__file__).parents[2] / "eel_core" / "test" / "reference_table.hpp"
HALF_HEIGHT, HALF_WIDTH = 0.06, 0.04  # m
NODES = 8
BEND = np.array([0.0, 0.4, 0.7]), np.array([0.0, -1.1, 1.6]), np.array([0.0, 2.0, -5.0])  # K, its rates: 1/m, 1/s
TWIST = np.array([1.9, -0.2, 0.5, -0.6, 0.9, -1.8])  # rad/s, m/s; no speed of a section changes its sign
TEXT = """// SPDX-License-Identifier: Apache-2.0
// A bent body of equal sections, 1 m long, by the reference in Python.
// Written by src/eel_dynamics/test/make_core_table.py.
#pragma once

#include <array>

namespace eel_core::reference {{

// kg/m and kg m: mass, added2, added3, inertia1, inertia2, inertia3, added_roll
inline constexpr std::array<double, 7> section{{{section}}};
// kg/m^2 and kg: drag2, drag3, drag_roll
inline constexpr std::array<double, 3> drag{{{drag}}};
// (K2, K3) rad/m, and two time derivatives
inline constexpr std::array<std::array<double, 2>, 3> bend{{{{{bend}}}}};
// Omega rad/s, V m/s
inline constexpr std::array<double, 6> twist{{{twist}}};
// rad/s^2, m/s^2: true acceleration of the head, in its axes
inline constexpr std::array<double, 6> acceleration{{{acceleration}}};
// W, of the actuators
inline constexpr double actuator_power{{{power}}};
// N m, N: internal wrench at the nodes, section axes
inline constexpr std::array<std::array<double, 6>, 8> wrench{{{{{wrench}}}}};

}}  // namespace eel_core::reference
"""


def table() -> str:
    """The text of the file."""
    body = SimpleNamespace(
        half_width=lambda x: np.full(np.shape(x), HALF_WIDTH),
        half_height=lambda x: np.full(np.shape(x), HALF_HEIGHT),
        kinks=(0.0, 1.0),
        nose=(0.0, 0.0, 0.0),
        density=1000.0,
    )
    reference = Reference(body, scene(friction="none", nose=False), panels_per_span=2, nodes_per_panel=16)
    x = 0.5 * (1.0 + np.cos(2.0 * np.pi * np.arange(NODES - 1, -1, -1) / (2 * NODES - 1)))
    motion = *(np.tile(each, (len(reference.space.x), 1)) for each in BEND), TWIST
    speeds = reference.twists(motion[0], motion[1], TWIST)[:, [0, 4, 5]]
    assert (np.sign(speeds) == np.sign(speeds[0])).all(), "the drag has a kink"
    rate = reference.acceleration(*motion)
    fields = reference.fields(*motion, rate)
    wrench = np.hstack([reference.space.evaluate(each, x) for each in (fields.torque, fields.force)])
    true = rate + np.concatenate([np.zeros(3), np.cross(TWIST[:3], TWIST[3:])])
    inertia, added = (each[0] for each in (reference.inertia_body, reference.inertia_fluid))
    square = (HALF_HEIGHT**2 - HALF_WIDTH**2) ** 2
    section = inertia[3], *added[4:], *(inertia + added)[:3], added[0]
    drag = 500.0 * np.array([2 * 1.98 * HALF_HEIGHT, 2 * 1.0 * HALF_WIDTH, np.pi * square])
    return TEXT.format(
        section=_row(section),
        drag=_row(drag),
        bend=_rows(each[1:] for each in BEND),
        twist=_row(TWIST),
        acceleration=_row(true),
        power=_row([fields.actuator_power]),
        wrench=_rows(wrench),
    )


def _row(numbers) -> str:
    return ", ".join(f"{number:.10g}" for number in numbers)


def _rows(rows) -> str:
    return ", ".join("{" + _row(row) + "}" for row in rows)


if __name__ == "__main__":
    OUT.write_text(table())
