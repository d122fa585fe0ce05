"""The acceleration form of the balance (60), and the internal wrench that follows from it (eq. 50), compiled.

    alpha' = R Kddot + omega x R Kdot        acc' = alpha x t1 + omega x (omega x t1)

are linear in the head's acceleration; the balance of the whole body gives that; the balance of the part behind a
section gives the wrench there. Same axes and conventions as in the kernel. The head's acceleration is the true one: of
the angular velocity and of the velocity of the nose, in the head's axes.
"""

from typing import NamedTuple

import numpy as np

from .compiled import inlined
from .drag import add_resistance, add_resistive_loads, add_steps
from .kernel import add_wake, integrate, solve


class Balance(NamedTuple):
    """Work space and result of one evaluation over n nodes."""

    alpha: np.ndarray  # (3, n) rad/s^2, angular acceleration of the sections
    acc: np.ndarray  # (3, n) m/s^2, acceleration of the sections
    density: np.ndarray  # (6, n) wrench per length that the motion takes less the loads, about the head
    upto: np.ndarray  # (6, n) its integral from the nose
    head: np.ndarray  # (6,) acceleration of the head
    tail: np.ndarray  # (6,) wrench from the wake, about the head
    total: np.ndarray  # (6,) integral over the body of what the motion takes less the loads
    drag: np.ndarray  # (6,) wrench of the drag along the body, about the head
    powers: np.ndarray  # (4,) W: actuators, wake, nose, drag
    nose: np.ndarray  # (1,) N, load on the nose along t1(0)


def balance_of(nodes: int) -> Balance:
    """Work space for `nodes` nodes."""
    return Balance(
        alpha=np.zeros((3, nodes)),
        acc=np.zeros((3, nodes)),
        density=np.zeros((6, nodes)),
        upto=np.zeros((6, nodes)),
        head=np.zeros(6),
        tail=np.zeros(6),
        total=np.zeros(6),
        drag=np.zeros(6),
        powers=np.zeros(4),
        nose=np.zeros(1),
    )


@inlined
def shape_accelerations(swimmer, fields, balance):
    """Accelerations of the sections where the head has none: alpha and acc with zero at the nose."""
    R, omega, f, rate, accel = fields.R, fields.omega, fields.integrand, fields.rate, fields.accel
    alpha = balance.alpha
    n = R.shape[1]
    for i in range(n):
        k2, k3, l2, l3 = rate[0, i], rate[1, i], accel[0, i], accel[1, i]
        kx = R[3, i] * k2 + R[6, i] * k3
        ky = R[4, i] * k2 + R[7, i] * k3
        kz = R[5, i] * k2 + R[8, i] * k3
        f[0, i] = R[3, i] * l2 + R[6, i] * l3 + omega[1, i] * kz - omega[2, i] * ky
        f[1, i] = R[4, i] * l2 + R[7, i] * l3 + omega[2, i] * kx - omega[0, i] * kz
        f[2, i] = R[5, i] * l2 + R[8, i] * l3 + omega[0, i] * ky - omega[1, i] * kx
    integrate(swimmer, f[:3], alpha)
    for i in range(n):
        ox, oy, oz = omega[0, i], omega[1, i], omega[2, i]
        tx, ty, tz = R[0, i], R[1, i], R[2, i]
        along = ox * tx + oy * ty + oz * tz
        square = ox * ox + oy * oy + oz * oz
        f[0, i] = alpha[1, i] * tz - alpha[2, i] * ty + along * ox - square * tx
        f[1, i] = alpha[2, i] * tx - alpha[0, i] * tz + along * oy - square * ty
        f[2, i] = alpha[0, i] * ty - alpha[1, i] * tx + along * oz - square * tz
    integrate(swimmer, f[:3], balance.acc)


@inlined
def add_head_acceleration(fields, balance):
    """Add the head's acceleration to the accelerations of the sections: the true ones."""
    r, alpha, acc, head = fields.r, balance.alpha, balance.acc, balance.head
    for i in range(r.shape[1]):
        x, y, z = r[0, i], r[1, i], r[2, i]
        alpha[0, i] += head[0]
        alpha[1, i] += head[1]
        alpha[2, i] += head[2]
        acc[0, i] += head[3] + head[1] * z - head[2] * y
        acc[1, i] += head[4] + head[2] * x - head[0] * z
        acc[2, i] += head[5] + head[0] * y - head[1] * x


