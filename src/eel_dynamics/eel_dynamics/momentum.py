"""Inertia and momentum of body and water about the head, and the twist that goes with them (section 6), compiled.

The head moves as the momentum says: momentum = I_o twist + what the change of shape alone carries.
"""

import numpy as np

from .compiled import inlined
from .lanes import WIDTH, spread, take, total
from .vectors import cross, dot, three


@inlined
def turning_sums(swimmer, fields):
    """Of I_o of section 6, the inertia of body and water about the head, what the turn of the head takes part in, each
    as lanes that are still to be added up: angular momentum by Omega (xx, xy, xz, yy, yz, zz), and by V (9,), row by
    row.

    With b, c = t2, t3: M = m + m2 b b^T + m3 c c^T along the body, and about the head
    r x M x r^T = m (r.r - r r^T) + m2 (r x b)(r x b)^T + m3 (r x c)(r x c)^T.
    """
    R, r = fields.R, fields.r
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
        px, py, pz = m2 * ux, m2 * uy, m2 * uz
        qx, qy, qz = m3 * wx, m3 * wy, m3 * wz
        mx, my, mz = m * x, m * y, m * z
        cxx += px * bx + qx * cx
        cxy += px * by + qx * cy - mz
        cxz += px * bz + qx * cz + my
        cyx += py * bx + qy * cx + mz
        cyy += py * by + qy * cy
        cyz += py * bz + qy * cz - mx
        czx += pz * bx + qz * cx - my
        czy += pz * by + qz * cy + mx
        czz += pz * bz + qz * cz
        j = weight * take(swimmer.inertia1, i)
        j2, j3 = weight * take(swimmer.inertia2, i) - j, weight * take(swimmer.inertia3, i) - j
        fx, fy, fz = j2 * bx, j2 * by, j2 * bz
        gx, gy, gz = j3 * cx, j3 * cy, j3 * cz
        wxx += j + fx * bx + gx * cx + px * ux + qx * wx + (my * y + mz * z)
        wxy += fx * by + gx * cy + px * uy + qx * wy - mx * y
        wxz += fx * bz + gx * cz + px * uz + qx * wz - mx * z
        wyy += j + fy * by + gy * cy + py * uy + qy * wy + (mx * x + mz * z)
        wyz += fy * bz + gy * cz + py * uz + qy * wz - my * z
        wzz += j + fz * bz + gz * cz + pz * uz + qz * wz + (mx * x + my * y)
    return (wxx, wxy, wxz, wyy, wyz, wzz), (cxx, cxy, cxz, cyx, cyy, cyz, czx, czy, czz)


@inlined
def moving_sums(swimmer, fields):
    """Of body and water, without the nose's m_o, each as lanes that are still to be added up: of I_o the linear
    momentum by V (xx, xy, xz, yy, yz, zz); and the momentum (6,) about the head due to `omega`, `v`. Apart from
    `turning_sums`: the sums of both together are more than a processor has registers."""
    R, r, omega, v = fields.R, fields.r, fields.omega, fields.v
    vxx = vxy = vxz = vyy = vyz = vzz = spread(0.0)
    lx = ly = lz = px = py = pz = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        m = weight * take(swimmer.mass, i)
        m2, m3 = weight * take(swimmer.added2, i), weight * take(swimmer.added3, i)
        bx, by, bz = three(R, 3, i)
        cx, cy, cz = three(R, 6, i)
        fx, fy, fz = m2 * bx, m2 * by, m2 * bz
        gx, gy, gz = m3 * cx, m3 * cy, m3 * cz
        vxx += m + fx * bx + gx * cx
        vxy += fx * by + gx * cy
        vxz += fx * bz + gx * cz
        vyy += m + fy * by + gy * cy
        vyz += fy * bz + gy * cz
        vzz += m + fz * bz + gz * cz
        vx, vy, vz = three(v, 0, i)
        v2, v3 = dot(bx, by, bz, vx, vy, vz), dot(cx, cy, cz, vx, vy, vz)
        qx = m * vx + v2 * fx + v3 * gx
        qy = m * vy + v2 * fy + v3 * gy
        qz = m * vz + v2 * fz + v3 * gz
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
    return (vxx, vxy, vxz, vyy, vyz, vzz), (lx, ly, lz, px, py, pz)


