"""`python -m eel_dynamics.stability`, where the executable `stability` is not on the PATH."""

import sys

from .command import main

sys.exit(main())
