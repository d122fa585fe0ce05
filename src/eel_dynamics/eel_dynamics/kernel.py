"""The mechanics of one instant, compiled: from shape and momentum of the body to the rates of both.

Every quantity is in the axes of the head at the instant, about the head, unless said (R(0) = 1, r(0) = 0). Fields along
the body are arrays (3, n) or (9, n) over the n nodes; `R` holds t1, t2, t3 one after the other. A wrench or momentum is
(torque, force), 6 numbers; a twist is (Omega, V).

Momentum form: the balance (60) of Boyer, Porez and Leroyer (2010) is the time derivative of the momentum of body and
water. With that momentum as the state, neither accelerations nor the second derivative of the law are needed to march.
"""

from typing import NamedTuple

import numpy as np

from .compiled import inlined
from .drag import ONE, ZERO, add_resistive_loads

MOST_KINKS = 24  # of the drag, along the body at one instant; what is more is integrated without care


class Kinks(NamedTuple):
    """Where the drag is not smooth at the instant: steps of the loads along the body, in no order."""

    number: np.ndarray  # (1,) how many there are
    kind: np.ndarray  # (k,) which row of the speeds changes its sign
    begin: np.ndarray  # (k,) first node of the panel
    fraction: np.ndarray  # (k,) of the panel
    step: np.ndarray  # (k,) of the factor of the load
    row: np.ndarray  # (k, p) m, weights of the integral from the panel's start to the step


class Fields(NamedTuple):
    """Work space of one evaluation, reused; n nodes."""

    turn: np.ndarray  # (4, n) rotation from the node before, quaternion x y z w
    q: np.ndarray  # (4, n) orientations of the sections, quaternion x y z w
    R: np.ndarray  # (9, n) t1, t2, t3 of the sections
    r: np.ndarray  # (3, n) m, positions
    bend: np.ndarray  # (3, 2, n) the Magnus moments B0, alpha2, alpha3 of (K2, K3) between nodes, rad
    rate: np.ndarray  # (2, n) rad/m/s, Kdot
    accel: np.ndarray  # (2, n) rad/m/s^2, Kddot
    omega: np.ndarray  # (3, n) rad/s, angular velocity of the sections
    v: np.ndarray  # (3, n) m/s, velocity of the sections
    speed: np.ndarray  # (5, n) m/s, rad/s, V1, V2, V3, Omega1; Re/8e4 - 1
    part: np.ndarray  # (n,) part of the turbulent law in the friction
    rubbing: np.ndarray  # (2, n) kg/m/s, friction by V1: of the laminar law, and what the turbulent one adds
    share: np.ndarray  # (4, n) m, weights of the loads with steps
    integrand: np.ndarray  # (6, n) scratch
    inertia: np.ndarray  # (6, 6) of body and water about the head
    wrench: np.ndarray  # (6,) scratch
    factor: np.ndarray  # (3, m) values and rates of the law's time factors
    kinks: Kinks


def fields_of(nodes: int, rows: int, widest: int) -> Fields:
    """Work space for `nodes` nodes in panels of up to `widest`, and a law of `rows` rows."""
    return Fields(
        turn=np.zeros((4, nodes)),
        q=np.zeros((4, nodes)),
        R=np.zeros((9, nodes)),
        r=np.zeros((3, nodes)),
        bend=np.zeros((3, 2, nodes)),
        rate=np.zeros((2, nodes)),
        accel=np.zeros((2, nodes)),
        omega=np.zeros((3, nodes)),
        v=np.zeros((3, nodes)),
        speed=np.zeros((5, nodes)),
        part=np.zeros(nodes),
        rubbing=np.zeros((2, nodes)),
        share=np.zeros((4, nodes)),
        integrand=np.zeros((6, nodes)),
        inertia=np.zeros((6, 6)),
        wrench=np.zeros(6),
        factor=np.zeros((3, rows)),
        kinks=Kinks(
            number=np.zeros(1, dtype=np.int64),
            kind=np.zeros(MOST_KINKS, dtype=np.uintp),
            begin=np.zeros(MOST_KINKS, dtype=np.uintp),
            fraction=np.zeros(MOST_KINKS),
            step=np.zeros(MOST_KINKS),
            row=np.zeros((MOST_KINKS, widest)),
        ),
    )


