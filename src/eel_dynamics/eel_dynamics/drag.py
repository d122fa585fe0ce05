"""Drag of the water along the body (section 7.2.1), with what makes it not smooth integrated exactly, compiled.

    n = -1/2 rho_f (k1 V1|V1|, k2 V2|V2|, k3 V3|V3|)        c1 = -1/2 rho_f k4 Omega1|Omega1|

V|V| has a kink where V changes sign, and the printed friction law a jump where Re = 8e4: in the middle of a panel
either would take the quadrature its order. Each such load is s(X) G(X) with G smooth and s a staircase, so

    integral of s G = s_0 integral of G + sum_j step_j (integral of G from X_j to the end),

and the integrals to X_j come from the polynomial through the panel's nodes, as all others do. What a step changes is
kept as weights of the nodes (`share`), and as a list of steps for the integrals up to a station.
"""

import math
from typing import NamedTuple

import numpy as np

from .compiled import compiled, inlined

ZERO, ONE = np.uintp(0), np.uintp(1)  # indices that are unsigned need no test for Python's negative ones
PRINTED, LAMINAR, BLENDED = 0, 1, 2  # laws of friction, as in the scene
AXIAL, SIDE, HEIGHT, ROLL, RATIO = (np.uintp(k) for k in range(5))  # V1, V2, V3, Omega1, Re/8e4 - 1
DEGREE = np.arange(1.0, 100.0)  # of Legendre polynomials: P_(n+1) = UPPER z P_n - LOWER P_(n-1)
UPPER, LOWER, INTEGRAL = (2.0 * DEGREE + 1.0) / (DEGREE + 1.0), DEGREE / (DEGREE + 1.0), 0.5 / (2.0 * DEGREE + 1.0)
NOISE = 1e-7  # a sign that changes within this part of the tail's speed moves loads by its square: round-off


class Panels(NamedTuple):
    """What the search for kinks needs of the constants of a run (`Swimmer`), under the same names."""

    weight: np.ndarray
    count: np.ndarray
    fraction: np.ndarray
    barycentric: np.ndarray
    series: np.ndarray


@inlined
def fifth_root(x):
    """x^(1/5) to round-off for x from 1e-8 to 1e8, without branches: a rational start, two steps of Halley."""
    t = np.sqrt(np.sqrt(np.sqrt(np.sqrt(x))))
    y = t * t * t * (0.4 + 0.6 * t) / (0.6 + 0.4 * t)
    for _ in range(2):
        square = y * y
        fifth = square * square * y
        y *= (4.0 * fifth + 6.0 * x) / (6.0 * fifth + 4.0 * x)
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
def friction(laminar, turbulent, transition, part, speed):
    """1/2 rho_f k1 |V1| [kg/m/s] of a section for the axial speed |V1| [m/s], `part` of it by the turbulent law."""
    force = (1.0 - part) * laminar * np.sqrt(speed)
    if part > 0.0:
        force += part * turbulent * (speed / transition) ** 0.8
    return force


@inlined
def section_speeds(fields):
    """V1, V2, V3 and Omega1 of the nodes, from the true velocities."""
    R, omega, v, speed = fields.R, fields.omega, fields.v, fields.speed
    for i in range(R.shape[1]):
        x, y, z = v[0, i], v[1, i], v[2, i]
        speed[AXIAL, i] = R[0, i] * x + R[1, i] * y + R[2, i] * z
        speed[SIDE, i] = R[3, i] * x + R[4, i] * y + R[5, i] * z
        speed[HEIGHT, i] = R[6, i] * x + R[7, i] * y + R[8, i] * z
        speed[ROLL, i] = R[0, i] * omega[0, i] + R[1, i] * omega[1, i] + R[2, i] * omega[2, i]


