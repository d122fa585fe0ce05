"""The mechanics of one instant, compiled: from shape and momentum of the body to the rates of both.

Every quantity is in the axes of the head at the instant, about the head, unless said (R(0) = 1, r(0) = 0). Fields along
the body are arrays (3, n) or (9, n) over the n nodes; `R` holds t1, t2, t3 one after the other. A wrench or momentum is
(torque, force), 6 numbers; a twist is (Omega, V).

Momentum form: the balance (60) of Boyer, Porez and Leroyer (2010) is the time derivative of the momentum of body and
water. With that momentum as the state, neither accelerations nor the second derivative of the law are needed to march.
"""

from typing import NamedTuple

import numpy as np

from .compiled import compiled, inlined
from .drag import add_resistive_loads
from .drive import combine, combine_moments, series_of
from .kinks import ONE, ZERO
from .lanes import (
    WIDTH,
    any_of,
    last,
    moved1,
    moved2,
    moved4,
    padded,
    put,
    spread,
    take,
    total,
    work_space,
)
from .vectors import bent, cross, dot, put_three, three

MOST_KINKS = 24  # of the drag, along the body at one instant; what is more is integrated without care
SERIES = 0.25  # square of half an angle, up to which sine and cosine are taken from their series


class Kinks(NamedTuple):
    """Where the drag is not smooth at the instant: steps of the loads along the body, in no order."""

    number: np.ndarray  # (1,) how many there are
    kind: np.ndarray  # (k,) which row of the speeds changes its sign
    begin: np.ndarray  # (k,) first node of the panel
    fraction: np.ndarray  # (k,) of the panel
    step: np.ndarray  # (k,) of the factor of the load
    row: np.ndarray  # (k, p) m, weights of the integral from the panel's start to the step
    density: np.ndarray  # (k, 6, p) what the step is of, per length about the head
    whole: np.ndarray  # (k, 6) its integral from the panel's start to the step


class Fields(NamedTuple):
    """Work space of one evaluation, reused; n nodes and those that fill it up (`lanes.padded`)."""

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
    inertia: np.ndarray  # (6, 6) of body and water about the head, or its factors L and 1/D of L D L^T
    wrench: np.ndarray  # (6,) scratch
    tail: np.ndarray  # (6,) wrench from the wake, on the body about the head
    drag: np.ndarray  # (6,) wrench of the drag along the body
    losses: np.ndarray  # (3,) drag's power W; V1 m/s and T_f J/m at the tail, whose product is the wake's
    factor: np.ndarray  # (3, m) values and rates of the law's time factors
    kinks: Kinks


ALONG = ((4,), (4,), (9,), (3,), (3, 2), (2,), (2,), (3,), (3,), (5,), (), (2,), (4,), (6,))  # of `Fields`, by node


def fields_of(nodes: int, rows: int, widest: int) -> Fields:
    """Work space for `nodes` nodes in panels of up to `widest`, and a law of `rows` rows."""
    return Fields(
        *work_space(ALONG, nodes),
        inertia=np.zeros((6, 6)),
        wrench=np.zeros(6),
        tail=np.zeros(6),
        drag=np.zeros(6),
        losses=np.zeros(3),
        factor=np.zeros((3, rows)),
        kinks=Kinks(
            number=np.zeros(1, dtype=np.int64),
            kind=np.zeros(MOST_KINKS, dtype=np.uintp),
            begin=np.zeros(MOST_KINKS, dtype=np.uintp),
            fraction=np.zeros(MOST_KINKS),
            step=np.zeros(MOST_KINKS),
            row=np.zeros((MOST_KINKS, padded(widest))),
            density=np.zeros((MOST_KINKS, 6, padded(widest))),
            whole=np.zeros((MOST_KINKS, 6)),
        ),
    )


