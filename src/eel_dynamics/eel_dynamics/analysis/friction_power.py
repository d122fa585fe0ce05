# SPDX-License-Identifier: Apache-2.0
"""Power of the axial friction, k1 of section 7.2.1, apart from the rest of the drag."""

import numpy as np
from eel_base.attitude import world_from_body

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.simulation.simulation import Simulation


def drag_powers(run) -> np.ndarray:
    """Powers (T, 4) [W] of the drag along the body at each sample of `run`.

    Columns: forces along section axes 1 (friction), 2 and 3 (cross flow), and the torque about axis 1. Positive is into
    the body, so none is positive. They are evaluated from the law and the head's motion, at the nodes of a simulation
    with the run's settings; their sum is the ledger's `drag_power`.
    """
    simulation = Simulation(body=run.body, scene=run.scene, accuracy=run.accuracy.as_it_is(), stations=2, law=run.law)
    follower, now = LawFollower(simulation.discretisation.tabulation, law=run.law), 0.0
    instant, powers = eel_core.Instant(simulation.discretisation.swimmer), np.zeros((len(run.time), 4))
    relative = run.twist.copy()
    relative[:, 3:] -= np.asarray(run.scene.current) @ world_from_body(run.orientation)
    for sample, time in enumerate(run.time.tolist()):
        follower.pass_events(now, now := time)
        powers[sample] = instant.drag_powers(follower.tabulated_law, time, relative[sample])
    return powers
