# SPDX-License-Identifier: Apache-2.0
"""The mechanics of elongated swimmers in water (Boyer, Porez and Leroyer, 2010), compiled.

`eel_core._core` is the compiled module for this processor: its level is chosen here. Its names, which _core.pyi lists,
are those of this package.
"""

import sys

from eel_core.levels import import_core

_core = sys.modules["eel_core._core"] = import_core()

from eel_core._core import *  # noqa: E402, F403