@inlined
def section_densities(swimmer, fields, balance):
    """What the section's motion takes, f_N = M Vdot + Omega x M V, f_C = J Omegadot + Omega x J Omega + V x M V, moved
    to the head, into `density` (6, n)."""
    R, r, omega, v, density = fields.R, fields.r, fields.omega, fields.v, balance.density
    alpha, acc = balance.alpha, balance.acc
    for i in range(R.shape[1]):
        ax, ay, az, bx, by, bz, cx, cy, cz = (
            R[0, i],
            R[1, i],
            R[2, i],
            R[3, i],
            R[4, i],
            R[5, i],
            R[6, i],
            R[7, i],
            R[8, i],
        )
        ux, uy, uz = v[0, i], v[1, i], v[2, i]
        v1, v2, v3 = ax * ux + ay * uy + az * uz, bx * ux + by * uy + bz * uz, cx * ux + cy * uy + cz * uz
        ux, uy, uz = omega[0, i], omega[1, i], omega[2, i]
        o1, o2, o3 = ax * ux + ay * uy + az * uz, bx * ux + by * uy + bz * uz, cx * ux + cy * uy + cz * uz
        ux, uy, uz = acc[0, i], acc[1, i], acc[2, i]
        d1 = ax * ux + ay * uy + az * uz - (o2 * v3 - o3 * v2)
        d2 = bx * ux + by * uy + bz * uz - (o3 * v1 - o1 * v3)
        d3 = cx * ux + cy * uy + cz * uz - (o1 * v2 - o2 * v1)
        ux, uy, uz = alpha[0, i], alpha[1, i], alpha[2, i]
        e1, e2, e3 = ax * ux + ay * uy + az * uz, bx * ux + by * uy + bz * uz, cx * ux + cy * uy + cz * uz
        m1 = swimmer.mass[i]
        m2, m3 = m1 + swimmer.added2[i], m1 + swimmer.added3[i]
        j1, j2, j3 = swimmer.inertia1[i], swimmer.inertia2[i], swimmer.inertia3[i]
        p1, p2, p3 = m1 * v1, m2 * v2, m3 * v3
        s1, s2, s3 = j1 * o1, j2 * o2, j3 * o3
        f1 = m1 * d1 + o2 * p3 - o3 * p2
        f2 = m2 * d2 + o3 * p1 - o1 * p3
        f3 = m3 * d3 + o1 * p2 - o2 * p1
        g1 = j1 * e1 + o2 * s3 - o3 * s2 + v2 * p3 - v3 * p2
        g2 = j2 * e2 + o3 * s1 - o1 * s3 + v3 * p1 - v1 * p3
        g3 = j3 * e3 + o1 * s2 - o2 * s1 + v1 * p2 - v2 * p1
        hx, hy, hz = ax * f1 + bx * f2 + cx * f3, ay * f1 + by * f2 + cy * f3, az * f1 + bz * f2 + cz * f3
        x, y, z = r[0, i], r[1, i], r[2, i]
        density[0, i] = ax * g1 + bx * g2 + cx * g3 + y * hz - z * hy
        density[1, i] = ay * g1 + by * g2 + cy * g3 + z * hx - x * hz
        density[2, i] = az * g1 + bz * g2 + cz * g3 + x * hy - y * hx
        density[3, i], density[4, i], density[5, i] = hx, hy, hz


@inlined
def gather(swimmer, density, total):
    """Integral (6,) over the body of `density` (6, n)."""
    for k in range(6):
        value = 0.0
        for i in range(density.shape[1]):
            value += swimmer.weight[i] * density[k, i]
        total[k] = value


@inlined
def accelerate(swimmer, fields, twist, balance):
    """Head's acceleration, accelerations and balance of the sections, in a configured body whose `fields` hold the true
    velocities and the Cholesky factor of the inertia I_o."""
    shape_accelerations(swimmer, fields, balance)
    section_densities(swimmer, fields, balance)
    gather(swimmer, balance.density, balance.total)
    balance.drag[:] = 0.0
    balance.powers[3] = 0.0
    if swimmer.resistive:
        balance.powers[3] = add_resistive_loads(swimmer, fields, twist, balance.drag)
    for k in range(6):
        balance.tail[k] = 0.0
    v1, energy = add_wake(swimmer, fields, balance.tail)
    nose_drag = -swimmer.nose_drag * twist[3] * abs(twist[3])
    for k in range(6):
        balance.head[k] = balance.tail[k] + balance.drag[k] - balance.total[k]
    balance.head[3] += nose_drag
    solve(fields.inertia, balance.head)
    add_head_acceleration(fields, balance)
    section_densities(swimmer, fields, balance)
    gather(swimmer, balance.density, balance.total)
    for k in range(6):
        balance.total[k] -= balance.drag[k]
    if swimmer.resistive:
        add_resistance(swimmer, fields, balance.density)
    balance.nose[0] = nose_drag - swimmer.nose_mass * balance.head[3]
    balance.powers[1] = v1 * energy
    balance.powers[2] = balance.nose[0] * twist[3]


