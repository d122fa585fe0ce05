# SPDX-License-Identifier: Apache-2.0
"""Dynamics of an elongated swimmer in three dimensions, after Boyer, Porez and Leroyer (2010).

Studies of many swims (`sweep`, `optimise`, `identify`, `gradient` and others) are in `eel_studies`.
"""

import eel_command  # noqa: F401  first: Ctrl-C ends a command during the other imports

from eel_dynamics import model
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.analysis.settling import Unsettled
from eel_dynamics.analysis.trim import Ballast, Trim, ballast_for, trim_of
from eel_dynamics.batches.batch import Batch
from eel_dynamics.batches.simulate_batch import simulate_batch
from eel_dynamics.model import *  # noqa: F403  the swimmer and its water
from eel_dynamics.runs.exchange.recorded_sensors import readings_from_bag
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.scene_file import load_scene, save_scene
from eel_dynamics.runs.simulate import simulate
from eel_dynamics.runs.swim import Swim
from eel_dynamics.sensors.encoders import Encoders
from eel_dynamics.sensors.imu import Imu
from eel_dynamics.sensors.pressure import Pressure
from eel_dynamics.sensors.suite import SensorSuite
from eel_dynamics.sensors.velocity import Velocity
from eel_dynamics.simulation.energy import EnergyLedger
from eel_dynamics.simulation.observations import Snapshot
from eel_dynamics.simulation.prescribed import HydrodynamicWrench, hydrodynamic_wrench
from eel_dynamics.simulation.simulation import Simulation
from eel_dynamics.simulation.stopping import SimulationStopped
from eel_dynamics.simulation.swimmer import Swimmer

__all__ = [
    "Accuracy",
    "Ballast",
    "Batch",
    "Encoders",
    "EnergyLedger",
    "HydrodynamicWrench",
    "Imu",
    "Pressure",
    "Run",
    "SensorSuite",
    "Simulation",
    "SimulationStopped",
    "Snapshot",
    "Swim",
    "Swimmer",
    "Trim",
    "Unsettled",
    "Velocity",
    "ballast_for",
    "hydrodynamic_wrench",
    "load_scene",
    "readings_from_bag",
    "save_scene",
    "simulate",
    "simulate_batch",
    "trim_of",
]
__all__ += model.__all__
