"""Drag of the water along the body (section 7.2.1), compiled.

    n = -1/2 rho_f (k1 V1|V1|, k2 V2|V2|, k3 V3|V3|)        c1 = -1/2 rho_f k4 Omega1|Omega1|

What of it is not smooth along the body is integrated exactly: `kinks`.
"""

import numpy as np

from .compiled import inlined, shared
from .kinks import AXIAL, BLENDED, HEIGHT, LAMINAR, PRINTED, RATIO, ROLL, SIDE, find_steps
from .lanes import WIDTH, put, root, root_guess, signed, size, spread, take, total, where
from .vectors import cross, from_section, in_section, put_three, three

NOISE = 1e-7  # a sign that changes within this part of the tail's speed moves loads by its square: round-off


@inlined
def inverse_fifth_root(x):
    """x^(-1/5) of eight positive numbers to round-off: from a guess within 4 per cent by two steps of order 4, the
    binomial series of (1 - e)^(-1/5) with e = 1 - x y^5."""
    y = root_guess(x)
    for _ in range(2):
        square = y * y
        e = 1.0 - x * (square * square * y)
        y += y * e * (0.2 + e * (0.12 + e * 0.088))
    return y


@inlined
def turbulent_part(law, transition, speed):
    """Part of the turbulent law in the friction of a section for the axial speed |V1| [m/s]; `transition` [m/s]: where
    Re = |V1| X/nu is 8e4 (section 7.2.1)."""
    if law == PRINTED:
        return 1.0 if speed > transition else 0.0
    if law != BLENDED or speed <= 0.5 * transition:
        return 0.0
    if speed >= 2.0 * transition:
        return 1.0
    part = np.log(2.0 * speed / transition) / np.log(4.0)  # f_r(ln Re; ln 4e4, ln 1.6e5), eq. (64)
    return part - np.sin(2.0 * np.pi * part) / (2.0 * np.pi)


@inlined
def section_speeds(swimmer, fields):
    """V1, V2, V3 and Omega1 of the nodes, from the true velocities."""
    R, omega, v, speed = fields.R, fields.omega, fields.v, fields.speed
    for k in range(swimmer.blocks):
        i = WIDTH * k
        v1, v2, v3 = in_section(R, i, *three(v, 0, i))
        roll, _, _ = in_section(R, i, *three(omega, 0, i))
        put(speed, AXIAL, i, v1)
        put(speed, SIDE, i, v2)
        put(speed, HEIGHT, i, v3)
        put(speed, ROLL, i, roll)


@inlined
def about_head(R, r, i, c1, n1, n2, n3):
    """Wrenches about the head of eight sections from i on, each with a torque about axis 1 and a force in its axes."""
    x, y, z = three(r, 0, i)
    ax, ay, az = three(R, 0, i)
    nx, ny, nz = from_section(R, i, n1, n2, n3)
    tx, ty, tz = cross(x, y, z, nx, ny, nz)
    return c1 * ax + tx, c1 * ay + ty, c1 * az + tz, nx, ny, nz


