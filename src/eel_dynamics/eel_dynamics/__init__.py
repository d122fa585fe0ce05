"""Dynamics of an elongated swimmer in three dimensions, after Boyer, Porez and Leroyer (2010)."""

from .accuracy import Accuracy
from .batch import Batch, simulate_batch
from .body import Body
from .energy import EnergyLedger
from .prescribed import HydrodynamicWrench, hydrodynamic_wrench
from .run import Run, simulate
from .scene import Scene
from .simulation import Simulation
from .snapshot import Snapshot
from .stopping import SimulationStopped
from .sweeps import sweep

__all__ = [
    "Accuracy",
    "Batch",
    "Body",
    "EnergyLedger",
    "HydrodynamicWrench",
    "Run",
    "Scene",
    "Simulation",
    "SimulationStopped",
    "Snapshot",
    "hydrodynamic_wrench",
    "simulate",
    "simulate_batch",
    "sweep",
]
