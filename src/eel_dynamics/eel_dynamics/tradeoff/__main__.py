"""`python -m eel_dynamics.tradeoff`."""

import sys

from .command import main

sys.exit(main())
