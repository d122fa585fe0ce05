"""The mechanics of one instant in the plane: one angle in place of a rotation, three degrees of freedom in place of
six.

The same momentum form as in the kernel, for yaw alone: t1 = (cos, sin) of the turning angle, which is the integral of
K3 and so a sum of tabulated rows, as its rate is. The fields' components out of the plane stay zero.
"""

import numpy as np

from .compiled import inlined
from .drag import NOISE, rub
from .drive import cosine_and_sine, factors
from .kernel import integrate_along
from .kinks import AXIAL, ONE, SIDE, ZERO, find_steps, integrate_steps
from .lanes import WIDTH, put, signed, size, spread, take, total

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
def sums_plane(swimmer, fields):
    """Of body and water about the head, the nose's m_o not in it, each as lanes that are still to be added up: inertia
    along axes 1 and 2 (xx, xy, yy), what couples them to the turn (cx, cy), that of the turn (w), and the momentum
    (L3, P1, P2) of the change of shape."""
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
    return sxx, sxy, syy, scx, scy, sw, slz, spx, spy


@inlined
def factors_plane(xx, xy, yy, cx, cy, w):
    """Factors (6,) of the inertia = L D L^T, with V1 eliminated first, then V2: 1/D and L."""
    by_xx = 1.0 / xx
    p, q = xy * by_xx, cx * by_xx
    yy = yy - p * xy
    cy = cy - p * cx
    by_yy = 1.0 / yy
    t = cy * by_yy
    w = w - (q * cx + t * cy)
    return by_xx, by_yy, 1.0 / w, p, q, t


@inlined
def solved_plane(f, b0, b1, b2):
    """Solution (3,) with the factors `f` for the right side (angular, along axes 1 and 2)."""
    by_xx, by_yy, by_w, p, q, t = f
    b2 = b2 - p * b1
    b0 = (b0 - q * b1 - t * b2) * by_w
    b2 = b2 * by_yy - t * b0
    return b0, b1 * by_xx - p * b2 - q * b0, b2


@inlined
def twist_plane(swimmer, fields, momentum, twist):
    """Twist (Omega3, V1, V2) of the head from the momentum (L3, P1, P2) of a configured body. False without positive
    inertia. Leaves the inertia's factors in `fields.inertia`."""
    sxx, sxy, syy, scx, scy, sw, slz, spx, spy = sums_plane(swimmer, fields)
    f = factors_plane(total(sxx) + swimmer.nose_mass, total(sxy), total(syy), total(scx), total(scy), total(sw))
    kept = fields.inertia
    kept[0, 0], kept[1, 1], kept[2, 2], kept[1, 0], kept[2, 0], kept[2, 1] = f
    twist[0], twist[1], twist[2] = solved_plane(
        f, momentum[0] - total(slz), momentum[1] - total(spx), momentum[2] - total(spy)
    )
    return 0.0 < f[0] < np.inf and 0.0 < f[1] < np.inf and 0.0 < f[2] < np.inf


@inlined
def solve_plane(f, b):
    """Solve with the factors that `twist_plane` has kept for the right side `b` (3,), in place."""
    kept = f[0, 0], f[1, 1], f[2, 2], f[1, 0], f[2, 0], f[2, 1]
    b[0], b[1], b[2] = solved_plane(kept, b[0], b[1], b[2])


@inlined
def add_head_twist_plane(swimmer, fields, twist):
    """Add the motion of the head, `twist` (Omega3, V1, V2), to the velocities due to the change of shape, with the
    sections' speeds."""
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


@inlined
def wake_plane(momentum_per_speed, c, s, x, y, v1, v2):
    """Wrench (T3, F1, F2) of the wake about the head of a tail of that added mass (0 without a wake), direction,
    position and speeds, and T_f there. Of one tail, or of eight."""
    p2 = momentum_per_speed * v2
    n1, n2 = -0.5 * p2 * v2, v1 * p2
    fx, fy = c * n1 - s * n2, s * n1 + c * n2
    return x * fy - y * fx, fx, fy, -n1


@inlined
def share_loads_plane(swimmer, fields):
    """As `drag.share_loads`."""
    rub(swimmer, fields)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        put(fields.share, 0, i, weight * take(fields.part, i))
        put(fields.share, SIDE, i, signed(weight, take(fields.speed, SIDE, i)))


