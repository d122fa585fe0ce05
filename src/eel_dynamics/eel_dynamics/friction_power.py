"""Power of the axial friction, k1 of section 7.2.1, apart from the rest of the drag."""

import numpy as np

from .drag import add_resistive_loads
from .drive import factors
from .frames import matrix_of
from .kernel import add_head_twist, configure
from .simulation import Simulation


def drag_powers(run) -> np.ndarray:
    """Powers (T, 4) [W] of the drag along the body at each sample of `run`: of the forces along axes 1 (friction), 2
    and 3 (cross flow) of the sections, and of the torque about axis 1; all into the body, so none is positive.

    Evaluated anew at the nodes of a simulation with the settings of the run, from the law and the head's motion: their
    sum is the ledger's `drag_power`.
    """
    settings = run.accuracy.as_it_is()
    swimmer = Simulation(body=run.body, scene=run.scene, accuracy=settings, stations=2)
    swimmer.adopt(run.law)
    drive, fields, water = swimmer.drive, swimmer.fields, swimmer.swimmer
    powers = np.zeros((len(run.time), 4))
    if not water.resistive:
        return powers
    for sample, time in enumerate(run.time):
        factors(drive, float(time), fields.factor)
        configure(water, drive, fields)
        relative = run.twist[sample].copy()
        relative[3:] -= matrix_of(run.orientation[sample]).T @ run.scene.current
        add_head_twist(water, fields, relative)
        add_resistive_loads(water, fields, relative, np.zeros(6))
        v1, v2, v3, roll = fields.speed[:4]
        _, side, height, turning = fields.share
        powers[sample] = (
            -(water.weight * fields.rubbing[0] + fields.share[0] * fields.rubbing[1]) @ v1**2,
            -side @ (water.drag2 * v2**3),
            -height @ (water.drag3 * v3**3),
            -turning @ (water.drag_roll * roll**3),
        )
    return powers