@inlined
def rub(swimmer, fields):
    """Friction of the nodes by the laminar law and what the turbulent one adds, `rubbing` (2, n) [kg/m/s]: per length
    and V1; and the part of the turbulent law, `part` (n,)."""
    speed, rubbing, part = fields.speed, fields.rubbing, fields.part
    n = speed.shape[1]
    if swimmer.friction == LAMINAR:
        for i in range(n):
            rubbing[0, i] = swimmer.laminar[i] * np.sqrt(abs(speed[AXIAL, i]))
            rubbing[1, i] = 0.0
            part[i] = 0.0
        return
    for i in range(n):
        ratio = abs(speed[AXIAL, i]) / swimmer.transition[i]
        rubbing[0, i] = swimmer.laminar[i] * np.sqrt(abs(speed[AXIAL, i]))
        rubbing[1, i] = swimmer.turbulent[i] * ratio / fifth_root(ratio + 1e-30) - rubbing[0, i]
        speed[RATIO, i] = ratio - 1.0
        part[i] = 1.0 if ratio > 1.0 else 0.0
    if swimmer.friction == BLENDED:
        for i in range(n):
            part[i] = turbulent_part(BLENDED, swimmer.transition[i], abs(speed[AXIAL, i]))


@inlined
def value_at(swimmer, values, begin, count, t):
    """At the fraction `t` of a panel, the polynomial through its nodes' `values`, by the barycentric formula."""
    above = below = 0.0
    for k in range(count):
        part = swimmer.barycentric[begin + k] / (t - swimmer.fraction[begin + k])
        above += part * values[begin + k]
        below += part
    return above / below


@inlined
def zero_between(swimmer, values, begin, count, i, before, exact):
    """Fraction of the panel at which the polynomial through `values` is zero, between node i and the one before it
    (value `before`). An error e moves the load of V|V| by e^3, so this need not be `exact`."""
    a = swimmer.fraction[i - ONE] if i > begin else 0.0
    b = swimmer.fraction[i]
    f, g = before, values[i]
    enough = (1e-12 if exact else 1e-4) * (abs(f) + abs(g))
    t = b
    for _ in range(8):
        t = (a * g - b * f) / (g - f)
        if t <= a or t >= b:
            break
        value = value_at(swimmer, values, begin, count, t)
        if not abs(value) > enough:
            break
        if (value > 0.0) == (g > 0.0):
            b, g = t, value
            f *= 0.6
        else:
            a, f = t, value
            g *= 0.6
    return t


@inlined
def integrals_upto(swimmer, begin, count, t, row):
    """Weights `row` (count,) [m] of the panel's nodes for the integral from its start to its fraction `t`."""
    for k in range(count):
        row[k] = t * swimmer.series[ZERO, begin + k]
    z = 2.0 * t - 1.0
    low, middle = 1.0, z  # Legendre polynomials
    for m in range(count - ONE):
        high = UPPER[m] * z * middle - LOWER[m] * low
        integral = INTEGRAL[m] * (high - low)
        for k in range(count):
            row[k] += integral * swimmer.series[m + ONE, begin + k]
        low, middle = middle, high


@compiled
def note_steps(swimmer, kinks, kind, values, start, noise, share):
    """Find where `values` (n,), the row `kind` of the speeds, change their sign along the body (`start`: at the nose),
    note the steps of the load there, and have its weights `share` (n,) integrate it."""
    before = start
    begin, count = ZERO, swimmer.count[0]
    for i in range(np.uintp(len(values))):
        if i >= begin + count:
            begin += count
            count = swimmer.count[i]
        value = values[i]
        if (value >= 0.0) != (before >= 0.0) and abs(value - before) > noise:
            j = kinks.number[0]
            if j < len(kinks.kind):
                kinks.number[0] = j + 1
                exact = kind == RATIO
                t = zero_between(swimmer, values, begin, count, i, before, exact)
                step = (1.0 if exact else 2.0) * (1.0 if value >= 0.0 else -1.0)
                row = kinks.row[j]
                integrals_upto(swimmer, begin, count, t, row)
                kinks.kind[j], kinks.begin[j], kinks.fraction[j], kinks.step[j] = kind, begin, t, step
                for k in range(count):
                    share[begin + k] -= step * row[k]
                    if begin + k < i:
                        share[begin + k] += step * swimmer.weight[begin + k]
        before = value


