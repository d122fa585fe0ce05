# SPDX-License-Identifier: Apache-2.0
"""`python -m eel_studies.tradeoff`."""

import sys

from eel_studies.tradeoff.command import main

sys.exit(main())
