# SPDX-License-Identifier: Apache-2.0
"""Numbers as people read them: three digits, no power of ten where it can be avoided, and a unit that fits."""

import math

PREFIXES = (("", 1.0), ("m", 1e-3), ("µ", 1e-6))
DIGITS = 3


def number(value: float) -> str:
    """`value` to three digits: 0.0123, 1,740, 130; with a power of ten only below 0.0001 and from a million on."""
    if value == 0 or not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{DIGITS}g}"
    decimals = max(0, DIGITS - 1 - math.floor(math.log10(abs(value))))
    return f"{float(f'{value:.{DIGITS}g}'):,.{decimals}f}"


def quantity(value: float, unit: str) -> str:
    """`value` [unit] with the prefix (none, milli, micro) that makes the number at least 1, if there is one."""
    prefix, size = next(
        (each for each in PREFIXES if abs(value) >= each[1]), PREFIXES[0] if value == 0 else PREFIXES[-1]
    )
    return f"{number(value / size)} {prefix}{unit}"
