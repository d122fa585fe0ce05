"""Power of the axial friction, k1 of section 7.2.1, apart from the rest of the drag."""

import numpy as np

from .drive import combine, combine_moments, factors
from .frames import matrix_of
from .kernel import add_head_twist, configure, rub
from .simulation import Simulation


def drag_powers(run) -> np.ndarray:
    """Powers (T, 4) [W] of the drag along the body at each sample of `run`: of the forces along axes 1 (friction), 2
    and 3 (cross flow) of the sections, and of the torque about axis 1; all into the body, so none is positive.

    Evaluated anew at the nodes of a simulation as fine as the run's, from the law and the head's motion: their sum is
    the ledger's `drag_power`.
    """
    swimmer = Simulation(body=run.body, scene=run.scene, accuracy=run.accuracy, stations=2)
    swimmer.adopt(run.law)
    drive, fields, water = swimmer.drive, swimmer.fields, swimmer.swimmer
    powers = np.zeros((len(run.time), 4))
    if not water.resistive:
        return powers
    for sample, time in enumerate(run.time):
        factors(drive, float(time), fields.factor)
        combine_moments(drive.axis, drive.bend, fields.factor[0], fields.bend)
        combine(drive.axis, drive.node, fields.factor[1], fields.rate)
        configure(water, fields)
        relative = run.twist[sample].copy()
        relative[3:] -= matrix_of(run.orientation[sample]).T @ run.scene.current
        add_head_twist(fields, relative)
        rub(water, fields)
        axes = fields.R.reshape(3, 3, -1)
        velocity = np.einsum("akn,kn->an", axes, fields.v)
        roll = np.sum(axes[0] * fields.omega, axis=0)
        densities = (
            fields.rubbing * velocity[0] ** 2,
            water.drag2 * np.abs(velocity[1]) ** 3,
            water.drag3 * np.abs(velocity[2]) ** 3,
            water.drag_roll * np.abs(roll) ** 3,
        )
        powers[sample] = [-float(water.weight @ density) for density in densities]
    return powers
