# SPDX-License-Identifier: Apache-2.0
"""`python -m eel_studies.stability`, where the executable `stability` is not on the PATH."""

import sys

from eel_studies.stability.command import main

sys.exit(main())
