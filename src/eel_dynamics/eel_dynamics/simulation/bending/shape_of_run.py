# SPDX-License-Identifier: Apache-2.0
"""The curvature of a robot's run on the grid, from its joints and modes: for what is evaluated after the run."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from eel_model.robot.compiled import HINGE, ModeTable

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.curvature.tabulated_law import SEGMENT_AXES
from eel_dynamics.simulation.bending.modes_on_grid import RobotTables
from eel_dynamics.simulation.discretisation import Discretisation


def shapes_of_run(run: Any, table: ModeTable, here: Discretisation) -> Iterator[eel_core.LawOnGrid]:
    """For each sample of `run` a law whose curvature and rate at that time are the run's, on the grid `here`."""
    tabulation = here.tabulation
    tables = RobotTables.of(table, here.grid, tabulation)
    joints, sign = table.degree == HINGE, table.sign[table.degree == HINGE]
    motion = np.zeros((2, len(run.time), len(table)))  # coordinates, and their rates
    motion[0][:, joints], motion[1][:, joints] = run.joint_angle * sign, run.joint_rate * sign
    motion[0][:, ~joints], motion[1][:, ~joints] = run.mode_amplitude, run.mode_rate
    follower, now = LawFollower(tabulation, law=run.law), 0.0
    for sample, time in enumerate(run.time.tolist()):
        follower.pass_events(now, now := time)
        rows, axis = follower.rows()
        factors = np.array(follower.law_on_grid.factors(time))
        ends = np.zeros((2, 6, tabulation.width))  # for pitch and yaw: value, rate and acceleration at two instants
        for each in (0, 1):
            imposed, own = axis == each, table.axis - 1 == each
            for derivative in (0, 1):
                ends[each, derivative] = (
                    factors[derivative, imposed] @ rows[imposed] * tables.mask[each]
                    + motion[derivative, sample, own] @ tables.rows[own]
                )
        law_tables = tabulation.law_tables(ends.reshape(12, -1), SEGMENT_AXES)
        yield eel_core.LawOnGrid(law_tables, 0.0, [], (0, time, time + 1.0), None)
