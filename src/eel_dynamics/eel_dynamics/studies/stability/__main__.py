# SPDX-License-Identifier: Apache-2.0
"""`python -m eel_dynamics.studies.stability`, where the executable `stability` is not on the PATH."""

import sys

from eel_dynamics.studies.stability.command import main

sys.exit(main())
