"""The mechanics of one instant in the plane: one angle in place of a rotation, three degrees of freedom in place of
six.

The same momentum form as in the kernel, for yaw alone: t1 = (cos, sin) of the turning angle, which is the integral of
K3 and so a sum of tabulated rows, as its rate is. The fields' components out of the plane stay zero.
"""

import math

import numpy as np

from .compiled import inlined
from .drag import AXIAL, NOISE, ONE, PRINTED, RATIO, SIDE, ZERO, find_steps, rub
from .drive import factors

PI_1, PI_2 = 1.5707963267341256, 6.077100506506192e-11  # pi/2 in two parts, the first with trailing zeros
YAW = 1


@inlined
def cosine_and_sine(angle, cosine, sine):
    """Of each `angle` (n,) [rad], to round-off for angles below 1e5; without branches, so that it runs on vectors."""
    for i in range(len(angle)):
        quarter = np.floor(angle[i] * (2.0 / np.pi) + 0.5)
        x = (angle[i] - quarter * PI_1) - quarter * PI_2
        z = x * x
        s = x * (
            1.0
            - z
            / 6.0
            * (
                1.0
                - z
                / 20.0
                * (1.0 - z / 42.0 * (1.0 - z / 72.0 * (1.0 - z / 110.0 * (1.0 - z / 156.0 * (1.0 - z / 210.0)))))
            )
        )
        c = 1.0 - z / 2.0 * (
            1.0
            - z
            / 12.0
            * (
                1.0
                - z
                / 30.0
                * (1.0 - z / 56.0 * (1.0 - z / 90.0 * (1.0 - z / 132.0 * (1.0 - z / 182.0 * (1.0 - z / 240.0)))))
            )
        )
        half = quarter - 2.0 * np.floor(0.5 * quarter)  # 1: a quarter turn to go
        sign = 1.0 - 2.0 * (np.floor(0.5 * quarter) - 2.0 * np.floor(0.25 * quarter))  # -1: half a turn to go
        cosine[i] = sign * (c - half * (c + s))
        sine[i] = sign * (s + half * (c - s))


@inlined
def integrate_plane(swimmer, integrand, result):
    """Integral of rows 0 and 1 of the `integrand` from the nose to each node."""
    matrix, first, count = swimmer.matrix, swimmer.first, swimmer.count
    for i in range(matrix.shape[0]):
        begin = first[i]
        x = y = 0.0
        if begin > ZERO:
            x, y = result[0, begin - ONE], result[1, begin - ONE]
        for j in range(count[i]):
            weight, node = matrix[i, j], begin + j
            x += weight * integrand[0, node]
            y += weight * integrand[1, node]
        result[0, i], result[1, i] = x, y


@inlined
def configure_plane(swimmer, drive, fields):
    """Configuration and shape velocities: t1, t2 into `R`, positions, the sections' turning rate, velocities."""
    R, r, omega, v, f = fields.R, fields.r, fields.omega, fields.v, fields.integrand
    n = R.shape[1]
    for i in range(n):
        f[2, i] = 0.0
        omega[2, i] = 0.0
    for m in range(len(drive.axis)):
        if drive.axis[m] == YAW:
            value, rate = fields.factor[0, m], fields.factor[1, m]
            for i in range(n):
                f[2, i] += value * drive.angle[m, i]
                omega[2, i] += rate * drive.angle[m, i]
    cosine_and_sine(f[2], R[0], R[1])
    integrate_plane(swimmer, R, r)
    for i in range(n):
        f[0, i] = -omega[2, i] * R[1, i]
        f[1, i] = omega[2, i] * R[0, i]
    integrate_plane(swimmer, f, v)


