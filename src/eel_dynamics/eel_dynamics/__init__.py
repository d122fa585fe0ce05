"""Dynamics of an elongated swimmer in three dimensions, after Boyer, Porez and Leroyer (2010)."""

from .accuracy import Accuracy
from .body import Body
from .scene import Scene
from .simulation import Simulation, SimulationStopped

__all__ = ["Accuracy", "Body", "Scene", "Simulation", "SimulationStopped"]
