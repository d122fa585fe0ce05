"""Where the drag along the body is not smooth at an instant, and its integrals there, compiled.

V|V| has a kink where V changes sign, and the printed friction law a jump where Re = 8e4: in the middle of a panel
either would take the quadrature its order. Each such load is s(X) G(X) with G smooth and s a staircase, so

    integral of s G = s_0 integral of G + sum_j step_j (integral of G from X_j to the end),

and the integrals to X_j come from the polynomial through the panel's nodes, as all others do. What a step changes is
kept as weights of the nodes (`share`), and as a list of steps (`fields.Kinks`) for the integrals up to a point.
"""

import numpy as np

from .compiled import inlined
from .lanes import WIDTH, below, bits, fused, lowest, put, spread, take, total, where
from .vectors import cross, three

ZERO, ONE, TWO = (np.uintp(k) for k in range(3))  # indices that are unsigned need no test for Python's negative ones
PRINTED, LAMINAR, BLENDED = 0, 1, 2  # laws of friction, as in the scene
AXIAL, SIDE, HEIGHT, ROLL, RATIO = (np.uintp(k) for k in range(5))  # V1, V2, V3, Omega1, Re/8e4 - 1
WATCHED = {"all": SIDE, "jumps": RATIO, "none": RATIO + ONE}  # the first row whose changes of sign are looked for
DEGREE = np.arange(1.0, 100.0)  # of Legendre polynomials: P_(n+1) = UPPER z P_n - LOWER P_(n-1)
UPPER, LOWER, INTEGRAL = (2.0 * DEGREE + 1.0) / (DEGREE + 1.0), DEGREE / (DEGREE + 1.0), 0.5 / (2.0 * DEGREE + 1.0)


@inlined
def value_and_slope(swimmer, values, kind, begin, count, t):
    """At the fraction `t` of a panel, the polynomial through its nodes' `values` and its derivative, by the barycentric
    formula (Berrut and Trefethen, SIAM Review 46 (2004), eqs 4.2 and 9.4)."""
    none, far = spread(0.0), spread(2.0)
    above = under = none
    for k in range(0, count, WIDTH):
        node, inside = begin + np.uintp(k), below(count - k)
        part = where(inside, take(swimmer.barycentric, node), none) / (
            t - where(inside, take(swimmer.fraction, node), far)
        )
        above += part * where(inside, take(values, kind, node), none)
        under += part
    value, whole = total(above) / total(under), total(under)
    rise = none
    for k in range(0, count, WIDTH):
        node, inside = begin + np.uintp(k), below(count - k)
        apart = t - where(inside, take(swimmer.fraction, node), far)
        part = where(inside, take(swimmer.barycentric, node), none) / apart
        rise += part * (value - where(inside, take(values, kind, node), none)) / apart
    return value, total(rise) / whole


@inlined
def zero_between(swimmer, values, kind, begin, count, i, before, exact):
    """Fraction of the panel at which `values` are zero, between node i and the one before it (value `before`).

    That of the quadratic through these and the next node of the panel: an error e moves the load of V|V| by e^3. Where
    it has to be `exact`, that of the polynomial through all nodes, by Newton's method from there, or by halves; the
    panel's start where it has none.
    """
    start, end, f, g = 0.0, swimmer.fraction[i], before, values[kind, i]
    if i > begin:
        start = swimmer.fraction[i - ONE]
    slope = (g - f) * swimmer.apart[i]
    if i + ONE < begin + np.uintp(count):
        bend = ((values[kind, i + ONE] - g) * swimmer.apart[i + ONE] - slope) * swimmer.span[i]
    else:
        bend = (slope - (f - values[kind, i - np.uintp(2)]) * swimmer.apart[i - ONE]) * swimmer.span[i - ONE]
    # f + b s + bend s^2 with s from the start on, in the form that does not cancel, where it goes as f and g do
    b = slope - bend * (end - start)
    steep = np.sqrt(max(b * b - 4.0 * bend * f, 0.0))
    t = start - 2.0 * f / (b + (steep if g > f else -steep))
    if not (start < t < end):
        t = min(max(start - f / slope, start), end)
    if exact:
        at_node = i > begin  # else the panel's polynomial may have its zero before the panel
        before = last = end - start
        for _ in range(40):
            value, rise = value_and_slope(swimmer, values, kind, begin, count, t)
            if (value > 0.0) != (g > 0.0):
                start = t
            elif t > start:
                end = t
            else:
                break
            step = -value / rise
            if abs(step) < 1e-6:  # what is left is of the order of its square
                t = min(max(t + step, start), end)
                break
            if t + step <= start and not at_node:
                step, at_node = start - t, True
            elif not (start < t + step < end) or abs(step) > 0.5 * abs(before):
                step = 0.5 * (start + end) - t
            before, last, t = last, step, t + step
    return t


