# SPDX-License-Identifier: Apache-2.0
"""Columns of a body from a file: x, half_width, half_height [m] of a .csv with a header line, or of an .npz archive."""

from pathlib import Path

import numpy as np
from eel_gaits.sources.tables import read_table

COLUMNS = ("x", "half_width", "half_height")
LARGEST = 1e6  # m


def columns_of(path: Path) -> dict[str, np.ndarray]:
    """Each of `COLUMNS`. `ValueError` in one line that names the file, and line and column of a number."""
    table = read_table(path)
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise table.error(f"a body must have columns {', '.join(COLUMNS)}; {', '.join(missing)} missing")
    table.check_finite(COLUMNS)
    found = {name: table.columns[name] for name in COLUMNS}
    for name, values in found.items():
        large = np.flatnonzero(np.abs(values) > LARGEST)
        if len(large):
            raise table.error(f"{name} must be at most {LARGEST:g} m, got {values[large[0]]:g}", large[0])
    return found
