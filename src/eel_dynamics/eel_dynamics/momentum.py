"""Inertia and momentum of body and water about the head, and the twist that goes with them (section 6), compiled.

The head moves as the momentum says: momentum = I_o twist + what the change of shape alone carries.
"""

from .compiled import inlined
from .lanes import WIDTH, spread, take, total
from .vectors import cross, dot, three


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
