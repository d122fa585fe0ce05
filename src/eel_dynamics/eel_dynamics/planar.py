"""The mechanics of one instant in the plane: one angle in place of a rotation, three degrees of freedom in place of
six.

The same momentum form as in the kernel, for yaw alone: t1 = (cos, sin) of the turning angle, which is the integral of
K3 and so a sum of tabulated rows, as its rate is. The fields' components out of the plane stay zero.
"""

import numpy as np

from .compiled import inlined
from .drag import AXIAL, NOISE, ONE, SIDE, ZERO, find_steps, rub
from .drive import cosine_and_sine, factors
from .lanes import WIDTH, put, signed, spread, take, total

YAW = 1


@inlined
def integrate_plane(upto, f, result_f, g, result_g):
    """Integrals of rows 0 and 1 of `f` and of `g` from the nose to each node, at once."""
    for k in range(len(upto.source)):
        node = upto.source[k]
        begin = upto.start[k]
        a = b = c = d = spread(0.0)
        for j in range(upto.sources[k]):
            column = take(upto.columns, begin + j, 0)
            a += f[0, node + j] * column
            b += f[1, node + j] * column
            c += g[0, node + j] * column
            d += g[1, node + j] * column
        if node > ZERO:
            last = node - ONE
            a, b, c, d = a + result_f[0, last], b + result_f[1, last], c + result_g[0, last], d + result_g[1, last]
        put(result_f, 0, WIDTH * k, a)
        put(result_f, 1, WIDTH * k, b)
        put(result_g, 0, WIDTH * k, c)
        put(result_g, 1, WIDTH * k, d)


@inlined
def configure_plane(swimmer, drive, fields):
    """Configuration and shape velocities: t1, t2 into `R`, positions, the sections' turning rate, velocities."""
    R, r, omega, v, f = fields.R, fields.r, fields.omega, fields.v, fields.integrand
    for k in range(swimmer.blocks):
        i = WIDTH * k
        angle = turning = spread(0.0)
        for m in range(len(drive.axis)):
            if drive.axis[m] == YAW:
                row = take(drive.angle, m, i)
                angle += fields.factor[0, m] * row
                turning += fields.factor[1, m] * row
        c, s = cosine_and_sine(angle)
        put(R, 0, i, c)
        put(R, 1, i, s)
        put(omega, 2, i, turning)
        put(f, 0, i, -turning * s)
        put(f, 1, i, turning * c)
    integrate_plane(swimmer.upto, R, r, f, v)


@inlined
def solve_plane(swimmer, fields, momentum, twist):
    """Twist (Omega3, V1, V2) of the head from the momentum (L3, P1, P2) of a configured body. False without positive
    inertia."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    sxx = sxy = syy = scx = scy = sw = slz = spx = spy = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        m, m2 = weight * take(swimmer.mass, i), weight * take(swimmer.added2, i)
        c, s, x, y = take(R, 0, i), take(R, 1, i), take(r, 0, i), take(r, 1, i)
        ixx, ixy, iyy = m + m2 * s * s, -m2 * s * c, m + m2 * c * c
        dx, dy = x * ixy - y * ixx, x * iyy - y * ixy
        sxx += ixx
        sxy += ixy
        syy += iyy
        scx += dx
        scy += dy
        j = weight * take(swimmer.inertia3, i)
        sw += j + x * dy - y * dx
        vx, vy = take(v, 0, i), take(v, 1, i)
        spx += ixx * vx + ixy * vy
        spy += ixy * vx + iyy * vy
        slz += j * take(omega, 2, i) + dx * vx + dy * vy
    xx, xy, yy, cx, cy, w = total(sxx), total(sxy), total(syy), total(scx), total(scy), total(sw)
    xx += swimmer.nose_mass
    # eliminate V1, then V2
    a, b, e = momentum[0] - total(slz), momentum[1] - total(spx), momentum[2] - total(spy)
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
    R, r, omega, v, speed = fields.R, fields.r, fields.omega, fields.v, fields.speed
    for k in range(swimmer.blocks):
        i = WIDTH * k
        put(omega, 2, i, take(omega, 2, i) + twist[0])
        vx = take(v, 0, i) + (twist[1] - twist[0] * take(r, 1, i))
        vy = take(v, 1, i) + (twist[2] + twist[0] * take(r, 0, i))
        put(v, 0, i, vx)
        put(v, 1, i, vy)
        c, s = take(R, 0, i), take(R, 1, i)
        put(speed, AXIAL, i, c * vx + s * vy)
        put(speed, SIDE, i, c * vy - s * vx)
    tail = len(swimmer.x) - 1
    c, s = R[0, tail], R[1, tail]
    v1, v2 = speed[AXIAL, tail], speed[SIDE, tail]
    p2 = swimmer.added2[tail] * v2
    n1, n2 = -0.5 * swimmer.wake * p2 * v2, swimmer.wake * v1 * p2
    fx, fy = c * n1 - s * n2, s * n1 + c * n2
    tz = r[0, tail] * fy - r[1, tail] * fx
    if swimmer.resistive:
        share = fields.share
        rub(swimmer, fields)
        for k in range(swimmer.blocks):
            i = WIDTH * k
            weight = take(swimmer.weight, i)
            put(share, 0, i, weight * take(fields.part, i))
            put(share, SIDE, i, signed(weight, take(speed, SIDE, i)))
        fields.kinks.number[0] = 0
        find_steps(swimmer, fields, (twist[2], 0.0, 0.0), NOISE * (abs(v1) + abs(v2)), 0.0, True)
        sx = sy = sz = spread(0.0)
        for k in range(swimmer.blocks):
            i = WIDTH * k
            c, s = take(R, 0, i), take(R, 1, i)
            v1, v2 = take(speed, AXIAL, i), take(speed, SIDE, i)
            rubbing = take(swimmer.weight, i) * take(fields.rubbing, 0, i)
            n1 = -(rubbing + take(share, 0, i) * take(fields.rubbing, 1, i)) * v1
            n2 = -take(share, SIDE, i) * take(swimmer.drag2, i) * v2 * v2
            nx, ny = c * n1 - s * n2, s * n1 + c * n2
            sx += nx
            sy += ny
            sz += take(r, 0, i) * ny - take(r, 1, i) * nx
        fx += total(sx)
        fy += total(sy)
        tz += total(sz)
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