@inlined
def integrals_upto(swimmer, begin, count, t, row, at):
    """Weights `row[at]` (count,) [m] of the panel's nodes for the integral from its start to its fraction `t`."""
    z = 2.0 * t - 1.0
    for k in range(0, count, 2 * WIDTH):
        node, low, middle = begin + np.uintp(k), 1.0, z  # Legendre polynomials
        weights = t * take(swimmer.series, ZERO, node)
        if count - k <= WIDTH:
            for m in range(np.uintp(count) - ONE):
                high = fused(UPPER[m] * z, middle, -LOWER[m] * low)
                weights += INTEGRAL[m] * (high - low) * take(swimmer.series, m + ONE, node)
                low, middle = middle, high
        else:
            behind = node + np.uintp(WIDTH)
            others = t * take(swimmer.series, ZERO, behind)
            for m in range(np.uintp(count) - ONE):
                high = fused(UPPER[m] * z, middle, -LOWER[m] * low)
                share = INTEGRAL[m] * (high - low)
                weights += share * take(swimmer.series, m + ONE, node)
                others += share * take(swimmer.series, m + ONE, behind)
                low, middle = middle, high
            put(row, at, k + WIDTH, others)
        put(row, at, k, weights)


@inlined
def note_step(swimmer, fields, kind, shared, i, start, noise):
    """Note the step of the load where row `kind` of the speeds changes its sign before node `i` (`start`: the value at
    the nose). Have the load's weights, the row `shared`, integrate it; a change below `noise` is round-off."""
    kinks, speed, share, jump = fields.kinks, fields.speed, fields.share, kind == RATIO
    value, before = speed[kind, i], start
    if i > ZERO:
        before = speed[kind, i - ONE]
    j = kinks.number[0]
    if abs(value - before) > noise and j < len(kinks.kind):
        kinks.number[0] = j + 1
        begin, count = swimmer.first[i], np.int64(swimmer.count[i])
        t = zero_between(swimmer, speed, kind, begin, count, i, before, jump and swimmer.watched <= SIDE)
        step = (1.0 if jump else 2.0) * (1.0 if value >= 0.0 else -1.0)
        integrals_upto(swimmer, begin, count, t, kinks.row, j)
        kinks.kind[j], kinks.begin[j], kinks.fraction[j], kinks.step[j] = kind, begin, t, step
        for k in range(0, count, WIDTH):
            node = begin + np.uintp(k)
            ahead = where(below(np.int64(i) - np.int64(node)), take(swimmer.weight, node), spread(0.0))
            inside = where(below(count - k), take(kinks.row, j, k), spread(0.0))
            put(share, shared, node, take(share, shared, node) + step * (ahead - inside))


@inlined
def find_steps(swimmer, fields, at_nose, noise, noise_of_roll, planar):
    """Note the steps of the loads: where V2, V3 or Omega1 (V2 alone where `planar`) or Re/8e4 - 1 changes its sign
    along the body, from its value `at_nose`; of these the rows from `swimmer.watched` on. What is below its `noise` is
    round-off, and has the sign of what is before it."""
    nodes, kinds = len(swimmer.x), ROLL + ONE
    if swimmer.friction == PRINTED:
        kinds = RATIO + ONE
    fields.kinks.number[0] = 0
    for kind in range(SIDE, kinds):
        start, least, shared = at_nose[0], noise, kind
        if kind < swimmer.watched:
            continue
        if kind == HEIGHT:
            if planar:
                continue
            start = at_nose[1]
        elif kind == ROLL:
            if planar:
                continue
            start, least = at_nose[2], noise_of_roll
        elif kind == RATIO:
            start, least, shared = -1.0, 0.0, ZERO
        sign, signed_yet = np.int64(start < -least), abs(start) > least
        for k in range(swimmer.blocks):
            values = take(fields.speed, kind, WIDTH * k)
            negative = bits(values < -least)
            known = negative | bits(values > least)
            if not signed_yet or known != 255:
                negative, sign, signed_yet = signs_carried(negative, known, sign, signed_yet)
            changes = (negative ^ (negative << 1 | sign)) & 255
            sign = negative >> 7
            if nodes - WIDTH * k < WIDTH:
                changes &= (1 << nodes - WIDTH * k) - 1
            while changes != 0:
                note_step(swimmer, fields, kind, shared, np.uintp(WIDTH * k + lowest(changes)), start, least)
                changes &= changes - 1


@inlined
def signs_carried(negative, known, sign, signed_yet):
    """Of eight values by their bits: `negative` with the sign before for those that are not `known`; before the first
    that is, its own. Returns them, the sign before the eight that goes with them, and whether there was one at all."""
    if not signed_yet:
        if known == 0:
            return np.int64(0), np.int64(0), False
        lowest = known & -known
        sign = np.int64(negative & lowest != 0)
    carried, result = sign, np.int64(0)
    for lane in range(WIDTH):
        if known >> lane & 1:
            carried = negative >> lane & 1
        result |= carried << lane
    return result, sign, True


