"""`python -m eel_dynamics.figures`, where the executable `figures` is not on the PATH."""

import sys

from .command import main

sys.exit(main())