@inlined
def turns(bend, turn):
    """Rotations over intervals, as quaternions (4, n), by the sixth-order Magnus series of R' = R hat(K).

    bend (3, 2, n) holds B0, alpha2, alpha3 of K = (0, K2, K3) on each interval of length h, from its first three
    Legendre moments (Blanes, Casas and Ros, BIT 40 (2000)); exact where K keeps its direction.
    """
    for i in range(bend.shape[2]):
        b2, b3 = bend[0, 0, i], bend[0, 1, i]
        l2, l3 = bend[1, 0, i], bend[1, 1, i]
        q2, q3 = bend[2, 0, i], bend[2, 1, i]
        a2, a3 = b2 - q2 / 12.0, b3 - q3 / 12.0
        c1 = a2 * l3 - a3 * l2
        u2, u3 = 20.0 * a2 + q2, 20.0 * a3 + q3
        w1 = -(a2 * q3 - a3 * q2) / 30.0
        w2 = a3 * c1 / 60.0 - l2
        w3 = -a2 * c1 / 60.0 - l3
        e1 = -(u2 * w3 - u3 * w2) / 240.0
        e2 = b2 - (u3 * w1 - c1 * w3) / 240.0
        e3 = b3 - (c1 * w2 - u2 * w1) / 240.0
        z = 0.25 * (e1 * e1 + e2 * e2 + e3 * e3)  # half angle squared
        if z < 0.25:
            s = 0.5 * (
                1.0
                - z
                / 6.0
                * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0 * (1.0 - z / 110.0 * (1.0 - z / 156.0)))))
            )
            c = 1.0 - z / 2.0 * (
                1.0
                - z
                / 12.0
                * (1.0 - z / 30.0 * (1.0 - z / 56.0 * (1.0 - z / 90.0 * (1.0 - z / 132.0 * (1.0 - z / 182.0)))))
            )
        else:
            half = np.sqrt(z)
            s = 0.5 * np.sin(half) / half
            c = np.cos(half)
        turn[0, i], turn[1, i], turn[2, i], turn[3, i] = s * e1, s * e2, s * e3, c


@inlined
def axes_of(x, y, z, w, R, i):
    """Columns t1, t2, t3 of the rotation of the unit quaternion (x, y, z, w), into R[:, i]."""
    R[0, i], R[1, i], R[2, i] = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    R[3, i], R[4, i], R[5, i] = 2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)
    R[6, i], R[7, i], R[8, i] = 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)


@inlined
def orient(turn, q, R):
    """Section axes, q (4, n) and R (9, n), from head to tail by the product of the rotations between nodes (eq. 25)."""
    x, y, z, w = 0.0, 0.0, 0.0, 1.0
    for i in range(turn.shape[1]):
        a, b, c, d = turn[0, i], turn[1, i], turn[2, i], turn[3, i]
        x, y, z, w = (
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        )
        q[0, i], q[1, i], q[2, i], q[3, i] = x, y, z, w
        axes_of(x, y, z, w, R, i)


@inlined
def integrate(swimmer, integrand, result):
    """Integral (3, n) from the nose to each node of the `integrand` (3, n), by panels."""
    matrix, first, count = swimmer.matrix, swimmer.first, swimmer.count
    for i in range(matrix.shape[0]):
        begin = first[i]
        x = y = z = 0.0
        if begin > ZERO:
            x, y, z = result[0, begin - ONE], result[1, begin - ONE], result[2, begin - ONE]
        for j in range(count[i]):
            weight, node = matrix[i, j], begin + j
            x += weight * integrand[0, node]
            y += weight * integrand[1, node]
            z += weight * integrand[2, node]
        result[0, i], result[1, i], result[2, i] = x, y, z