@inlined
def turns(bend, blocks, turn):
    """Rotations over intervals, as quaternions (4, n), by the sixth-order Magnus series of R' = R hat(K).

    bend (3, 2, n) holds B0, alpha2, alpha3 of K = (0, K2, K3) on each interval of length h, from its first three
    Legendre moments (Blanes, Casas and Ros, BIT 40 (2000)); exact where K keeps its direction.
    """
    for k in range(blocks):
        i = WIDTH * k
        b2, b3 = take(bend, 0, 0, i), take(bend, 0, 1, i)
        l2, l3 = take(bend, 1, 0, i), take(bend, 1, 1, i)
        q2, q3 = take(bend, 2, 0, i), take(bend, 2, 1, i)
        a2, a3 = b2 - q2 * (1.0 / 12.0), b3 - q3 * (1.0 / 12.0)
        c1 = a2 * l3 - a3 * l2
        u2, u3 = 20.0 * a2 + q2, 20.0 * a3 + q3
        w1 = -(a2 * q3 - a3 * q2) * (1.0 / 30.0)
        w2 = a3 * c1 * (1.0 / 60.0) - l2
        w3 = -a2 * c1 * (1.0 / 60.0) - l3
        e1 = -(u2 * w3 - u3 * w2) * (1.0 / 240.0)
        e2 = b2 - (u3 * w1 - c1 * w3) * (1.0 / 240.0)
        e3 = b3 - (c1 * w2 - u2 * w1) * (1.0 / 240.0)
        z = 0.25 * (e1 * e1 + e2 * e2 + e3 * e3)  # half angle squared
        s, c = series_of(z)
        s *= 0.5
        put(turn, 0, i, s * e1)
        put(turn, 1, i, s * e2)
        put(turn, 2, i, s * e3)
        put(turn, 3, i, c)
        if any_of(z > SERIES):
            put(turn, 0, i, e1)
            put(turn, 1, i, e2)
            put(turn, 2, i, e3)
            turn_far(turn, i)


@compiled
def turn_far(turn, begin):
    """Eight rotations from `begin` on, of vectors (rows 0 to 2 of `turn`) as quaternions, however large."""
    for i in range(begin, begin + WIDTH):
        x, y, z = turn[0, i], turn[1, i], turn[2, i]
        angle = np.sqrt(x * x + y * y + z * z)
        s = np.sin(0.5 * angle) / angle if angle > 1e-8 else 0.5
        turn[0, i], turn[1, i], turn[2, i], turn[3, i] = s * x, s * y, s * z, np.cos(0.5 * angle)


@inlined
def product(x, y, z, w, a, b, c, d):
    """Of two quaternions, (x, y, z, w) times (a, b, c, d)."""
    return (
        (w * a + x * d) + (y * c - z * b),
        (w * b - x * c) + (y * d + z * a),
        (w * c + x * b) + (z * d - y * a),
        (w * d - x * a) - (y * b + z * c),
    )


@inlined
def put_axes(R, i, x, y, z, w):
    """Store the columns t1, t2, t3 of the rotations of eight unit quaternions (x, y, z, w)."""
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    put(R, 0, i, 1.0 - 2.0 * (yy + zz))
    put(R, 1, i, 2.0 * (xy + wz))
    put(R, 2, i, 2.0 * (xz - wy))
    put(R, 3, i, 2.0 * (xy - wz))
    put(R, 4, i, 1.0 - 2.0 * (xx + zz))
    put(R, 5, i, 2.0 * (yz + wx))
    put(R, 6, i, 2.0 * (xz + wy))
    put(R, 7, i, 2.0 * (yz - wx))
    put(R, 8, i, 1.0 - 2.0 * (xx + yy))


@inlined
def orient(turn, blocks, q, R):
    """Section axes, q (4, n) and R (9, n), from head to tail by the product of the rotations between nodes (eq. 25):
    those of 2, 4, 8 successive nodes at once, then that of all before."""
    x0 = y0 = z0 = spread(0.0)
    w0 = spread(1.0)
    for k in range(blocks):
        i = WIDTH * k
        x, y, z, w = take(turn, 0, i), take(turn, 1, i), take(turn, 2, i), take(turn, 3, i)
        x, y, z, w = product(moved1(x, 0.0), moved1(y, 0.0), moved1(z, 0.0), moved1(w, 1.0), x, y, z, w)
        x, y, z, w = product(moved2(x, 0.0), moved2(y, 0.0), moved2(z, 0.0), moved2(w, 1.0), x, y, z, w)
        x, y, z, w = product(moved4(x, 0.0), moved4(y, 0.0), moved4(z, 0.0), moved4(w, 1.0), x, y, z, w)
        x, y, z, w = product(x0, y0, z0, w0, x, y, z, w)
        x0, y0, z0, w0 = spread(last(x)), spread(last(y)), spread(last(z)), spread(last(w))
        put(q, 0, i, x)
        put(q, 1, i, y)
        put(q, 2, i, z)
        put(q, 3, i, w)
        put_axes(R, i, x, y, z, w)


