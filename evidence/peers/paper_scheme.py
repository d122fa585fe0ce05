# SPDX-License-Identifier: Apache-2.0
"""The paper's own numerical scheme (section 7.1 of Boyer, Porez and Leroyer 2010), as a competitor to measure against.

Fourth-order Runge-Kutta in time, and in each evaluation fourth-order Runge-Kutta along the body, from head to tail over
equal cells, of section twists and their rates in section axes,

    Q' = Q (0, K)/2     r' = R E1     Omega' = Kdot - K x Omega        V' = Omega x E1 - K x V
    Omegadot' = Kddot - K x Omegadot - Kdot x Omega        Vdot' = Omegadot x E1 - K x Vdot - Kdot x V

and of the head's inertia I_o and wrench F_o, which give the rate of the head's twist (G_ext). Once a step a second
sweep with the true rates integrates the balance (50) for the internal wrench (G_int). Written plainly, with the same
corrections of the formulae as the library, and compiled by numba. Cells and the curvature at all instants come
tabulated in the task (`against_paper_scheme.py`), which is not counted. No code of the library takes part.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from task import answer, read_task, timed

STATE = 46  # quaternion 4, r 3, Omega 3, V 3, Omegadot 3, Vdot 3, I_o 21, F_o 6
OPTIONS = {"cache": True, "fastmath": {"contract", "reassoc", "nsz", "arcp"}, "error_model": "numpy"}
TURN, SPIN, SPIN_RATE, INERTIA, WRENCH = 0, 7, 13, 19, 40  # where they begin


class Cells(NamedTuple):
    """Section data at ends and middles of n equal cells, (2 n + 1,) each, laminar friction."""

    width: float  # m, of a cell
    mass: np.ndarray  # kg/m
    added2: np.ndarray  # kg/m
    added3: np.ndarray  # kg/m
    inertia1: np.ndarray  # kg m, with the water's
    inertia2: np.ndarray  # kg m
    inertia3: np.ndarray  # kg m
    added_roll: np.ndarray  # kg m
    friction: np.ndarray  # force per length = -friction |V1|^(1/2) V1
    drag2: np.ndarray  # kg/m^2
    drag3: np.ndarray  # kg/m^2
    drag_roll: np.ndarray  # kg
    nose_mass: float  # kg
    nose_drag: float  # kg/m


def swim(cells: Cells, shapes: np.ndarray, step: float, wrench: bool = False):
    """Head's positions (T, 3) [m] at all steps, from rest, and the internal torque (T, n + 1, 3) [N m] if asked for."""
    steps = (len(shapes) - 1) // 2
    positions = np.zeros((steps + 1, 3))
    torque = np.zeros((steps + 1 if wrench else 1, (shapes.shape[1] + 1) // 2, 3))
    _march(cells, shapes, step, wrench, positions, torque)
    return positions, torque


@njit(**OPTIONS)
def _march(cells, shapes, step, wrench, positions, torque):
    steps = positions.shape[0] - 1
    state, trial, total = np.zeros(13), np.zeros(13), np.zeros(13)  # position, quaternion (w x y z), twist
    state[3] = 1.0
    work, rates = np.zeros((6, STATE)), np.zeros((4, 13))
    for n in range(steps + 1):
        _head_rate(cells, shapes[2 * n], state, rates[0], work)
        if wrench:
            _sweep(cells, shapes[2 * n], state[7:13], rates[0, 7:13], work, torque[n], True)
        positions[n] = state[:3]
        if n == steps:
            break
        for stage in range(1, 4):
            for i in range(13):
                trial[i] = state[i] + step * (1.0 if stage == 3 else 0.5) * rates[stage - 1, i]
            _head_rate(cells, shapes[2 * n + (2 if stage == 3 else 1)], trial, rates[stage], work)
        for i in range(13):
            total[i] = rates[0, i] + 2.0 * rates[1, i] + 2.0 * rates[2, i] + rates[3, i]
            state[i] += step / 6.0 * total[i]
        norm = np.sqrt(state[3] ** 2 + state[4] ** 2 + state[5] ** 2 + state[6] ** 2)
        for i in range(3, 7):
            state[i] /= norm


@njit(**OPTIONS)
def _head_rate(cells, shape, state, rate, work):
    """G_ext: rate (13,) of the head's position, quaternion and twist."""
    none = np.zeros((1, 3))
    still = np.zeros(6)
    _sweep(cells, shape, state[7:13], still, work, none, False)
    y = work[0]
    matrix, load = np.empty((6, 6)), np.empty(6)
    k = INERTIA
    for i in range(6):
        for j in range(i, 6):
            matrix[i, j] = y[k]
            matrix[j, i] = y[k]
            k += 1
    matrix[3, 3] += cells.nose_mass
    o1, o2, o3, v1, v2, v3 = state[7], state[8], state[9], state[10], state[11], state[12]
    for i in range(6):
        load[i] = -y[WRENCH + i]
    _add_wake(cells, y, load)
    load[3] -= cells.nose_drag * abs(v1) * v1 + cells.nose_mass * (o2 * v3 - o3 * v2)
    rate[7:13] = np.linalg.solve(matrix, load)
    w, x, yy, z = state[3], state[4], state[5], state[6]
    rate[0] = (1.0 - 2.0 * (yy * yy + z * z)) * v1 + 2.0 * (x * yy - w * z) * v2 + 2.0 * (x * z + w * yy) * v3
    rate[1] = 2.0 * (x * yy + w * z) * v1 + (1.0 - 2.0 * (x * x + z * z)) * v2 + 2.0 * (yy * z - w * x) * v3
    rate[2] = 2.0 * (x * z - w * yy) * v1 + 2.0 * (yy * z + w * x) * v2 + (1.0 - 2.0 * (x * x + yy * yy)) * v3
    rate[3] = -0.5 * (x * o1 + yy * o2 + z * o3)
    rate[4] = 0.5 * (w * o1 + yy * o3 - z * o2)
    rate[5] = 0.5 * (w * o2 + z * o1 - x * o3)
    rate[6] = 0.5 * (w * o3 + x * o2 - yy * o1)


@njit(**OPTIONS)
def _sweep(cells, shape, twist, twist_rate, work, torque, internal):
    """Runge-Kutta along the body from the head's twist and its rate; work[0] is the state at the tail. `internal`:
    G_int, with the torque at the ends of the cells."""
    y, trial = work[0], work[1]
    y[:] = 0.0
    y[TURN] = 1.0
    for i in range(6):
        y[SPIN + i] = twist[i]
        y[SPIN_RATE + i] = twist_rate[i]
    h = cells.width
    nose = 0.0
    if internal:
        true = twist_rate[3] + twist[1] * twist[5] - twist[2] * twist[4]
        nose = -cells.nose_drag * abs(twist[3]) * twist[3] - cells.nose_mass * true
    first = INERTIA if not internal else WRENCH  # G_int needs no inertia
    for cell in range(shape.shape[0] // 2):
        j = 2 * cell
        if internal:
            _torque_of(cells, j, y, nose, torque[cell])
        _slope(cells, j, shape[j], y, work[2], internal)
        for stage in range(1, 4):
            reach = h if stage == 3 else 0.5 * h
            for i in range(INERTIA):  # the rest are plain integrals
                trial[i] = y[i] + reach * work[1 + stage, i]
            at = j + 2 if stage == 3 else j + 1
            _slope(cells, at, shape[at], trial, work[2 + stage], internal)
        for i in range(INERTIA):
            y[i] += h / 6.0 * (work[2, i] + 2.0 * work[3, i] + 2.0 * work[4, i] + work[5, i])
        for i in range(first, STATE):
            y[i] += h / 6.0 * (work[2, i] + 2.0 * work[3, i] + 2.0 * work[4, i] + work[5, i])
    if internal:
        _torque_of(cells, shape.shape[0] - 1, y, nose, torque[shape.shape[0] // 2])


@njit(inline="always")
def _rotation(y):
    w, x, z, u = y[0], y[1], y[2], y[3]
    return (
        1.0 - 2.0 * (z * z + u * u),
        2.0 * (x * z + w * u),
        2.0 * (x * u - w * z),
        2.0 * (x * z - w * u),
        1.0 - 2.0 * (x * x + u * u),
        2.0 * (z * u + w * x),
        2.0 * (x * u + w * z),
        2.0 * (z * u - w * x),
        1.0 - 2.0 * (x * x + z * z),
    )  # columns t1, t2, t3


@njit(**OPTIONS)
def _slope(cells, j, shape, y, dy, internal):
    """Derivatives by X of the state `y` at the point j of the half grid, `shape` (6,) its curvature, rate,
    acceleration."""
    k2, k3, kr2, kr3, ka2, ka3 = shape[0], shape[1], shape[2], shape[3], shape[4], shape[5]
    o1, o2, o3, v1, v2, v3 = y[7], y[8], y[9], y[10], y[11], y[12]
    e1, e2, e3, d1, d2, d3 = y[13], y[14], y[15], y[16], y[17], y[18]
    dy[0] = -0.5 * (y[2] * k2 + y[3] * k3)
    dy[1] = 0.5 * (y[2] * k3 - y[3] * k2)
    dy[2] = 0.5 * (y[0] * k2 - y[1] * k3)
    dy[3] = 0.5 * (y[0] * k3 + y[1] * k2)
    ax, ay, az, bx, by, bz, cx, cy, cz = _rotation(y)
    dy[4], dy[5], dy[6] = ax, ay, az
    dy[7] = -(k2 * o3 - k3 * o2)
    dy[8] = kr2 - k3 * o1
    dy[9] = kr3 + k2 * o1
    dy[10] = -(k2 * v3 - k3 * v2)
    dy[11] = o3 - k3 * v1
    dy[12] = -o2 + k2 * v1
    dy[13] = -(k2 * e3 - k3 * e2) - (kr2 * o3 - kr3 * o2)
    dy[14] = ka2 - k3 * e1 - kr3 * o1
    dy[15] = ka3 + k2 * e1 + kr2 * o1
    dy[16] = -(k2 * d3 - k3 * d2) - (kr2 * v3 - kr3 * v2)
    dy[17] = e3 - k3 * d1 - kr3 * v1
    dy[18] = -e2 + k2 * d1 + kr2 * v1
    m1 = cells.mass[j]
    m2, m3 = m1 + cells.added2[j], m1 + cells.added3[j]
    j1, j2, j3 = cells.inertia1[j], cells.inertia2[j], cells.inertia3[j]
    p1, p2, p3, s1, s2, s3 = m1 * v1, m2 * v2, m3 * v3, j1 * o1, j2 * o2, j3 * o3
    f1 = m1 * d1 + o2 * p3 - o3 * p2 + cells.friction[j] * np.sqrt(abs(v1)) * v1
    f2 = m2 * d2 + o3 * p1 - o1 * p3 + cells.drag2[j] * abs(v2) * v2
    f3 = m3 * d3 + o1 * p2 - o2 * p1 + cells.drag3[j] * abs(v3) * v3
    g1 = j1 * e1 + o2 * s3 - o3 * s2 + v2 * p3 - v3 * p2 + cells.drag_roll[j] * abs(o1) * o1
    g2 = j2 * e2 + o3 * s1 - o1 * s3 + v3 * p1 - v1 * p3
    g3 = j3 * e3 + o1 * s2 - o2 * s1 + v1 * p2 - v2 * p1
    hx, hy, hz = ax * f1 + bx * f2 + cx * f3, ay * f1 + by * f2 + cy * f3, az * f1 + bz * f2 + cz * f3
    x, u, z = y[4], y[5], y[6]
    dy[40] = ax * g1 + bx * g2 + cx * g3 + u * hz - z * hy
    dy[41] = ay * g1 + by * g2 + cy * g3 + z * hx - x * hz
    dy[42] = az * g1 + bz * g2 + cz * g3 + x * hy - u * hx
    dy[43], dy[44], dy[45] = hx, hy, hz
    if internal:
        return
    mxx = m1 * ax * ax + m2 * bx * bx + m3 * cx * cx
    mxy = m1 * ax * ay + m2 * bx * by + m3 * cx * cy
    mxz = m1 * ax * az + m2 * bx * bz + m3 * cx * cz
    myy = m1 * ay * ay + m2 * by * by + m3 * cy * cy
    myz = m1 * ay * az + m2 * by * bz + m3 * cy * cz
    mzz = m1 * az * az + m2 * bz * bz + m3 * cz * cz
    # r x M: the momentum's moment for a velocity, (3, 3)
    b00, b01, b02 = u * mxz - z * mxy, u * myz - z * myy, u * mzz - z * myz
    b10, b11, b12 = z * mxx - x * mxz, z * mxy - x * myz, z * mxz - x * mzz
    b20, b21, b22 = x * mxy - u * mxx, x * myy - u * mxy, x * myz - u * mxz
    dy[19] = j1 * ax * ax + j2 * bx * bx + j3 * cx * cx + u * b02 - z * b01
    dy[20] = j1 * ax * ay + j2 * bx * by + j3 * cx * cy + z * b00 - x * b02
    dy[21] = j1 * ax * az + j2 * bx * bz + j3 * cx * cz + x * b01 - u * b00
    dy[22], dy[23], dy[24] = b00, b01, b02
    dy[25] = j1 * ay * ay + j2 * by * by + j3 * cy * cy + z * b10 - x * b12
    dy[26] = j1 * ay * az + j2 * by * bz + j3 * cy * cz + x * b11 - u * b10
    dy[27], dy[28], dy[29] = b10, b11, b12
    dy[30] = j1 * az * az + j2 * bz * bz + j3 * cz * cz + x * b21 - u * b20
    dy[31], dy[32], dy[33] = b20, b21, b22
    dy[34], dy[35], dy[36] = mxx, mxy, mxz
    dy[37], dy[38], dy[39] = myy, myz, mzz


@njit(**OPTIONS)
def _add_wake(cells, y, load):
    """Add what the tail gives to the wake, (60), about the head, to `load` (6,)."""
    o1, v1, v2, v3 = y[7], y[10], y[11], y[12]
    roll, p2, p3 = cells.added_roll[-1] * o1, cells.added2[-1] * v2, cells.added3[-1] * v3
    energy = 0.5 * (roll * o1 + p2 * v2 + p3 * v3)
    ax, ay, az, bx, by, bz, cx, cy, cz = _rotation(y)
    hx = -energy * ax + v1 * (bx * p2 + cx * p3)
    hy = -energy * ay + v1 * (by * p2 + cy * p3)
    hz = -energy * az + v1 * (bz * p2 + cz * p3)
    x, u, z = y[4], y[5], y[6]
    load[0] += v1 * roll * ax + u * hz - z * hy
    load[1] += v1 * roll * ay + z * hx - x * hz
    load[2] += v1 * roll * az + x * hy - u * hx
    load[3] += hx
    load[4] += hy
    load[5] += hz


@njit(**OPTIONS)
def _torque_of(cells, j, y, nose, torque):
    """Internal torque (3,) in section axes from the balance of the part ahead, `nose` [N] its load."""
    hx, hy, hz = y[43] - nose, y[44], y[45]
    x, u, z = y[4], y[5], y[6]
    gx, gy, gz = y[40] - (u * hz - z * hy), y[41] - (z * hx - x * hz), y[42] - (x * hy - u * hx)
    ax, ay, az, bx, by, bz, cx, cy, cz = _rotation(y)
    torque[0] = ax * gx + ay * gy + az * gz - y[10] * cells.added_roll[j] * y[7]
    torque[1] = bx * gx + by * gy + bz * gz
    torque[2] = cx * gx + cy * gy + cz * gz


def main() -> None:
    task = read_task()
    cells = Cells(**{name: task[name] for name in Cells._fields})
    arguments = cells, task["shapes"], task["step"], task["wrench"]
    swim(*arguments)  # compiles
    (positions, torque), seconds = timed(lambda: swim(*arguments), task["repeats"])
    answer(seconds, positions, position=positions.tolist(), torque=torque[:, :: task["every"]].tolist())


if __name__ == "__main__":
    main()
