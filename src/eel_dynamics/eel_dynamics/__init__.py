# SPDX-License-Identifier: Apache-2.0
"""Dynamics of an elongated swimmer in three dimensions, after Boyer, Porez and Leroyer (2010)."""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.model.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.batch import Batch, simulate_batch
from eel_dynamics.runs.run import Run, simulate
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.measured_simulation import MeasuredSimulation
from eel_dynamics.simulation.prescribed import HydrodynamicWrench, hydrodynamic_wrench
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.snapshot import Snapshot
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.studies.gradients.gradient import Gradient, gradient
from eel_dynamics.studies.identify.identify import Identified, identify
from eel_dynamics.studies.identify.measurements import MeasuredPath, MeasuredSpeed
from eel_dynamics.studies.optimise.front import Front
from eel_dynamics.studies.optimise.optimise import optimise
from eel_dynamics.studies.steering.linearisation import PeriodicLinearisation, periodic_linearisation
from eel_dynamics.studies.sweep.sweep import sweep

__all__ = [
    "Accuracy",
    "Batch",
    "Body",
    "EnergyLedger",
    "Front",
    "Gradient",
    "HydrodynamicWrench",
    "Identified",
    "MeasuredPath",
    "MeasuredSimulation",
    "MeasuredSpeed",
    "PeriodicLinearisation",
    "Run",
    "Scene",
    "Simulation",
    "SimulationStopped",
    "Snapshot",
    "gradient",
    "hydrodynamic_wrench",
    "identify",
    "optimise",
    "periodic_linearisation",
    "simulate",
    "simulate_batch",
    "sweep",
]