@inlined
def integrate(upto, integrand, row, known, head, result):
    """Integral (3, n) from the nose to the points of `upto`, of three rows of the `integrand` from `row` on.

    known (3, n): the integral to the nodes, the `result` itself where these are the points; `head` (x, y, z): the value
    at the nose.
    """
    for k in range(len(upto.source)):
        node = upto.source[k]
        begin = upto.start[k]
        a = b = c = d = e = f = spread(0.0)
        for j in range(upto.sources[k] >> ONE):  # two by two: each sum waits for its last term
            here = node + (j << ONE)
            column = take(upto.columns, begin + (j << ONE), 0)
            a += integrand[row, here] * column
            b += integrand[row + 1, here] * column
            c += integrand[row + 2, here] * column
            column = take(upto.columns, begin + (j << ONE) + ONE, 0)
            d += integrand[row, here + ONE] * column
            e += integrand[row + 1, here + ONE] * column
            f += integrand[row + 2, here + ONE] * column
        x, y, z = head
        if node > ZERO:
            x, y, z = known[0, node - ONE], known[1, node - ONE], known[2, node - ONE]
        put_three(result, 0, WIDTH * k, a + d + x, b + e + y, c + f + z)


@inlined
def integrate_along(swimmer, integrand, row, result):
    """Integral (3, n) from the nose to each node of three rows of the `integrand`, from `row` on."""
    integrate(swimmer.upto, integrand, row, result, (0.0, 0.0, 0.0), result)


@inlined
def integrate_both(upto, f, result_f, g, result_g):
    """Integrals (3, n) from the nose to each node of the first three rows of `f` and of `g`, at once."""
    for k in range(len(upto.source)):
        node = upto.source[k]
        begin = upto.start[k]
        a = b = c = d = e = h = spread(0.0)
        for j in range(upto.sources[k]):
            column = take(upto.columns, begin + j, 0)
            a += f[0, node + j] * column
            b += f[1, node + j] * column
            c += f[2, node + j] * column
            d += g[0, node + j] * column
            e += g[1, node + j] * column
            h += g[2, node + j] * column
        if node > ZERO:
            last = node - ONE
            a, b, c = a + result_f[0, last], b + result_f[1, last], c + result_f[2, last]
            d, e, h = d + result_g[0, last], e + result_g[1, last], h + result_g[2, last]
        put_three(result_f, 0, WIDTH * k, a, b, c)
        put_three(result_g, 0, WIDTH * k, d, e, h)


@inlined
def shape_velocities(swimmer, fields):
    """Positions and the velocities due to the change of shape alone: r' = t1, omega' = R Kdot, v' = omega x t1."""
    R, rate, f, omega = fields.R, fields.rate, fields.integrand, fields.omega
    for k in range(swimmer.blocks):
        i = WIDTH * k
        x, y, z = bent(R, rate, i)
        put_three(f, 0, i, x, y, z)
    integrate_both(swimmer.upto, R, fields.r, f, omega)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        ox, oy, oz = three(omega, 0, i)
        tx, ty, tz = three(R, 0, i)
        x, y, z = cross(ox, oy, oz, tx, ty, tz)
        put_three(f, 0, i, x, y, z)
    integrate_along(swimmer, f, 0, fields.v)