@inlined
def section_wrench(R, r, omega, v, i, added2, added3, added_roll, wrench, result):
    """Internal torque and force (6,) at section i, in its axes and about it, from the `wrench` (6,) about the head that
    the part behind passes on: Ad*^-1 w - (V1 J_f1 Omega1 E1; V1 M_f V). Returns T_f [J/m]. The added masses given are 0
    where no water is swept past the sections."""
    x, y, z = r[0, i], r[1, i], r[2, i]
    nx, ny, nz = wrench[3], wrench[4], wrench[5]
    tx, ty, tz = wrench[0] - (y * nz - z * ny), wrench[1] - (z * nx - x * nz), wrench[2] - (x * ny - y * nx)
    v1 = R[0, i] * v[0, i] + R[1, i] * v[1, i] + R[2, i] * v[2, i]
    v2 = R[3, i] * v[0, i] + R[4, i] * v[1, i] + R[5, i] * v[2, i]
    v3 = R[6, i] * v[0, i] + R[7, i] * v[1, i] + R[8, i] * v[2, i]
    roll = R[0, i] * omega[0, i] + R[1, i] * omega[1, i] + R[2, i] * omega[2, i]
    for k in range(3):
        result[k] = R[3 * k, i] * tx + R[3 * k + 1, i] * ty + R[3 * k + 2, i] * tz
        result[3 + k] = R[3 * k, i] * nx + R[3 * k + 1, i] * ny + R[3 * k + 2, i] * nz
    result[0] -= v1 * added_roll * roll
    result[4] -= v1 * added2 * v2
    result[5] -= v1 * added3 * v3
    return 0.5 * (added_roll * roll * roll + added2 * v2 * v2 + added3 * v3 * v3)


@inlined
def actuator_power(swimmer, fields, balance, section):
    """- integral of C . Kdot [W] over the body, from an accelerated body; leaves the integrals of the balance in
    `upto`."""
    integrate(swimmer, balance.density[:3], balance.upto[:3])
    integrate(swimmer, balance.density[3:], balance.upto[3:])
    if swimmer.resistive:
        add_steps(swimmer, fields, swimmer, True, balance.upto)
    power = 0.0
    for i in range(fields.R.shape[1]):
        for k in range(6):
            fields.wrench[k] = balance.tail[k] - balance.total[k] + balance.upto[k, i]
        section_wrench(
            fields.R,
            fields.r,
            fields.omega,
            fields.v,
            i,
            swimmer.wake * swimmer.added2[i],
            swimmer.wake * swimmer.added3[i],
            swimmer.wake * swimmer.added_roll[i],
            fields.wrench,
            section,
        )
        power -= swimmer.weight[i] * (section[1] * fields.rate[0, i] + section[2] * fields.rate[1, i])
    balance.powers[0] = power
    return power


@inlined
def kinetic_energies(swimmer, fields):
    """Kinetic energy [J] of the body, and of the water (without the nose's 1/2 m_o V1^2)."""
    R, omega, v = fields.R, fields.omega, fields.v
    body = water = 0.0
    for i in range(R.shape[1]):
        v1 = R[0, i] * v[0, i] + R[1, i] * v[1, i] + R[2, i] * v[2, i]
        v2 = R[3, i] * v[0, i] + R[4, i] * v[1, i] + R[5, i] * v[2, i]
        v3 = R[6, i] * v[0, i] + R[7, i] * v[1, i] + R[8, i] * v[2, i]
        o1 = R[0, i] * omega[0, i] + R[1, i] * omega[1, i] + R[2, i] * omega[2, i]
        o2 = R[3, i] * omega[0, i] + R[4, i] * omega[1, i] + R[5, i] * omega[2, i]
        o3 = R[6, i] * omega[0, i] + R[7, i] * omega[1, i] + R[8, i] * omega[2, i]
        fluid = swimmer.added2[i] * v2 * v2 + swimmer.added3[i] * v3 * v3 + swimmer.added_roll[i] * o1 * o1
        solid = swimmer.mass[i] * (v1 * v1 + v2 * v2 + v3 * v3)
        solid += (
            (swimmer.inertia1[i] - swimmer.added_roll[i]) * o1 * o1
            + swimmer.inertia2[i] * o2 * o2
            + swimmer.inertia3[i] * o3 * o3
        )
        body += 0.5 * swimmer.weight[i] * solid
        water += 0.5 * swimmer.weight[i] * fluid
    return body, water