@inlined
def resistive_sums_plane(swimmer, fields):
    """Wrench (T3, F1, F2) of the drag along the body about the head, and its power [W], each as lanes that are still to
    be added up."""
    R, r, speed, share = fields.R, fields.r, fields.speed, fields.share
    sx = sy = sz = power = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        c, s = take(R, 0, i), take(R, 1, i)
        u1, u2 = take(speed, AXIAL, i), take(speed, SIDE, i)
        rubbing = take(swimmer.weight, i) * take(fields.rubbing, 0, i)
        f1 = -(rubbing + take(share, 0, i) * take(fields.rubbing, 1, i)) * u1
        f2 = -take(share, SIDE, i) * take(swimmer.drag2, i) * u2 * u2
        nx, ny = c * f1 - s * f2, s * f1 + c * f2
        sx += nx
        sy += ny
        sz += take(r, 0, i) * ny - take(r, 1, i) * nx
        power += f1 * u1 + f2 * u2
    return sz, sx, sy, power


@inlined
def loads_plane(swimmer, fields, twist):
    """Loads (T3, F1, F2) of wake and drag along the body about the head, into `tail[2:5]` and `drag[2:5]`, with
    `losses`; adds the head's `twist` to the velocities."""
    add_head_twist_plane(swimmer, fields, twist)
    R, r, speed, loads = fields.R, fields.r, fields.speed, fields.tail
    tail = len(swimmer.x) - 1
    v1, v2 = speed[AXIAL, tail], speed[SIDE, tail]
    loads[2], loads[3], loads[4], energy = wake_plane(
        *(swimmer.wake * swimmer.added2[tail], R[0, tail], R[1, tail], r[0, tail], r[1, tail], v1, v2)
    )
    fields.losses[0], fields.losses[1], fields.losses[2] = 0.0, v1, energy
    fields.drag[2] = fields.drag[3] = fields.drag[4] = 0.0
    fields.kinks.number[0] = 0
    if swimmer.resistive:
        share_loads_plane(swimmer, fields)
        find_steps(swimmer, fields, (twist[2], 0.0, 0.0), NOISE * (abs(v1) + abs(v2)), 0.0, True)
        sz, sx, sy, power = resistive_sums_plane(swimmer, fields)
        fields.drag[2], fields.drag[3], fields.drag[4] = total(sz), total(sx), total(sy)
        fields.losses[0] = total(power)


@inlined
def heading(z, w):
    """Cosine and sine of the head's turn about axis 3, by its quaternion (0, 0, z, w)."""
    square = z * z + w * w
    return (w * w - z * z) / square, 2.0 * z * w / square


@inlined
def move_plane(swimmer, drive, fields, time, y, momentum, twist):
    """Velocities and loads in state `y` at `time`, into `fields` and `twist` (Omega3, V1, V2); its `momentum` (L3, P1,
    P2) in the head's axes. False where the inertia is singular."""
    cosine, sine = heading(y[5], y[6])
    momentum[0] = y[9]
    momentum[1], momentum[2] = cosine * y[10] + sine * y[11], -sine * y[10] + cosine * y[11]
    factors(drive, time, fields.factor)
    configure_plane(swimmer, drive, fields)
    if not twist_plane(swimmer, fields, momentum, twist):
        return False
    loads_plane(swimmer, fields, twist)
    return True


@inlined
def rate_of_state_plane(swimmer, drive, fields, current, time, y, step, dy):
    """As `rate_of_state` of `rates`, for a state in the plane: rate `dy` (13,) of state `y` at `time`."""
    momentum, twist = step.momentum, step.twist
    if not move_plane(swimmer, drive, fields, time, y, momentum, twist):
        return False
    cosine, sine = heading(y[5], y[6])
    tail, drag = fields.tail, fields.drag
    for k in range(13):
        dy[k] = 0.0
    dy[0], dy[1], dy[5], dy[6], dy[9], dy[10], dy[11] = rates_of_plane(
        *(swimmer, cosine, sine, y[5], y[6], tail[2] + drag[2], tail[3] + drag[3], tail[4] + drag[4]),
        *(momentum[1], momentum[2], twist[0], twist[1], twist[2]),
    )
    dy[0], dy[1], dy[2] = dy[0] + current[0], dy[1] + current[1], current[2]
    return True


@inlined
def rates_of_plane(swimmer, cosine, sine, z, w, torque, fx, fy, px, py, turn, vx, vy):
    """Rates of position (2), quaternion (2), angular (1) and linear (2) momentum, in the world's axes and without the
    current, from the loads, the linear momentum and the twist, in the head's. Of one swimmer, or of eight."""
    nose = swimmer.nose_mass
    fx = fx + nose * turn * vy - swimmer.nose_drag * vx * size(vx)
    fy = fy + nose * vx * turn
    return (
        *(cosine * vx - sine * vy, sine * vx + cosine * vy),
        *(0.5 * w * turn, -0.5 * z * turn),
        torque - vx * py + vy * (px - nose * vx),
        *(cosine * fx - sine * fy, sine * fx + cosine * fy),
    )


