# SPDX-License-Identifier: Apache-2.0
"""`python -m eel_dynamics.studies.tradeoff`."""

import sys

from eel_dynamics.studies.tradeoff.command import main

sys.exit(main())
