# SPDX-License-Identifier: Apache-2.0
"""Powers along the body of a run: of the actuators, from its internal torque, and of each kind of drag."""

import numpy as np
from eel_common.attitude import world_from_body

import eel_core
from eel_dynamics.curvature.law_follower import LawFollower
from eel_dynamics.model.axes import REP103
from eel_dynamics.simulation.bending.modes_on_grid import ModesOnGrid, motion_of_run
from eel_dynamics.simulation.discretisation import discretise


def power_density(run) -> np.ndarray:
    """Power of the actuators per length, -C . dK/dt (T, M) [W/m], at the stations of `run`.

    `ValueError` unless the stations reach from nose to tail.
    """
    length = run.body.length
    if len(run.x) < 2 or run.x[0] > 1e-9 * length or run.x[-1] < (1.0 - 1e-9) * length:
        raise ValueError(f"run must have stations from 0 to {length:g} m, got {run.x[0]:g} to {run.x[-1]:g} m")
    return -np.einsum("tmk,tmk->tm", torque_of(run), run.curvature_rate)


def torque_of(run) -> np.ndarray:
    """The internal torque (T, M, 3) [N m] of `run`. `ValueError` without one."""
    if run.torque is None:
        raise ValueError("torque needs a run with scene internal_wrench on")
    return run.torque


def drag_powers(run) -> np.ndarray:
    """Powers (T, 6) [W] of the drag along the body at each sample of `run`.

    Columns: forces along section axes 1 (friction, k1 of section 7.2.1), 2 and 3 (cross flow), the torque about axis 1,
    the drag of a robot's links (k5), and that of a blunt tail's base. Positive is into the body, so none is positive.
    They are evaluated from the law, or a robot's joints, and the head's motion, at the nodes of a simulation with the
    run's settings; their sum is the ledger's `drag_power`.
    """
    run = run.in_axes(REP103)
    swimmer = run.swimmer_at(0, run.x[:1], run.accuracy.as_it_is()).unchecked(fins=())  # fins have their own drag
    here = discretise(swimmer, swimmer.grid_for(swimmer.shape_needs(run.law)))
    instant, powers = eel_core.Instant(here.swimmer), np.zeros((len(run.time), 6))
    time, relative = np.ascontiguousarray(run.time), run.twist.copy()
    if swimmer.current.any():
        relative[:, 3:] -= swimmer.current @ world_from_body(run.orientation)
    water = swimmer.current, swimmer.core_flow
    poses = np.concatenate([run.position, run.orientation], axis=1)
    robot, motion = None, np.zeros((len(time), 2, 0))
    if swimmer.modes is not None:
        robot, motion = ModesOnGrid(swimmer.modes, here.grid, here.tabulation), motion_of_run(run, swimmer.modes)
    follower, now, begin = LawFollower(here.tabulation, law=run.law), 0.0, 0
    while begin < len(time):  # once for a law in closed form, and for each row of a `SampledLaw`
        follower.pass_events(now, now := float(time[begin]))
        end = max(begin + 1, int(np.searchsorted(time, follower.next_event(now), side="right")))
        part = slice(begin, end)
        law = follower.law_on_grid if robot is None else robot.law(follower, here.tabulation)[0]
        instant.drag_powers(law, time[part], relative[part], powers[part], *water, poses[part], motion[part])
        begin = end
    return powers


def area(values: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Integral of `values` (..., n) over `x` (n,), by the trapezoidal rule."""
    return 0.5 * ((values[..., 1:] + values[..., :-1]) @ np.diff(x))