@inlined
def weigh_steps(kinks, count, drag2, drag3, drag_roll, rubbing, speed, R, r):
    """What the steps of the loads are of: the `density` of each at the nodes of its panel, and its integral from the
    panel's start to the step, the `whole`."""
    for j in range(kinks.number[0]):
        begin, kind, step, density, whole = kinks.begin[j], kinks.kind[j], kinks.step[j], kinks.density, kinks.whole
        axis, row = ZERO, kind  # of the force or torque; of the speed that it goes with
        if kind == SIDE:
            axis = np.uintp(3)
        elif kind == HEIGHT:
            axis = np.uintp(6)
        elif kind == RATIO:
            row = AXIAL
        nodes, none = np.int64(count[begin]), spread(0.0)
        a = b = c = d = e = f = none
        for k in range(0, nodes, WIDTH):
            node = begin + np.uintp(k)
            along = take(speed, row, node)
            if kind == SIDE:
                force = take(drag2, node) * along * along
            elif kind == HEIGHT:
                force = take(drag3, node) * along * along
            elif kind == ROLL:
                force = take(drag_roll, node) * along * along
            else:
                force = take(rubbing, 1, node) * along
            force = step * force
            x, y, z = force * take(R, axis, node), force * take(R, axis + ONE, node), force * take(R, axis + TWO, node)
            tx, ty, tz = x, y, z
            if kind == ROLL:
                x = y = z = none
            else:
                rx, ry, rz = three(r, 0, node)
                tx, ty, tz = cross(rx, ry, rz, x, y, z)
            put(density, j, 0, k, tx)
            put(density, j, 1, k, ty)
            put(density, j, 2, k, tz)
            put(density, j, 3, k, x)
            put(density, j, 4, k, y)
            put(density, j, 5, k, z)
            weight = where(below(nodes - k), take(kinks.row, j, k), none)
            a += weight * tx
            b += weight * ty
            c += weight * tz
            d += weight * x
            e += weight * y
            f += weight * z
        whole[j, 0], whole[j, 1], whole[j, 2] = total(a), total(b), total(c)
        whole[j, 3], whole[j, 4], whole[j, 5] = total(d), total(e), total(f)


@inlined
def integrate_balance(upto, kinks, count, fraction, density, known, result):
    """Integrals (6, n) of the `density` (6, n) from the nose to the points of `upto`, with the steps of its loads;
    `known` (6, n): those to the nodes, the `result` itself where these are the points."""
    for block in range(len(upto.source)):
        node, begin, i = upto.source[block], upto.start[block], WIDTH * block
        a = b = c = d = e = f = spread(0.0)
        for j in range(upto.sources[block]):
            column, here = take(upto.columns, begin + j, 0), node + j
            a += density[0, here] * column
            b += density[1, here] * column
            c += density[2, here] * column
            d += density[3, here] * column
            e += density[4, here] * column
            f += density[5, here] * column
        if node > ZERO:
            before = node - ONE
            a, b, c = a + known[0, before], b + known[1, before], c + known[2, before]
            d, e, f = d + known[3, before], e + known[4, before], f + known[5, before]
        for j in range(kinks.number[0]):
            first = kinks.begin[j]
            if first < node or first + count[first] > node + upto.sources[block]:
                continue
            at, of_it, whole = kinks.fraction[j], kinks.density, kinks.whole
            behind = take(upto.place, i) >= first + at
            for k in range(count[first]):
                column = take(upto.columns, begin + (first - node) + k, 0)
                if fraction[first + k] < at:
                    column = where(behind, column, spread(0.0))
                else:
                    column = where(behind, spread(0.0), -column)
                a += of_it[j, 0, k] * column
                b += of_it[j, 1, k] * column
                c += of_it[j, 2, k] * column
                d += of_it[j, 3, k] * column
                e += of_it[j, 4, k] * column
                f += of_it[j, 5, k] * column
            passed = where(behind, spread(1.0), spread(0.0))
            a -= whole[j, 0] * passed
            b -= whole[j, 1] * passed
            c -= whole[j, 2] * passed
            d -= whole[j, 3] * passed
            e -= whole[j, 4] * passed
            f -= whole[j, 5] * passed
        put(result, 0, i, a)
        put(result, 1, i, b)
        put(result, 2, i, c)
        put(result, 3, i, d)
        put(result, 4, i, e)
        put(result, 5, i, f)


@inlined
def integrate_steps(swimmer, fields, upto, density, known, result):
    """Integrals (6, n) of the `density` of the balance, and of the steps of its loads, as in `integrate_balance`."""
    weigh_steps(
        *(fields.kinks, swimmer.count, swimmer.drag2, swimmer.drag3, swimmer.drag_roll),
        *(fields.rubbing, fields.speed, fields.R, fields.r),
    )
    integrate_balance(upto, fields.kinks, swimmer.count, swimmer.fraction, density, known, result)