@inlined
def find_steps(swimmer, fields, kind, start, noise):
    """Note the steps of the load that goes with row `kind` of `speed`; those below `noise` are round-off."""
    values = fields.speed[kind]
    sign = start >= 0.0
    for i in range(len(values)):
        if (values[i] >= 0.0) != sign:
            panels = Panels(swimmer.weight, swimmer.count, swimmer.fraction, swimmer.barycentric, swimmer.series)
            share = fields.share[ZERO if kind == RATIO else kind]
            note_steps(panels, fields.kinks, kind, values, start, noise, share)
            return


@inlined
def share_loads(swimmer, fields, twist):
    """Weights `share` (4, n) [m] that integrate the loads: of the turbulent law's excess over the laminar one, and with
    the sign of their speed, of cross flow and roll. `twist` (6,): of the head."""
    speed, share, part = fields.speed, fields.share, fields.part
    n = speed.shape[1]
    for i in range(n):
        weight = swimmer.weight[i]
        share[0, i] = weight * part[i]
        share[SIDE, i] = math.copysign(weight, speed[SIDE, i])
        share[HEIGHT, i] = math.copysign(weight, speed[HEIGHT, i])
        share[ROLL, i] = math.copysign(weight, speed[ROLL, i])
    fields.kinks.number[0] = 0
    tail = n - 1
    spin = abs(fields.omega[0, tail]) + abs(fields.omega[1, tail]) + abs(fields.omega[2, tail])
    noise = NOISE * (abs(speed[AXIAL, tail]) + abs(speed[SIDE, tail]) + abs(speed[HEIGHT, tail]))
    find_steps(swimmer, fields, SIDE, twist[4], noise)
    find_steps(swimmer, fields, HEIGHT, twist[5], noise)
    find_steps(swimmer, fields, ROLL, twist[0], NOISE * spin)
    if swimmer.friction == PRINTED:
        find_steps(swimmer, fields, RATIO, -1.0, 0.0)


@inlined
def add_resistive_loads(swimmer, fields, twist, wrench):
    """Add the drag along the body to `wrench` (6,), on the body (section 7.2.1), from the true velocities; `twist` (6,)
    is the head's. Returns its power [W]."""
    section_speeds(fields)
    rub(swimmer, fields)
    share_loads(swimmer, fields, twist)
    R, r, speed, share = fields.R, fields.r, fields.speed, fields.share
    tx = ty = tz = fx = fy = fz = power = 0.0
    for i in range(R.shape[1]):
        v1, v2, v3, roll = speed[AXIAL, i], speed[SIDE, i], speed[HEIGHT, i], speed[ROLL, i]
        n1 = -(swimmer.weight[i] * fields.rubbing[0, i] + share[0, i] * fields.rubbing[1, i]) * v1
        n2 = -share[SIDE, i] * swimmer.drag2[i] * v2 * v2
        n3 = -share[HEIGHT, i] * swimmer.drag3[i] * v3 * v3
        c1 = -share[ROLL, i] * swimmer.drag_roll[i] * roll * roll
        nx = R[0, i] * n1 + R[3, i] * n2 + R[6, i] * n3
        ny = R[1, i] * n1 + R[4, i] * n2 + R[7, i] * n3
        nz = R[2, i] * n1 + R[5, i] * n2 + R[8, i] * n3
        fx += nx
        fy += ny
        fz += nz
        tx += c1 * R[0, i] + r[1, i] * nz - r[2, i] * ny
        ty += c1 * R[1, i] + r[2, i] * nx - r[0, i] * nz
        tz += c1 * R[2, i] + r[0, i] * ny - r[1, i] * nx
        power += n1 * v1 + n2 * v2 + n3 * v3 + c1 * roll
    wrench[0] += tx
    wrench[1] += ty
    wrench[2] += tz
    wrench[3] += fx
    wrench[4] += fy
    wrench[5] += fz
    return power