@inlined
def rub(swimmer, fields):
    """Friction of the nodes by the laminar law and what the turbulent one adds, `rubbing` (2, n) [kg/m/s]: per length
    and V1; and the part of the turbulent law, `part` (n,)."""
    speed, rubbing, part = fields.speed, fields.rubbing, fields.part
    none, whole = spread(0.0), spread(1.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        axial = size(take(speed, AXIAL, i))
        laminar = take(swimmer.laminar, i) * root(axial)
        put(rubbing, 0, i, laminar)
        if swimmer.friction == LAMINAR:
            put(rubbing, 1, i, none)
            put(part, i, none)
        else:
            ratio = axial * take(swimmer.reynolds, i)
            turbulent = take(swimmer.turbulent, i) * ratio * inverse_fifth_root(ratio + 1e-30)
            put(rubbing, 1, i, turbulent - laminar)
            put(speed, RATIO, i, ratio - 1.0)
            put(part, i, where(ratio > 1.0, whole, none))
    if swimmer.friction == BLENDED:
        for i in range(WIDTH * swimmer.blocks):
            part[i] = turbulent_part(BLENDED, 1.0, speed[RATIO, i] + 1.0)


@inlined
def share_loads(swimmer, fields):
    """Weights `share` (4, n) [m] that integrate the loads, as if they had no steps: of the turbulent law's excess over
    the laminar one, and with the sign of their speed, of cross flow and roll."""
    speed, share, part = fields.speed, fields.share, fields.part
    for k in range(swimmer.blocks):
        i = WIDTH * k
        weight = take(swimmer.weight, i)
        put(share, 0, i, weight * take(part, i))
        put(share, SIDE, i, signed(weight, take(speed, SIDE, i)))
        put(share, HEIGHT, i, signed(weight, take(speed, HEIGHT, i)))
        put(share, ROLL, i, signed(weight, take(speed, ROLL, i)))


@inlined
def share_steps(swimmer, fields, twist):
    """Have the weights integrate the steps of the loads too (`kinks`). `twist` (6,): of the head."""
    speed = fields.speed
    tail = len(swimmer.x) - 1
    spin = abs(fields.omega[0, tail]) + abs(fields.omega[1, tail]) + abs(fields.omega[2, tail])
    noise = NOISE * (abs(speed[AXIAL, tail]) + abs(speed[SIDE, tail]) + abs(speed[HEIGHT, tail]))
    find_steps(swimmer, fields, (twist[4], twist[5], twist[0]), noise, NOISE * spin, False)


@inlined
def resistive_sums(swimmer, fields):
    """Wrench (6,) of the drag along the body about the head, and its power [W], each as lanes that are still to be
    added up."""
    R, r, speed, share = fields.R, fields.r, fields.speed, fields.share
    tx = ty = tz = fx = fy = fz = power = spread(0.0)
    for k in range(swimmer.blocks):
        i = WIDTH * k
        v1, v2, v3, roll = take(speed, AXIAL, i), take(speed, SIDE, i), take(speed, HEIGHT, i), take(speed, ROLL, i)
        rubbing = take(swimmer.weight, i) * take(fields.rubbing, 0, i) + take(share, 0, i) * take(fields.rubbing, 1, i)
        n1 = -rubbing * v1
        n2 = -take(share, SIDE, i) * take(swimmer.drag2, i) * v2 * v2
        n3 = -take(share, HEIGHT, i) * take(swimmer.drag3, i) * v3 * v3
        c1 = -take(share, ROLL, i) * take(swimmer.drag_roll, i) * roll * roll
        ux, uy, uz, nx, ny, nz = about_head(R, r, i, c1, n1, n2, n3)
        tx += ux
        ty += uy
        tz += uz
        fx += nx
        fy += ny
        fz += nz
        power += n1 * v1 + n2 * v2 + n3 * v3 + c1 * roll
    return tx, ty, tz, fx, fy, fz, power


@shared
def add_resistive_loads(swimmer, fields, twist, wrench):
    """Add the drag along the body to `wrench` (6,), on the body (section 7.2.1), from the true velocities; `twist` (6,)
    is the head's. Returns its power [W]."""
    section_speeds(swimmer, fields)
    rub(swimmer, fields)
    share_loads(swimmer, fields)
    share_steps(swimmer, fields, twist)
    tx, ty, tz, fx, fy, fz, power = resistive_sums(swimmer, fields)
    wrench[0] += total(tx)
    wrench[1] += total(ty)
    wrench[2] += total(tz)
    wrench[3] += total(fx)
    wrench[4] += total(fy)
    wrench[5] += total(fz)
    return total(power)


@inlined
def add_resistance(swimmer, fields, density):
    """Add the resistance (the drag's opposite) at the nodes, per length about the head, to `density` (6, n)."""
    R, r, speed, rubbing = fields.R, fields.r, fields.speed, fields.rubbing
    for k in range(swimmer.blocks):
        i = WIDTH * k
        v1, v2, v3, roll = take(speed, AXIAL, i), take(speed, SIDE, i), take(speed, HEIGHT, i), take(speed, ROLL, i)
        n1 = (take(rubbing, 0, i) + take(fields.part, i) * take(rubbing, 1, i)) * v1
        n2 = take(swimmer.drag2, i) * size(v2) * v2
        n3 = take(swimmer.drag3, i) * size(v3) * v3
        c1 = take(swimmer.drag_roll, i) * size(roll) * roll
        ux, uy, uz, nx, ny, nz = about_head(R, r, i, c1, n1, n2, n3)
        tx, ty, tz = three(density, 0, i)
        fx, fy, fz = three(density, 3, i)
        put_three(density, 0, i, tx + ux, ty + uy, tz + uz)
        put_three(density, 3, i, fx + nx, fy + ny, fz + nz)