@inlined
def lower_triangle(turn, coupling, linear, nose):
    """Lower triangle (21,) of I_o, row by row, from the sums; `nose` [kg]: the nose's m_o."""
    wxx, wxy, wxz, wyy, wyz, wzz = turn
    cxx, cxy, cxz, cyx, cyy, cyz, czx, czy, czz = coupling
    vxx, vxy, vxz, vyy, vyz, vzz = linear
    # from the fourth row on: the momentum P by Omega, (r x M)^T
    return (
        *(wxx, wxy, wyy, wxz, wyz, wzz),
        *(cxx, cyx, czx, vxx + nose),
        *(cxy, cyy, czy, vxy, vyy),
        *(cxz, cyz, czz, vxz, vyz, vzz),
    )


@inlined
def three_totals(a, b, c):
    """Sums of the lanes."""
    return total(a), total(b), total(c)


@inlined
def six_totals(a, b, c, d, e, f):
    """Sums of the lanes."""
    return total(a), total(b), total(c), total(d), total(e), total(f)


@inlined
def sums_of(swimmer, fields):
    """I_o of section 6, the nose's m_o included: its lower triangle (21,), row by row; and the momentum (6,) of body
    and water about the head due to `omega`, `v` (the nose's m_o not in it)."""
    turn, coupling = turning_sums(swimmer, fields)
    linear, momentum = moving_sums(swimmer, fields)
    coupling = (*six_totals(*coupling[:6]), *three_totals(*coupling[6:]))
    inertia = lower_triangle(six_totals(*turn), coupling, six_totals(*linear), swimmer.nose_mass)
    return inertia, six_totals(*momentum)


@inlined
def factors_of(a):
    """Factors of a symmetric positive definite matrix (6, 6) = L D L^T from its lower triangle `a` (21,), row
    by row, in its place: L below the diagonal, 1/D on it."""
    a00, a10, a11, a20, a21, a22, a30, a31, a32, a33 = a[:10]
    a40, a41, a42, a43, a44, a50, a51, a52, a53, a54, a55 = a[10:]
    d0 = 1.0 / a00
    l1, l2, l3, l4, l5 = a10 * d0, a20 * d0, a30 * d0, a40 * d0, a50 * d0
    a11 = a11 - a10 * l1
    a21, a22 = a21 - a20 * l1, a22 - a20 * l2
    a31, a32, a33 = a31 - a30 * l1, a32 - a30 * l2, a33 - a30 * l3
    a41, a42, a43, a44 = a41 - a40 * l1, a42 - a40 * l2, a43 - a40 * l3, a44 - a40 * l4
    a51, a52, a53, a54, a55 = a51 - a50 * l1, a52 - a50 * l2, a53 - a50 * l3, a54 - a50 * l4, a55 - a50 * l5
    d1 = 1.0 / a11
    m2, m3, m4, m5 = a21 * d1, a31 * d1, a41 * d1, a51 * d1
    a22 = a22 - a21 * m2
    a32, a33 = a32 - a31 * m2, a33 - a31 * m3
    a42, a43, a44 = a42 - a41 * m2, a43 - a41 * m3, a44 - a41 * m4
    a52, a53, a54, a55 = a52 - a51 * m2, a53 - a51 * m3, a54 - a51 * m4, a55 - a51 * m5
    d2 = 1.0 / a22
    n3, n4, n5 = a32 * d2, a42 * d2, a52 * d2
    a33 = a33 - a32 * n3
    a43, a44 = a43 - a42 * n3, a44 - a42 * n4
    a53, a54, a55 = a53 - a52 * n3, a54 - a52 * n4, a55 - a52 * n5
    d3 = 1.0 / a33
    o4, o5 = a43 * d3, a53 * d3
    a44 = a44 - a43 * o4
    a54, a55 = a54 - a53 * o4, a55 - a53 * o5
    d4 = 1.0 / a44
    p5 = a54 * d4
    a55 = a55 - a54 * p5
    d5 = 1.0 / a55
    return (
        *(d0,),
        *(l1, d1),
        *(l2, m2, d2),
        *(l3, m3, n3, d3),
        *(l4, m4, n4, o4, d4),
        *(l5, m5, n5, o5, p5, d5),
    )


