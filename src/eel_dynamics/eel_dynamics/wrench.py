"""The acceleration form of the balance (60), and the internal wrench that follows from it (eq. 50), compiled.

    alpha' = R Kddot + omega x R Kdot        acc' = alpha x t1 + omega x (omega x t1)

are linear in the head's acceleration; the balance of the whole body gives that; the balance of the part behind a
section gives the wrench there. Same axes and conventions as in the kernel. The head's acceleration is the true one: of
the angular velocity and of the velocity of the nose, in the head's axes.
"""

from typing import NamedTuple

import numpy as np

from .compiled import inlined, shared
from .drag import add_resistance
from .kernel import add_head_motion, integrate_along
from .kinks import integrate_steps
from .lanes import WIDTH, spread, take, total, work_space
from .momentum import solve
from .vectors import bent, cross, dot, from_section, in_section, put_three, three


class Balance(NamedTuple):
    """Work space and result of one evaluation over n nodes."""

    alpha: np.ndarray  # (3, n) rad/s^2, angular acceleration of the sections
    acc: np.ndarray  # (3, n) m/s^2, acceleration of the sections
    density: np.ndarray  # (6, n) wrench per length that the motion takes less the loads, about the head
    upto: np.ndarray  # (6, n) its integral from the nose
    head: np.ndarray  # (6,) acceleration of the head
    total: np.ndarray  # (6,) integral over the body of what the motion takes less the loads
    powers: np.ndarray  # (4,) W: actuators, wake, nose, drag
    nose: np.ndarray  # (1,) N, load on the nose along t1(0)


def balance_of(nodes: int) -> Balance:
    """Work space for `nodes` nodes and those that fill it up."""
    return Balance(
        *work_space(((3,), (3,), (6,), (6,)), nodes),
        head=np.zeros(6),
        total=np.zeros(6),
        powers=np.zeros(4),
        nose=np.zeros(1),
    )


@inlined
def turning_gain(R, omega, rate, accel, i):
    """alpha' of eight sections from i on."""
    ax, ay, az = bent(R, accel, i)
    kx, ky, kz = bent(R, rate, i)
    ox, oy, oz = three(omega, 0, i)
    x, y, z = cross(ox, oy, oz, kx, ky, kz)
    return ax + x, ay + y, az + z


@inlined
def moving_gain(R, omega, alpha, i):
    """acc' of eight sections from i on."""
    ox, oy, oz = three(omega, 0, i)
    tx, ty, tz = three(R, 0, i)
    ax, ay, az = three(alpha, 0, i)
    along, square = dot(ox, oy, oz, tx, ty, tz), dot(ox, oy, oz, ox, oy, oz)
    x, y, z = cross(ax, ay, az, tx, ty, tz)
    return x + along * ox - square * tx, y + along * oy - square * ty, z + along * oz - square * tz


@shared
def shape_accelerations(swimmer, fields, balance):
    """Accelerations of the sections where the head has none: alpha and acc with zero at the nose."""
    R, omega, f, rate, accel = fields.R, fields.omega, fields.integrand, fields.rate, fields.accel
    alpha = balance.alpha
    for k in range(swimmer.blocks):
        i = WIDTH * k
        x, y, z = turning_gain(R, omega, rate, accel, i)
        put_three(f, 0, i, x, y, z)
    integrate_along(swimmer, f, 0, alpha)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        x, y, z = moving_gain(R, omega, alpha, i)
        put_three(f, 0, i, x, y, z)
    integrate_along(swimmer, f, 0, balance.acc)


@shared
def add_head_acceleration(swimmer, fields, balance):
    """Add the head's acceleration to the accelerations of the sections: the true ones."""
    add_head_motion(swimmer, fields.r, balance.head, balance.alpha, balance.acc)


@shared
def section_densities(swimmer, fields, balance):
    """What the section's motion takes, f_N = M Vdot + Omega x M V, f_C = J Omegadot + Omega x J Omega + V x M V, moved
    to the head, into `density` (6, n)."""
    R, r, omega, v, density = fields.R, fields.r, fields.omega, fields.v, balance.density
    for k in range(swimmer.blocks):
        i = WIDTH * k
        v1, v2, v3 = in_section(R, i, *three(v, 0, i))
        o1, o2, o3 = in_section(R, i, *three(omega, 0, i))
        d1, d2, d3 = in_section(R, i, *three(balance.acc, 0, i))
        e1, e2, e3 = in_section(R, i, *three(balance.alpha, 0, i))
        d1, d2, d3 = d1 - (o2 * v3 - o3 * v2), d2 - (o3 * v1 - o1 * v3), d3 - (o1 * v2 - o2 * v1)
        m1 = take(swimmer.mass, i)
        m2, m3 = m1 + take(swimmer.added2, i), m1 + take(swimmer.added3, i)
        j1, j2, j3 = take(swimmer.inertia1, i), take(swimmer.inertia2, i), take(swimmer.inertia3, i)
        p1, p2, p3 = m1 * v1, m2 * v2, m3 * v3
        s1, s2, s3 = j1 * o1, j2 * o2, j3 * o3
        f1 = m1 * d1 + (o2 * p3 - o3 * p2)
        f2 = m2 * d2 + (o3 * p1 - o1 * p3)
        f3 = m3 * d3 + (o1 * p2 - o2 * p1)
        g1 = j1 * e1 + (o2 * s3 - o3 * s2) + (v2 * p3 - v3 * p2)
        g2 = j2 * e2 + (o3 * s1 - o1 * s3) + (v3 * p1 - v1 * p3)
        g3 = j3 * e3 + (o1 * s2 - o2 * s1) + (v1 * p2 - v2 * p1)
        hx, hy, hz = from_section(R, i, f1, f2, f3)
        gx, gy, gz = from_section(R, i, g1, g2, g3)
        x, y, z = three(r, 0, i)
        ux, uy, uz = cross(x, y, z, hx, hy, hz)
        put_three(density, 0, i, gx + ux, gy + uy, gz + uz)
        put_three(density, 3, i, hx, hy, hz)