@inlined
def shape_velocities(swimmer, fields):
    """Positions and the velocities due to the change of shape alone: r' = t1, omega' = R Kdot, v' = omega x t1."""
    R, rate, f, omega = fields.R, fields.rate, fields.integrand, fields.omega
    integrate(swimmer, R[:3], fields.r)
    for i in range(R.shape[1]):
        k2, k3 = rate[0, i], rate[1, i]
        f[0, i] = R[3, i] * k2 + R[6, i] * k3
        f[1, i] = R[4, i] * k2 + R[7, i] * k3
        f[2, i] = R[5, i] * k2 + R[8, i] * k3
    integrate(swimmer, f[:3], omega)
    for i in range(R.shape[1]):
        f[0, i] = omega[1, i] * R[2, i] - omega[2, i] * R[1, i]
        f[1, i] = omega[2, i] * R[0, i] - omega[0, i] * R[2, i]
        f[2, i] = omega[0, i] * R[1, i] - omega[1, i] * R[0, i]
    integrate(swimmer, f[:3], fields.v)


@inlined
def gather_inertia(swimmer, fields):
    """Inertia (6, 6) of body and water about the head, I_o of section 6, the nose's m_o included; lower triangle."""
    R, r = fields.R, fields.r
    vxx = vxy = vxz = vyy = vyz = vzz = 0.0
    cxx = cxy = cxz = cyx = cyy = cyz = czx = czy = czz = 0.0
    wxx = wxy = wxz = wyy = wyz = wzz = 0.0
    for i in range(R.shape[1]):
        weight = swimmer.weight[i]
        m, m2, m3 = weight * swimmer.mass[i], weight * swimmer.added2[i], weight * swimmer.added3[i]
        bx, by, bz = R[3, i], R[4, i], R[5, i]
        cx, cy, cz = R[6, i], R[7, i], R[8, i]
        x, y, z = r[0, i], r[1, i], r[2, i]
        xx = m + m2 * bx * bx + m3 * cx * cx
        xy = m2 * bx * by + m3 * cx * cy
        xz = m2 * bx * bz + m3 * cx * cz
        yy = m + m2 * by * by + m3 * cy * cy
        yz = m2 * by * bz + m3 * cy * cz
        zz = m + m2 * bz * bz + m3 * cz * cz
        vxx += xx
        vxy += xy
        vxz += xz
        vyy += yy
        vyz += yz
        vzz += zz
        # r x M
        dxx, dxy, dxz = y * xz - z * xy, y * yz - z * yy, y * zz - z * yz
        dyx, dyy, dyz = z * xx - x * xz, z * xy - x * yz, z * xz - x * zz
        dzx, dzy, dzz = x * xy - y * xx, x * yy - y * xy, x * yz - y * xz
        cxx += dxx
        cxy += dxy
        cxz += dxz
        cyx += dyx
        cyy += dyy
        cyz += dyz
        czx += dzx
        czy += dzy
        czz += dzz
        j, j2, j3 = (
            weight * swimmer.inertia1[i],
            weight * (swimmer.inertia2[i] - swimmer.inertia1[i]),
            weight * (swimmer.inertia3[i] - swimmer.inertia1[i]),
        )
        # J - (r x M) x r
        wxx += j + j2 * bx * bx + j3 * cx * cx + dxz * y - dxy * z
        wxy += j2 * bx * by + j3 * cx * cy + dyz * y - dyy * z
        wxz += j2 * bx * bz + j3 * cx * cz + dzz * y - dzy * z
        wyy += j + j2 * by * by + j3 * cy * cy + dyx * z - dyz * x
        wyz += j2 * by * bz + j3 * cy * cz + dzx * z - dzz * x
        wzz += j + j2 * bz * bz + j3 * cz * cz + dzy * x - dzx * y
    inertia = fields.inertia
    inertia[0, 0], inertia[1, 0], inertia[1, 1], inertia[2, 0], inertia[2, 1], inertia[2, 2] = (
        wxx,
        wxy,
        wyy,
        wxz,
        wyz,
        wzz,
    )
    inertia[3, 0], inertia[4, 0], inertia[5, 0] = cxx, cxy, cxz
    inertia[3, 1], inertia[4, 1], inertia[5, 1] = cyx, cyy, cyz
    inertia[3, 2], inertia[4, 2], inertia[5, 2] = czx, czy, czz
    inertia[3, 3], inertia[4, 3], inertia[4, 4], inertia[5, 3], inertia[5, 4], inertia[5, 5] = (
        vxx + swimmer.nose_mass,
        vxy,
        vyy,
        vxz,
        vyz,
        vzz,
    )