@inlined
def solve_plane(swimmer, fields, momentum, twist):
    """Twist (Omega3, V1, V2) of the head from the momentum (L3, P1, P2) of a configured body. False without positive
    inertia."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    xx = xy = yy = cx = cy = w = lz = px = py = 0.0
    for i in range(R.shape[1]):
        weight = swimmer.weight[i]
        m, m2, j = weight * swimmer.mass[i], weight * swimmer.added2[i], weight * swimmer.inertia3[i]
        c, s, x, y = R[0, i], R[1, i], r[0, i], r[1, i]
        ixx, ixy, iyy = m + m2 * s * s, -m2 * s * c, m + m2 * c * c
        dx, dy = x * ixy - y * ixx, x * iyy - y * ixy
        xx += ixx
        xy += ixy
        yy += iyy
        cx += dx
        cy += dy
        w += j + x * dy - y * dx
        px += ixx * v[0, i] + ixy * v[1, i]
        py += ixy * v[0, i] + iyy * v[1, i]
        lz += j * omega[2, i] + dx * v[0, i] + dy * v[1, i]
    xx += swimmer.nose_mass
    # eliminate V1, then V2
    a, b, e = momentum[0] - lz, momentum[1] - px, momentum[2] - py
    if not xx > 0.0:
        return False
    p, q = xy / xx, cx / xx
    yy -= p * xy
    cy -= p * cx
    w -= q * cx
    e -= p * b
    a -= q * b
    if not yy > 0.0:
        return False
    p = cy / yy
    w -= p * cy
    a -= p * e
    if not w > 0.0:
        return False
    twist[0] = a / w
    twist[2] = (e - cy * twist[0]) / yy
    twist[1] = (b - xy * twist[2] - cx * twist[0]) / xx
    return True


@inlined
def loads_plane(swimmer, fields, twist, rates):
    """Wrench (T3, F1, F2) of wake and drag along the body about the head; adds the head's `twist` to the velocities."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    n = R.shape[1]
    for i in range(n):
        omega[2, i] += twist[0]
        v[0, i] += twist[1] - twist[0] * r[1, i]
        v[1, i] += twist[2] + twist[0] * r[0, i]
    last = n - 1
    c, s = R[0, last], R[1, last]
    v1, v2 = c * v[0, last] + s * v[1, last], -s * v[0, last] + c * v[1, last]
    p2 = swimmer.added2[last] * v2
    n1, n2 = -0.5 * swimmer.wake * p2 * v2, swimmer.wake * v1 * p2
    fx, fy = c * n1 - s * n2, s * n1 + c * n2
    tz = r[0, last] * fy - r[1, last] * fx
    if swimmer.resistive:
        speed, share = fields.speed, fields.share
        for i in range(n):
            c, s = R[0, i], R[1, i]
            speed[AXIAL, i] = c * v[0, i] + s * v[1, i]
            speed[SIDE, i] = -s * v[0, i] + c * v[1, i]
        rub(swimmer, fields)
        for i in range(n):
            share[0, i] = swimmer.weight[i] * fields.part[i]
            share[SIDE, i] = math.copysign(swimmer.weight[i], speed[SIDE, i])
        fields.kinks.number[0] = 0
        find_steps(swimmer, fields, SIDE, twist[2], NOISE * (abs(speed[AXIAL, last]) + abs(speed[SIDE, last])))
        if swimmer.friction == PRINTED:
            find_steps(swimmer, fields, RATIO, -1.0, 0.0)
        for i in range(n):
            c, s, v1, v2 = R[0, i], R[1, i], speed[AXIAL, i], speed[SIDE, i]
            n1 = -(swimmer.weight[i] * fields.rubbing[0, i] + share[0, i] * fields.rubbing[1, i]) * v1
            n2 = -share[SIDE, i] * swimmer.drag2[i] * v2 * v2
            nx, ny = c * n1 - s * n2, s * n1 + c * n2
            fx += nx
            fy += ny
            tz += r[0, i] * ny - r[1, i] * nx
    rates[0], rates[1], rates[2] = tz, fx, fy


@inlined
def rate_of_state_plane(swimmer, drive, fields, current, time, y, step, dy):
    """As `rate_of_state` of the integrator, for a state in the plane: rate `dy` (13,) of state `y` at `time`."""
    momentum, twist, rates = step.momentum, step.twist, step.rates
    size = y[5] * y[5] + y[6] * y[6]
    cosine, sine = (y[6] * y[6] - y[5] * y[5]) / size, 2.0 * y[5] * y[6] / size
    momentum[0] = y[9]
    momentum[1], momentum[2] = cosine * y[10] + sine * y[11], -sine * y[10] + cosine * y[11]
    factors(drive, time, fields.factor)
    configure_plane(swimmer, drive, fields)
    if not solve_plane(swimmer, fields, momentum, twist):
        return False
    loads_plane(swimmer, fields, twist, rates)
    turn, vx, vy, nose = twist[0], twist[1], twist[2], swimmer.nose_mass
    fx = rates[1] + nose * turn * vy - swimmer.nose_drag * vx * abs(vx)
    fy = rates[2] + nose * vx * turn
    for k in range(13):
        dy[k] = 0.0
    dy[0], dy[1], dy[2] = cosine * vx - sine * vy + current[0], sine * vx + cosine * vy + current[1], current[2]
    dy[5], dy[6] = 0.5 * y[6] * turn, -0.5 * y[5] * turn
    dy[9] = rates[0] - vx * momentum[2] + vy * (momentum[1] - nose * vx)
    dy[10], dy[11] = cosine * fx - sine * fy, sine * fx + cosine * fy
    return True