@inlined
def is_definite(f):
    """Whether the matrix of the factors `f` is positive definite."""
    good = True
    for each in (f[0], f[2], f[5], f[9], f[14], f[20]):
        good &= (each > 0.0) & (each < np.inf)
    return good


@inlined
def solved(f, b):
    """Solution (6,) with the factors `f` of `factors_of` for the right side `b` (6,)."""
    d0, l1, d1, l2, m2, d2, l3, m3, n3, d3 = f[:10]
    l4, m4, n4, o4, d4, l5, m5, n5, o5, p5, d5 = f[10:]
    b0, b1, b2, b3, b4, b5 = b
    b1 = b1 - l1 * b0
    b2 = b2 - l2 * b0 - m2 * b1
    b3 = b3 - l3 * b0 - m3 * b1 - n3 * b2
    b4 = b4 - l4 * b0 - m4 * b1 - n4 * b2 - o4 * b3
    b5 = b5 - l5 * b0 - m5 * b1 - n5 * b2 - o5 * b3 - p5 * b4
    b5 = b5 * d5
    b4 = b4 * d4 - p5 * b5
    b3 = b3 * d3 - o5 * b5 - o4 * b4
    b2 = b2 * d2 - n5 * b5 - n4 * b4 - n3 * b3
    b1 = b1 * d1 - m5 * b5 - m4 * b4 - m3 * b3 - m2 * b2
    b0 = b0 * d0 - l5 * b5 - l4 * b4 - l3 * b3 - l2 * b2 - l1 * b1
    return b0, b1, b2, b3, b4, b5


@inlined
def triangle(a):
    """Lower triangle (21,) of a matrix (6, 6), row by row."""
    return (
        *(a[0, 0], a[1, 0], a[1, 1], a[2, 0], a[2, 1], a[2, 2]),
        *(a[3, 0], a[3, 1], a[3, 2], a[3, 3]),
        *(a[4, 0], a[4, 1], a[4, 2], a[4, 3], a[4, 4]),
        *(a[5, 0], a[5, 1], a[5, 2], a[5, 3], a[5, 4], a[5, 5]),
    )


@inlined
def put_triangle(a, values):
    """Store the lower triangle of a matrix (6, 6)."""
    a[0, 0], a[1, 0], a[1, 1], a[2, 0], a[2, 1], a[2, 2] = values[:6]
    a[3, 0], a[3, 1], a[3, 2], a[3, 3] = values[6:10]
    a[4, 0], a[4, 1], a[4, 2], a[4, 3], a[4, 4] = values[10:15]
    a[5, 0], a[5, 1], a[5, 2], a[5, 3], a[5, 4], a[5, 5] = values[15:]


@inlined
def solve(a, b):
    """Solve with the factors kept in the lower triangle of `a` (6, 6) for the right side `b` (6,), in place."""
    b[0], b[1], b[2], b[3], b[4], b[5] = solved(triangle(a), (b[0], b[1], b[2], b[3], b[4], b[5]))


@inlined
def momentum_of_twist(swimmer, fields, twist, momentum):
    """Momentum (6,) of body, water and nose for the head's `twist` (6,), in a configured body."""
    inertia = fields.inertia
    sums, shape = sums_of(swimmer, fields)
    put_triangle(inertia, sums)
    for i in range(6):
        momentum[i] = shape[i]
        for j in range(6):
            momentum[i] += (inertia[i, j] if j <= i else inertia[j, i]) * twist[j]


@inlined
def twist_of_momentum(swimmer, fields, momentum, twist):
    """The head's `twist` (6,) in a configured body of the given `momentum` (6,): I_o^-1 times what the shape's change
    leaves.

    False where the inertia is not positive definite. Leaves the factors of I_o in `fields.inertia`.
    """
    inertia, (s0, s1, s2, s3, s4, s5) = sums_of(swimmer, fields)
    factors = factors_of(inertia)
    put_triangle(fields.inertia, factors)
    twist[0], twist[1], twist[2], twist[3], twist[4], twist[5] = solved(
        factors,
        (
            *(momentum[0] - s0, momentum[1] - s1, momentum[2] - s2),
            *(momentum[3] - s3, momentum[4] - s4, momentum[5] - s5),
        ),
    )
    return is_definite(factors)