@inlined
def gather_momentum(swimmer, fields, momentum):
    """Momentum (6,) of body and water about the head due to `omega`, `v` (the nose's m_o not in it)."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    lx = ly = lz = px = py = pz = 0.0
    for i in range(R.shape[1]):
        weight = swimmer.weight[i]
        m, m2, m3 = weight * swimmer.mass[i], weight * swimmer.added2[i], weight * swimmer.added3[i]
        vx, vy, vz = v[0, i], v[1, i], v[2, i]
        p2 = m2 * (R[3, i] * vx + R[4, i] * vy + R[5, i] * vz)
        p3 = m3 * (R[6, i] * vx + R[7, i] * vy + R[8, i] * vz)
        qx = m * vx + p2 * R[3, i] + p3 * R[6, i]
        qy = m * vy + p2 * R[4, i] + p3 * R[7, i]
        qz = m * vz + p2 * R[5, i] + p3 * R[8, i]
        px += qx
        py += qy
        pz += qz
        j = weight * swimmer.inertia1[i]
        j2, j3 = weight * swimmer.inertia2[i] - j, weight * swimmer.inertia3[i] - j
        ox, oy, oz = omega[0, i], omega[1, i], omega[2, i]
        s2 = j2 * (R[3, i] * ox + R[4, i] * oy + R[5, i] * oz)
        s3 = j3 * (R[6, i] * ox + R[7, i] * oy + R[8, i] * oz)
        lx += j * ox + s2 * R[3, i] + s3 * R[6, i] + r[1, i] * qz - r[2, i] * qy
        ly += j * oy + s2 * R[4, i] + s3 * R[7, i] + r[2, i] * qx - r[0, i] * qz
        lz += j * oz + s2 * R[5, i] + s3 * R[8, i] + r[0, i] * qy - r[1, i] * qx
    momentum[0], momentum[1], momentum[2], momentum[3], momentum[4], momentum[5] = lx, ly, lz, px, py, pz


@inlined
def factorise(matrix):
    """Cholesky factor of a symmetric positive definite matrix, in place, from and to its lower triangle. False if it is
    not."""
    n = matrix.shape[0]
    for j in range(n):
        total = matrix[j, j]
        for k in range(j):
            total -= matrix[j, k] * matrix[j, k]
        if not total > 0.0:
            return False
        root = np.sqrt(total)
        matrix[j, j] = root
        for i in range(j + 1, n):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = total / root
    return True


@inlined
def solve(factor, vector):
    """Solve with the Cholesky `factor`, in place."""
    n = factor.shape[0]
    for i in range(n):
        total = vector[i]
        for k in range(i):
            total -= factor[i, k] * vector[k]
        vector[i] = total / factor[i, i]
    for i in range(n - 1, -1, -1):
        total = vector[i]
        for k in range(i + 1, n):
            total -= factor[k, i] * vector[k]
        vector[i] = total / factor[i, i]


@inlined
def add_head_twist(fields, twist):
    """Add the motion of the head, `twist` (6,), to the velocities due to the change of shape: the true ones."""
    r, omega, v = fields.r, fields.omega, fields.v
    for i in range(r.shape[1]):
        x, y, z = r[0, i], r[1, i], r[2, i]
        omega[0, i] += twist[0]
        omega[1, i] += twist[1]
        omega[2, i] += twist[2]
        v[0, i] += twist[3] + twist[1] * z - twist[2] * y
        v[1, i] += twist[4] + twist[2] * x - twist[0] * z
        v[2, i] += twist[5] + twist[0] * y - twist[1] * x


@inlined
def add_wake(swimmer, fields, wrench):
    """Add the momentum that the tail takes in from the wake, w_tail of eq. (60), to `wrench` (6,).

    Returns V1(l) [m/s], T_f(l) [J/m]: the wake's power into body and water is their product. Both 0 in a scene without
    wake.
    """
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    i = R.shape[1] - 1
    vx, vy, vz = v[0, i], v[1, i], v[2, i]
    v1 = swimmer.wake * (R[0, i] * vx + R[1, i] * vy + R[2, i] * vz)
    v2 = R[3, i] * vx + R[4, i] * vy + R[5, i] * vz
    v3 = R[6, i] * vx + R[7, i] * vy + R[8, i] * vz
    roll = R[0, i] * omega[0, i] + R[1, i] * omega[1, i] + R[2, i] * omega[2, i]
    p2, p3, s1 = swimmer.added2[i] * v2, swimmer.added3[i] * v3, swimmer.added_roll[i] * roll
    energy = 0.5 * swimmer.wake * (s1 * roll + p2 * v2 + p3 * v3)
    nx = -energy * R[0, i] + v1 * (p2 * R[3, i] + p3 * R[6, i])
    ny = -energy * R[1, i] + v1 * (p2 * R[4, i] + p3 * R[7, i])
    nz = -energy * R[2, i] + v1 * (p2 * R[5, i] + p3 * R[8, i])
    wrench[0] += v1 * s1 * R[0, i] + r[1, i] * nz - r[2, i] * ny
    wrench[1] += v1 * s1 * R[1, i] + r[2, i] * nx - r[0, i] * nz
    wrench[2] += v1 * s1 * R[2, i] + r[0, i] * ny - r[1, i] * nx
    wrench[3] += nx
    wrench[4] += ny
    wrench[5] += nz
    return v1, energy


@inlined
def configure(swimmer, fields):
    """Configuration and shape velocities of the body from `bend` and `rate` (the first loop of section 7.1)."""
    turns(fields.bend, fields.turn)
    orient(fields.turn, fields.q, fields.R)
    shape_velocities(swimmer, fields)


@inlined
def momentum_of_twist(swimmer, fields, twist, momentum):
    """Momentum (6,) of body, water and nose for the head's `twist` (6,), in a configured body."""
    gather_momentum(swimmer, fields, momentum)
    gather_inertia(swimmer, fields)
    inertia = fields.inertia
    for i in range(6):
        for j in range(6):
            momentum[i] += (inertia[i, j] if j <= i else inertia[j, i]) * twist[j]


