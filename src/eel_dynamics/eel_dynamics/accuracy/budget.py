# SPDX-License-Identifier: Apache-2.0
"""A budget of time in place of an accuracy: "fastest within 5 ms per second", on this machine."""

import re
from dataclasses import dataclass

from eel_base.wording import shown

UNITS = {"us": 1e-6, "ms": 1e-3, "s": 1.0}
PATTERN = re.compile(r"fastest within\s+([0-9.eE+-]+)\s*(us|ms|s) per second")


@dataclass(frozen=True)
class Budget:
    """The most wall time per simulated time [s/s] that a run may take."""

    name: str
    seconds_per_second: float

    @staticmethod
    def of(text: str) -> "Budget":
        """The budget in a text such as "fastest within 5 ms per second". `ValueError` for any other text."""
        found = PATTERN.fullmatch(text.strip())
        try:
            seconds = float(found.group(1)) * UNITS[found.group(2)] if found else 0.0
        except ValueError:
            seconds = 0.0
        if not 0.0 < seconds < float("inf"):
            raise ValueError(
                "accuracy must give its budget as in 'fastest within 5 ms per second' (us, ms or s; > 0), "
                f"got {shown(text)}"
            )
        return Budget(text.strip(), seconds)
