# SPDX-License-Identifier: Apache-2.0
"""Studies: many swims for one question."""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports

from eel_dynamics import STUDIES
from eel_studies.gradients.gradient import Gradient as Gradient
from eel_studies.gradients.gradient import gradient as gradient
from eel_studies.identification.fit import Identified as Identified
from eel_studies.identification.identify import identify as identify
from eel_studies.identification.measurements import MeasuredAngles as MeasuredAngles
from eel_studies.identification.measurements import MeasuredPath as MeasuredPath
from eel_studies.identification.measurements import MeasuredSpeed as MeasuredSpeed
from eel_studies.optimisation.front import Front as Front
from eel_studies.optimisation.optimise import optimise as optimise
from eel_studies.scene_terms.study import Terms as Terms
from eel_studies.scene_terms.study import terms as terms
from eel_studies.steering.linearisation import PeriodicLinearisation as PeriodicLinearisation
from eel_studies.steering.linearisation import periodic_linearisation as periodic_linearisation
from eel_studies.sweeps.sweep import sweep as sweep

__all__ = [*STUDIES]
