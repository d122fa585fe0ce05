# SPDX-License-Identifier: Apache-2.0
"""Studies: many swims that answer one question."""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports

from eel_studies.gradients.gradient import Gradient, gradient
from eel_studies.identification.fit import Identified
from eel_studies.identification.identify import identify
from eel_studies.identification.measurements import MeasuredAngles, MeasuredPath, MeasuredSpeed
from eel_studies.optimisation.front import Front
from eel_studies.optimisation.optimise import optimise
from eel_studies.scene_terms.study import Terms, terms
from eel_studies.steering.linearisation import PeriodicLinearisation, periodic_linearisation
from eel_studies.sweeps.sweep import sweep

__all__ = [
    "Front",
    "Gradient",
    "Identified",
    "MeasuredAngles",
    "MeasuredPath",
    "MeasuredSpeed",
    "PeriodicLinearisation",
    "Terms",
    "gradient",
    "identify",
    "optimise",
    "periodic_linearisation",
    "sweep",
    "terms",
]
