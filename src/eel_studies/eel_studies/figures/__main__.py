# SPDX-License-Identifier: Apache-2.0
"""`python -m eel_studies.figures`, where the executable `figures` is not on the PATH."""

import sys

from eel_studies.figures.command import main

sys.exit(main())