@inlined
def twist_of_momentum(swimmer, fields, momentum, twist):
    """The head's `twist` (6,) in a configured body of the given `momentum` (6,): I_o^-1 times what the shape's change
    leaves.

    False where the inertia is not positive definite. Leaves the Cholesky factor of I_o in `fields.inertia`.
    """
    gather_momentum(swimmer, fields, twist)
    gather_inertia(swimmer, fields)
    for i in range(6):
        twist[i] = momentum[i] - twist[i]
    if not factorise(fields.inertia):
        return False
    solve(fields.inertia, twist)
    return True


@inlined
def momentum_rates(swimmer, fields, momentum, twist, rates):
    """Rates (6,) of momentum about the moving head, of world vectors, in the head's present axes; adds the head's twist
    to the velocities in `fields`."""
    add_head_twist(fields, twist)
    for i in range(6):
        rates[i] = 0.0
    add_wake(swimmer, fields, rates)
    if swimmer.resistive:
        add_resistive_loads(swimmer, fields, twist, rates)
    _, oy, oz, vx, vy, vz = twist[0], twist[1], twist[2], twist[3], twist[4], twist[5]
    nose = swimmer.nose_mass
    # n_nose less what is the derivative of m_o V1 E1 (its gyroscopic part), and the nose's drag
    rates[3] -= nose * (oy * vz - oz * vy) + swimmer.nose_drag * vx * abs(vx)
    rates[4] += nose * vx * oz
    rates[5] -= nose * vx * oy
    # about the moving head: - V x (P' - m_o V1 E1)
    px, py, pz = momentum[3] - nose * vx, momentum[4], momentum[5]
    rates[0] -= vy * pz - vz * py
    rates[1] -= vz * px - vx * pz
    rates[2] -= vx * py - vy * px