@inlined
def wrench_density(fields, i, c1, n1, n2, n3, density):
    """Add the drag of section i, the torque c1 and forces n1, n2, n3 in its axes, to `density` (6,) about the head."""
    R, r = fields.R, fields.r
    nx = R[0, i] * n1 + R[3, i] * n2 + R[6, i] * n3
    ny = R[1, i] * n1 + R[4, i] * n2 + R[7, i] * n3
    nz = R[2, i] * n1 + R[5, i] * n2 + R[8, i] * n3
    x, y, z = r[0, i], r[1, i], r[2, i]
    density[0] += c1 * R[0, i] + y * nz - z * ny
    density[1] += c1 * R[1, i] + z * nx - x * nz
    density[2] += c1 * R[2, i] + x * ny - y * nx
    density[3] += nx
    density[4] += ny
    density[5] += nz


@compiled
def add_resistance(swimmer, fields, density):
    """Add the resistance (the drag's opposite) at the nodes, per length about the head, to `density` (6, n)."""
    speed, rubbing = fields.speed, fields.rubbing
    for i in range(density.shape[1]):
        v1, v2, v3, roll = speed[AXIAL, i], speed[SIDE, i], speed[HEIGHT, i], speed[ROLL, i]
        wrench_density(
            fields,
            i,
            swimmer.drag_roll[i] * abs(roll) * roll,
            (rubbing[0, i] + fields.part[i] * rubbing[1, i]) * v1,
            swimmer.drag2[i] * abs(v2) * v2,
            swimmer.drag3[i] * abs(v3) * v3,
            density[:, i],
        )


@compiled
def add_steps(swimmer, fields, section, nodal, result):
    """Put right the integrals `result` (6, M) up to the points of `section` of the resistance at the nodes: what the
    steps of the loads change, in its panel and (where `nodal`: stations go on from nodes put right) behind it."""
    kinks, speed, scratch = fields.kinks, fields.speed, fields.integrand
    for j in range(kinks.number[0]):
        begin, kind, step, row, at = kinks.begin[j], kinks.kind[j], kinks.step[j], kinks.row[j], kinks.fraction[j]
        count = swimmer.count[begin]
        whole = fields.wrench
        whole[:] = 0.0
        for k in range(count):
            node = begin + k
            v1, v2, v3, roll = speed[AXIAL, node], speed[SIDE, node], speed[HEIGHT, node], speed[ROLL, node]
            scratch[:, node] = 0.0
            wrench_density(
                fields,
                node,
                swimmer.drag_roll[node] * roll * roll if kind == ROLL else 0.0,
                fields.rubbing[1, node] * v1 if kind == RATIO else 0.0,
                swimmer.drag2[node] * v2 * v2 if kind == SIDE else 0.0,
                swimmer.drag3[node] * v3 * v3 if kind == HEIGHT else 0.0,
                scratch[:, node],
            )
            change = step * ((swimmer.weight[node] if swimmer.fraction[node] < at else 0.0) - row[k])
            for c in range(6):
                whole[c] += change * scratch[c, node]
        for i in range(result.shape[1]):
            if section.first[i] > begin:
                if not nodal:
                    continue
                for c in range(6):
                    result[c, i] += whole[c]
            elif section.first[i] == begin:
                behind = section.fraction[i] >= at
                for k in range(count):
                    node = begin + k
                    ahead = swimmer.fraction[node] < at
                    change = 0.0
                    if behind:
                        change = (section.matrix[i, k] if ahead else 0.0) - row[k]
                    elif not ahead:
                        change = -section.matrix[i, k]
                    for c in range(6):
                        result[c, i] += step * change * scratch[c, node]