@inlined
def densities_plane(swimmer, fields, balance, result):
    """What the motion of the sections takes, (T3, F1, F2) per length about the head, into rows 2 to 4 of `density`;
    their integrals over the body into `result[0:3]`."""
    R, r, speed, density = fields.R, fields.r, fields.speed, balance.density
    st = sx = sy = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        c, s, x, y = take(R, 0, i), take(R, 1, i), take(r, 0, i), take(r, 1, i)
        ax, ay, turn = take(balance.acc, 0, i), take(balance.acc, 1, i), take(fields.omega, 2, i)
        u1, u2 = take(speed, AXIAL, i), take(speed, SIDE, i)
        m, added = take(swimmer.mass, i), take(swimmer.added2, i)
        f1 = m * (c * ax + s * ay) - added * turn * u2
        f2 = m * (c * ay - s * ax) + added * (c * ay - s * ax - turn * u1)
        hx, hy = c * f1 - s * f2, s * f1 + c * f2
        torque = take(swimmer.inertia3, i) * take(balance.alpha, 2, i) + added * u1 * u2 + x * hy - y * hx
        put(density, 2, i, torque)
        put(density, 3, i, hx)
        put(density, 4, i, hy)
        weight = take(swimmer.weight, i)
        st += weight * torque
        sx += weight * hx
        sy += weight * hy
    result[0], result[1], result[2] = total(st), total(sx), total(sy)


@inlined
def powers_plane(swimmer, drive, fields, balance, twist, power):
    """Powers (4,) [W] of actuators, wake, nose and drag, as `powers_here` of `rates`, after `move_plane`."""
    R, r, omega, speed, f = fields.R, fields.r, fields.omega, fields.speed, fields.integrand
    alpha, acc, head, whole, density = balance.alpha, balance.acc, balance.head, balance.total, balance.density
    for k in range(swimmer.blocks):
        i = WIDTH * k
        gain = rate = spread(0.0)
        for m in range(len(drive.axis)):
            if drive.axis[m] == YAW:
                gain += fields.factor[2, m] * take(drive.angle, m, i)
                rate += fields.factor[1, m] * take(drive.node, m, i)
        put(alpha, 2, i, gain)
        put(fields.rate, 1, i, rate)
        c, s, turn = take(R, 0, i), take(R, 1, i), take(omega, 2, i)
        put(f, 0, i, -gain * s - turn * turn * c)
        put(f, 1, i, gain * c - turn * turn * s)
        put(R, 3, i, -s)
        put(R, 4, i, c)
    integrate_along(swimmer, f, 0, acc)
    densities_plane(swimmer, fields, balance, whole)
    nose_drag = -swimmer.nose_drag * twist[1] * abs(twist[1])
    for k in range(3):
        head[k] = fields.tail[2 + k] + fields.drag[2 + k] - whole[k]
    head[1] += nose_drag
    solve_plane(fields.inertia, head)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        put(alpha, 2, i, take(alpha, 2, i) + head[0])
        put(acc, 0, i, take(acc, 0, i) + (head[1] - head[0] * take(r, 1, i)))
        put(acc, 1, i, take(acc, 1, i) + (head[2] + head[0] * take(r, 0, i)))
    densities_plane(swimmer, fields, balance, whole)
    for k in range(swimmer.blocks if swimmer.resistive else 0):
        i = WIDTH * k
        c, s, u1, u2 = take(R, 0, i), take(R, 1, i), take(speed, AXIAL, i), take(speed, SIDE, i)
        n1 = (take(fields.rubbing, 0, i) + take(fields.part, i) * take(fields.rubbing, 1, i)) * u1
        n2 = take(swimmer.drag2, i) * size(u2) * u2
        nx, ny = c * n1 - s * n2, s * n1 + c * n2
        put(density, 2, i, take(density, 2, i) + (take(r, 0, i) * ny - take(r, 1, i) * nx))
        put(density, 3, i, take(density, 3, i) + nx)
        put(density, 4, i, take(density, 4, i) + ny)
    integrate_steps(swimmer, fields, swimmer.upto, density, balance.upto, balance.upto)
    bt, bx, by = (
        fields.tail[2] + fields.drag[2] - whole[0],
        fields.tail[3] + fields.drag[3] - whole[1],
        fields.tail[4] + fields.drag[4] - whole[2],
    )
    done = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        nx, ny = take(balance.upto, 3, i) + bx, take(balance.upto, 4, i) + by
        torque = take(balance.upto, 2, i) + bt - (take(r, 0, i) * ny - take(r, 1, i) * nx)
        done -= take(swimmer.weight, i) * torque * take(fields.rate, 1, i)
    power[0] = total(done)
    power[1] = fields.losses[1] * fields.losses[2]
    power[2] = (nose_drag - swimmer.nose_mass * head[1]) * twist[1]
    power[3] = fields.losses[0]
