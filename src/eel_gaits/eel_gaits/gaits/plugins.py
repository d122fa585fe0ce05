# SPDX-License-Identifier: Apache-2.0
"""Gaits of other packages. A package names them in the entry-point group `eel_gaits.gaits`, and is installed.

[project.entry-points."eel_gaits.gaits"]
wiggle = "my_package.gaits:wiggle"          # a function with the decorator `eel_gaits.register`
"""

import warnings
from importlib.metadata import entry_points

from eel_base.wording import one_line

from eel_gaits.gaits.registry import GAITS

GROUP = "eel_gaits.gaits"


def load_gaits():
    """Load the gaits of other packages, each of which lists itself. One that cannot be loaded gives a warning."""
    for entry in entry_points(group=GROUP):
        try:
            function = entry.load()
            if GAITS.get(entry.name) is not function:
                raise ValueError(f"{entry.value} is no function of that name with the decorator eel_gaits.register")
        except Exception as error:  # it is the code of others
            warnings.warn(f"gait {entry.name!r} is left out: {one_line(error)}", stacklevel=2)