@inlined
def gather_inertia(swimmer, fields):
    """Inertia (6, 6) of body and water about the head, I_o of section 6, the nose's m_o included; lower triangle.

    With b, c = t2, t3: M = m + m2 b b^T + m3 c c^T along the body, and about the head
    r x M x r^T = m (r.r - r r^T) + m2 (r x b)(r x b)^T + m3 (r x c)(r x c)^T.
    """
    R, r = fields.R, fields.r
    vxx = vxy = vxz = vyy = vyz = vzz = spread(0.0)
    cxx = cxy = cxz = cyx = cyy = cyz = czx = czy = czz = spread(0.0)
    wxx = wxy = wxz = wyy = wyz = wzz = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        m, m2, m3 = (
            weight * take(swimmer.mass, i),
            weight * take(swimmer.added2, i),
            weight * take(swimmer.added3, i),
        )
        bx, by, bz = three(R, 3, i)
        cx, cy, cz = three(R, 6, i)
        x, y, z = three(r, 0, i)
        ux, uy, uz = cross(x, y, z, bx, by, bz)
        wx, wy, wz = cross(x, y, z, cx, cy, cz)
        px, py, pz = m2 * bx, m2 * by, m2 * bz
        qx, qy, qz = m3 * cx, m3 * cy, m3 * cz
        vxx += m + px * bx + qx * cx
        vxy += px * by + qx * cy
        vxz += px * bz + qx * cz
        vyy += m + py * by + qy * cy
        vyz += py * bz + qy * cz
        vzz += m + pz * bz + qz * cz
        mx, my, mz = m * x, m * y, m * z
        cxx += ux * px + wx * qx
        cxy += ux * py + wx * qy - mz
        cxz += ux * pz + wx * qz + my
        cyx += uy * px + wy * qx + mz
        cyy += uy * py + wy * qy
        cyz += uy * pz + wy * qz - mx
        czx += uz * px + wz * qx - my
        czy += uz * py + wz * qy + mx
        czz += uz * pz + wz * qz
        j = weight * take(swimmer.inertia1, i)
        j2, j3 = weight * take(swimmer.inertia2, i) - j, weight * take(swimmer.inertia3, i) - j
        px, py, pz = m2 * ux, m2 * uy, m2 * uz
        qx, qy, qz = m3 * wx, m3 * wy, m3 * wz
        fx, fy, fz = j2 * bx, j2 * by, j2 * bz
        gx, gy, gz = j3 * cx, j3 * cy, j3 * cz
        wxx += j + fx * bx + gx * cx + px * ux + qx * wx + (my * y + mz * z)
        wxy += fx * by + gx * cy + px * uy + qx * wy - mx * y
        wxz += fx * bz + gx * cz + px * uz + qx * wz - mx * z
        wyy += j + fy * by + gy * cy + py * uy + qy * wy + (mx * x + mz * z)
        wyz += fy * bz + gy * cz + py * uz + qy * wz - my * z
        wzz += j + fz * bz + gz * cz + pz * uz + qz * wz + (mx * x + my * y)
    inertia = fields.inertia
    inertia[0, 0], inertia[1, 0], inertia[2, 0] = total(wxx), total(wxy), total(wxz)
    inertia[1, 1], inertia[2, 1], inertia[2, 2] = total(wyy), total(wyz), total(wzz)
    # below: the momentum P by Omega, (r x M)^T
    inertia[3, 0], inertia[4, 0], inertia[5, 0] = total(cxx), total(cxy), total(cxz)
    inertia[3, 1], inertia[4, 1], inertia[5, 1] = total(cyx), total(cyy), total(cyz)
    inertia[3, 2], inertia[4, 2], inertia[5, 2] = total(czx), total(czy), total(czz)
    inertia[3, 3], inertia[4, 3], inertia[5, 3] = total(vxx) + swimmer.nose_mass, total(vxy), total(vxz)
    inertia[4, 4], inertia[5, 4], inertia[5, 5] = total(vyy), total(vyz), total(vzz)


