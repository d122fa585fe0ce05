# SPDX-License-Identifier: Apache-2.0
"""Numbers as people read them: three digits, no power of ten where it can be avoided, and a unit that fits."""

import math

UNITS = (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6))
DIGITS = 3


def number(value: float) -> str:
    """`value` to three digits: 0.0123, 1,740, 130; with a power of ten only below 0.0001 and from a million on."""
    if value == 0 or not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{DIGITS}g}"
    decimals = max(0, DIGITS - 1 - math.floor(math.log10(abs(value))))
    return f"{float(f'{value:.{DIGITS}g}'):,.{decimals}f}"


def length(metres: float) -> str:
    """A length [m] with the unit m, mm or µm that makes its number at least 1."""
    for unit, size in UNITS:
        if abs(metres) >= size:
            return f"{number(metres / size)} {unit}"
    return f"{number(metres)} m" if metres == 0 else f"{number(metres / UNITS[-1][1])} {UNITS[-1][0]}"
