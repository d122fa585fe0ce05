# SPDX-License-Identifier: Apache-2.0
"""Columns of a body from a file: x, half_width, half_height [m] of a .csv with a header line, or of an .npz archive."""

from pathlib import Path

import numpy as np
from eel_gaits.sources.tables import read_table

COLUMNS = ("x", "half_width", "half_height")
LARGEST = 1e6  # m
WHAT = "body file "  # begins an error


def columns_of(path: Path) -> dict[str, np.ndarray]:
    """Each of `COLUMNS`. `ValueError` in one line that names the file, and line and column of a number."""
    table = read_table(path, WHAT)
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise table.error(f"a body must have columns {', '.join(COLUMNS)}; {', '.join(missing)} missing")
    table.check_finite(COLUMNS, LARGEST)
    return {name: table.columns[name] for name in COLUMNS}