@inlined
def gather_momentum(swimmer, fields, momentum):
    """Momentum (6,) of body and water about the head due to `omega`, `v` (the nose's m_o not in it)."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    lx = ly = lz = px = py = pz = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        m = weight * take(swimmer.mass, i)
        bx, by, bz = three(R, 3, i)
        cx, cy, cz = three(R, 6, i)
        vx, vy, vz = three(v, 0, i)
        p2 = weight * take(swimmer.added2, i) * dot(bx, by, bz, vx, vy, vz)
        p3 = weight * take(swimmer.added3, i) * dot(cx, cy, cz, vx, vy, vz)
        qx = m * vx + p2 * bx + p3 * cx
        qy = m * vy + p2 * by + p3 * cy
        qz = m * vz + p2 * bz + p3 * cz
        px += qx
        py += qy
        pz += qz
        j = weight * take(swimmer.inertia1, i)
        ox, oy, oz = three(omega, 0, i)
        s2 = (weight * take(swimmer.inertia2, i) - j) * dot(bx, by, bz, ox, oy, oz)
        s3 = (weight * take(swimmer.inertia3, i) - j) * dot(cx, cy, cz, ox, oy, oz)
        x, y, z = three(r, 0, i)
        tx, ty, tz = cross(x, y, z, qx, qy, qz)
        lx += j * ox + s2 * bx + s3 * cx + tx
        ly += j * oy + s2 * by + s3 * cy + ty
        lz += j * oz + s2 * bz + s3 * cz + tz
    momentum[0], momentum[1], momentum[2] = total(lx), total(ly), total(lz)
    momentum[3], momentum[4], momentum[5] = total(px), total(py), total(pz)


@inlined
def factorise(a):
    """Factors L and 1/D of a symmetric positive definite matrix (6, 6) = L D L^T, in place: L below the diagonal, 1/D
    on it. From its lower triangle; False if it is not positive definite."""
    good = a[0, 0] > 0.0
    d = 1.0 / a[0, 0]
    a[0, 0] = d
    b1, b2, b3, b4, b5 = a[1, 0], a[2, 0], a[3, 0], a[4, 0], a[5, 0]
    l1, l2, l3, l4, l5 = b1 * d, b2 * d, b3 * d, b4 * d, b5 * d
    a[1, 0], a[2, 0], a[3, 0], a[4, 0], a[5, 0] = l1, l2, l3, l4, l5
    a11 = a[1, 1] - b1 * l1
    a21, a22 = a[2, 1] - b2 * l1, a[2, 2] - b2 * l2
    a31, a32, a33 = a[3, 1] - b3 * l1, a[3, 2] - b3 * l2, a[3, 3] - b3 * l3
    a41, a42, a43, a44 = a[4, 1] - b4 * l1, a[4, 2] - b4 * l2, a[4, 3] - b4 * l3, a[4, 4] - b4 * l4
    a51, a52, a53, a54 = a[5, 1] - b5 * l1, a[5, 2] - b5 * l2, a[5, 3] - b5 * l3, a[5, 4] - b5 * l4
    a55 = a[5, 5] - b5 * l5
    good &= a11 > 0.0
    d = 1.0 / a11
    l2, l3, l4, l5 = a21 * d, a31 * d, a41 * d, a51 * d
    a[1, 1], a[2, 1], a[3, 1], a[4, 1], a[5, 1] = d, l2, l3, l4, l5
    a22 -= a21 * l2
    a32, a33 = a32 - a31 * l2, a33 - a31 * l3
    a42, a43, a44 = a42 - a41 * l2, a43 - a41 * l3, a44 - a41 * l4
    a52, a53, a54, a55 = a52 - a51 * l2, a53 - a51 * l3, a54 - a51 * l4, a55 - a51 * l5
    good &= a22 > 0.0
    d = 1.0 / a22
    l3, l4, l5 = a32 * d, a42 * d, a52 * d
    a[2, 2], a[3, 2], a[4, 2], a[5, 2] = d, l3, l4, l5
    a33 -= a32 * l3
    a43, a44 = a43 - a42 * l3, a44 - a42 * l4
    a53, a54, a55 = a53 - a52 * l3, a54 - a52 * l4, a55 - a52 * l5
    good &= a33 > 0.0
    d = 1.0 / a33
    l4, l5 = a43 * d, a53 * d
    a[3, 3], a[4, 3], a[5, 3] = d, l4, l5
    a44 -= a43 * l4
    a54, a55 = a54 - a53 * l4, a55 - a53 * l5
    good &= a44 > 0.0
    d = 1.0 / a44
    l5 = a54 * d
    a[4, 4], a[5, 4] = d, l5
    a55 -= a54 * l5
    good &= a55 > 0.0
    a[5, 5] = 1.0 / a55
    return good


@inlined
def solve(a, b):
    """Solve with the factors `a` (6, 6) of `factorise` for the right side `b` (6,), in place."""
    b0 = b[0]
    b1 = b[1] - a[1, 0] * b0
    b2 = b[2] - a[2, 0] * b0 - a[2, 1] * b1
    b3 = b[3] - a[3, 0] * b0 - a[3, 1] * b1 - a[3, 2] * b2
    b4 = b[4] - a[4, 0] * b0 - a[4, 1] * b1 - a[4, 2] * b2 - a[4, 3] * b3
    b5 = b[5] - a[5, 0] * b0 - a[5, 1] * b1 - a[5, 2] * b2 - a[5, 3] * b3 - a[5, 4] * b4
    b5 = b5 * a[5, 5]
    b4 = b4 * a[4, 4] - a[5, 4] * b5
    b3 = b3 * a[3, 3] - a[5, 3] * b5 - a[4, 3] * b4
    b2 = b2 * a[2, 2] - a[5, 2] * b5 - a[4, 2] * b4 - a[3, 2] * b3
    b1 = b1 * a[1, 1] - a[5, 1] * b5 - a[4, 1] * b4 - a[3, 1] * b3 - a[2, 1] * b2
    b0 = b0 * a[0, 0] - a[5, 0] * b5 - a[4, 0] * b4 - a[3, 0] * b3 - a[2, 0] * b2 - a[1, 0] * b1
    b[0], b[1], b[2], b[3], b[4], b[5] = b0, b1, b2, b3, b4, b5


@inlined
def add_head_motion(swimmer, r, motion, turning, moving):
    """Add the head's `motion` (6,), angular first, to the fields `turning` and `moving` (3, n) of a body that moves
    with it: + a, + b + a x r."""
    for k in range(swimmer.blocks):
        i = WIDTH * k
        x, y, z = three(r, 0, i)
        ax, ay, az = three(turning, 0, i)
        put_three(turning, 0, i, ax + motion[0], ay + motion[1], az + motion[2])
        bx, by, bz = three(moving, 0, i)
        put(moving, 0, i, bx + (motion[3] + motion[1] * z - motion[2] * y))
        put(moving, 1, i, by + (motion[4] + motion[2] * x - motion[0] * z))
        put(moving, 2, i, bz + (motion[5] + motion[0] * y - motion[1] * x))


@inlined
def add_head_twist(swimmer, fields, twist):
    """Add the motion of the head, `twist` (6,), to the velocities due to the change of shape: the true ones."""
    add_head_motion(swimmer, fields.r, twist, fields.omega, fields.v)


@inlined
def find_loads(swimmer, fields, twist):
    """Loads on the body from the true velocities: of the wake, w_tail of eq. (60), into `tail`, and of the drag along
    the body into `drag`; what they take and give into `losses`. `twist` (6,) is the head's."""
    R, r, omega, v, tail, drag = fields.R, fields.r, fields.omega, fields.v, fields.tail, fields.drag
    i = len(swimmer.x) - 1
    vx, vy, vz = v[0, i], v[1, i], v[2, i]
    v1 = swimmer.wake * (R[0, i] * vx + R[1, i] * vy + R[2, i] * vz)
    v2 = R[3, i] * vx + R[4, i] * vy + R[5, i] * vz
    v3 = R[6, i] * vx + R[7, i] * vy + R[8, i] * vz
    roll = R[0, i] * omega[0, i] + R[1, i] * omega[1, i] + R[2, i] * omega[2, i]
    p2, p3, s1 = swimmer.added2[i] * v2, swimmer.added3[i] * v3, swimmer.added_roll[i] * roll
    energy = 0.5 * swimmer.wake * (s1 * roll + p2 * v2 + p3 * v3)
    nx = v1 * (p2 * R[3, i] + p3 * R[6, i]) - energy * R[0, i]
    ny = v1 * (p2 * R[4, i] + p3 * R[7, i]) - energy * R[1, i]
    nz = v1 * (p2 * R[5, i] + p3 * R[8, i]) - energy * R[2, i]
    tail[0] = v1 * s1 * R[0, i] + r[1, i] * nz - r[2, i] * ny
    tail[1] = v1 * s1 * R[1, i] + r[2, i] * nx - r[0, i] * nz
    tail[2] = v1 * s1 * R[2, i] + r[0, i] * ny - r[1, i] * nx
    tail[3], tail[4], tail[5] = nx, ny, nz
    fields.losses[0], fields.losses[1], fields.losses[2] = 0.0, v1, energy
    for k in range(6):
        drag[k] = 0.0
    if swimmer.resistive:
        fields.losses[0] = add_resistive_loads(swimmer, fields, twist, drag)
    else:
        fields.kinks.number[0] = 0


@inlined
def configure(swimmer, drive, fields):
    """Configuration and shape velocities of the body at the instant of the time factors (the first loop of section
    7.1)."""
    combine_moments(drive.axis, drive.bend, fields.factor[0], swimmer.blocks, fields.bend)
    combine(drive.axis, drive.node, fields.factor[1], swimmer.blocks, fields.rate)
    turns(fields.bend, swimmer.blocks, fields.turn)
    orient(fields.turn, swimmer.blocks, fields.q, fields.R)
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

    False where the inertia is not positive definite. Leaves the factors of I_o in `fields.inertia`.
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
    add_head_twist(swimmer, fields, twist)
    find_loads(swimmer, fields, twist)
    for i in range(6):
        rates[i] = fields.tail[i] + fields.drag[i]
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