@shared
def gather(swimmer, density, result):
    """Integral (6,) over the body of `density` (6, n)."""
    a = b = c = d = e = f = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        a += weight * take(density, 0, i)
        b += weight * take(density, 1, i)
        c += weight * take(density, 2, i)
        d += weight * take(density, 3, i)
        e += weight * take(density, 4, i)
        f += weight * take(density, 5, i)
    result[0], result[1], result[2] = total(a), total(b), total(c)
    result[3], result[4], result[5] = total(d), total(e), total(f)


@inlined
def accelerate(swimmer, fields, twist, balance):
    """Head's acceleration, accelerations and balance of the sections, in a configured body whose `fields` hold the true
    velocities, the loads that go with them and the factors of the inertia I_o."""
    shape_accelerations(swimmer, fields, balance)
    section_densities(swimmer, fields, balance)
    gather(swimmer, balance.density, balance.total)
    nose_drag = -swimmer.nose_drag * twist[3] * abs(twist[3])
    for k in range(6):
        balance.head[k] = fields.tail[k] + fields.drag[k] - balance.total[k]
    balance.head[3] += nose_drag
    solve(fields.inertia, balance.head)
    add_head_acceleration(swimmer, fields, balance)
    section_densities(swimmer, fields, balance)
    gather(swimmer, balance.density, balance.total)
    for k in range(6):
        balance.total[k] -= fields.drag[k]
    if swimmer.resistive:
        add_resistance(swimmer, fields, balance.density)
    balance.nose[0] = nose_drag - swimmer.nose_mass * balance.head[3]
    balance.powers[1] = fields.losses[1] * fields.losses[2]
    balance.powers[2] = balance.nose[0] * twist[3]
    balance.powers[3] = fields.losses[0]


@inlined
def actuator_power(swimmer, fields, balance):
    """- integral of C . Kdot [W] over the body, from an accelerated body; leaves the integrals of the balance in
    `upto`."""
    integrate_steps(swimmer, fields, swimmer.upto, balance.density, balance.upto, balance.upto)
    R, r, upto = fields.R, fields.r, balance.upto
    behind = fields.wrench  # the balance of the whole body, of which the part before each section is taken
    for k in range(6):
        behind[k] = fields.tail[k] - balance.total[k]
    power = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        x, y, z = three(r, 0, i)
        nx, ny, nz = take(upto, 3, i) + behind[3], take(upto, 4, i) + behind[4], take(upto, 5, i) + behind[5]
        tx, ty, tz = cross(x, y, z, nx, ny, nz)
        tx, ty, tz = (
            take(upto, 0, i) + behind[0] - tx,
            take(upto, 1, i) + behind[1] - ty,
            take(upto, 2, i) + behind[2] - tz,
        )
        bx, by, bz = three(R, 3, i)
        cx, cy, cz = three(R, 6, i)
        c2, c3 = dot(bx, by, bz, tx, ty, tz), dot(cx, cy, cz, tx, ty, tz)
        power -= take(swimmer.weight, i) * (c2 * take(fields.rate, 0, i) + c3 * take(fields.rate, 1, i))
    balance.powers[0] = total(power)


@inlined
def kinetic_energies(swimmer, fields):
    """Kinetic energy [J] of the body, and of the water (without the nose's 1/2 m_o V1^2)."""
    R, omega, v = fields.R, fields.omega, fields.v
    body = water = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        v1, v2, v3 = in_section(R, i, *three(v, 0, i))
        o1, o2, o3 = in_section(R, i, *three(omega, 0, i))
        roll = take(swimmer.added_roll, i)
        fluid = take(swimmer.added2, i) * v2 * v2 + take(swimmer.added3, i) * v3 * v3 + roll * o1 * o1
        solid = take(swimmer.mass, i) * (v1 * v1 + v2 * v2 + v3 * v3)
        solid += (
            (take(swimmer.inertia1, i) - roll) * o1 * o1
            + take(swimmer.inertia2, i) * o2 * o2
            + take(swimmer.inertia3, i) * o3 * o3
        )
        half = 0.5 * take(swimmer.weight, i)
        body += half * solid
        water += half * fluid
    return total(body), total(water)
