"""The mechanics of one instant of eight swimmers of one body at once, each in a lane of its own, compiled.

What the kernel does for eight nodes of one swimmer is done for one node of eight: node i of the swimmer in lane k is at
8 i + k of every field along the body. Whatever goes node by node is the kernel's own, of a body whose nodes come eight
times (`Many`); what goes along the body is here.
"""

import numpy as np

from .compiled import inlined
from .drag import NOISE, resistive_sums, rub, section_speeds, share_loads
from .fields import MOST_KINKS
from .kernel import add_head_motion, rates_of, wake_of
from .kinks import AXIAL, HEIGHT, ONE, PRINTED, RATIO, ROLL, SIDE, ZERO, integrals_upto, zero_between
from .lanes import WIDTH, bits, lowest, put, size, spread, take, where
from .momentum import factors_of, lower_triangle, moving_sums, solved, turning_sums
from .rates import head_axes, in_head, in_world, turning_rate
from .rotations import product, put_axes, put_turns
from .vectors import cross, put_three, three

EIGHT = np.uintp(WIDTH)


@inlined
def combined(rows, values, first, last, at):
    """Sum of the `rows` (m, 8n) from `first` up to `last`, at the node that begins `at`, times `values` (m, 8)."""
    result = spread(0.0)
    for m in range(first, last):
        result += take(values, m, 0) * take(rows, m, at)
    return result


@inlined
def moments(laws, first, last, at):
    """The same sums of the Magnus moments B0, alpha2, alpha3."""
    b = l = q = spread(0.0)
    for m in range(first, last):
        factor = take(laws.value, m, 0)
        b += factor * take(laws.bend, m, 0, at)
        l += factor * take(laws.bend, m, 1, at)
        q += factor * take(laws.bend, m, 2, at)
    return b, l, q


@inlined
def configure_across(many, laws, fields):
    """Configuration and shape velocities, as `kernel.configure`."""
    R, r, omega, v, f = fields.R, fields.r, fields.omega, fields.v, fields.integrand
    rows, nodes = len(laws.value), len(many.one.x)
    x = y = z = spread(0.0)
    w = spread(1.0)
    for i in range(nodes):
        at = WIDTH * i
        b2, l2, q2 = moments(laws, 0, laws.pitch, at)
        b3, l3, q3 = moments(laws, laws.pitch, rows, at)
        put_turns(fields.turn, 0, b2, b3, l2, l3, q2, q3)
        turn = fields.turn
        x, y, z, w = product(x, y, z, w, take(turn, 0, 0), take(turn, 1, 0), take(turn, 2, 0), take(turn, 3, 0))
        put_axes(R, at, x, y, z, w)
        k2 = combined(laws.node, laws.rate, 0, laws.pitch, at)
        k3 = combined(laws.node, laws.rate, laws.pitch, rows, at)
        bx, by, bz = three(R, 3, at)
        cx, cy, cz = three(R, 6, at)
        put_three(f, 0, at, bx * k2 + cx * k3, by * k2 + cy * k3, bz * k2 + cz * k3)
    for i in range(nodes):
        first, count, at = many.one.first[i], many.one.count[i], WIDTH * i
        a = b = c = d = e = h = spread(0.0)
        for j in range(count):
            weight, there = many.matrix[i, j], EIGHT * (first + j)
            a += weight * take(R, 0, there)
            b += weight * take(R, 1, there)
            c += weight * take(R, 2, there)
            d += weight * take(f, 0, there)
            e += weight * take(f, 1, there)
            h += weight * take(f, 2, there)
        if first > ZERO:
            there = EIGHT * (first - ONE)
            a, b, c = a + take(r, 0, there), b + take(r, 1, there), c + take(r, 2, there)
            d, e, h = d + take(omega, 0, there), e + take(omega, 1, there), h + take(omega, 2, there)
        put_three(r, 0, at, a, b, c)
        put_three(omega, 0, at, d, e, h)
    for i in range(nodes):
        at = WIDTH * i
        ox, oy, oz = three(omega, 0, at)
        tx, ty, tz = three(R, 0, at)
        a, b, c = cross(ox, oy, oz, tx, ty, tz)
        put_three(f, 0, at, a, b, c)
    for i in range(nodes):
        first, count, at = many.one.first[i], many.one.count[i], WIDTH * i
        a = b = c = spread(0.0)
        for j in range(count):
            weight, there = many.matrix[i, j], EIGHT * (first + j)
            a += weight * take(f, 0, there)
            b += weight * take(f, 1, there)
            c += weight * take(f, 2, there)
        if first > ZERO:
            there = EIGHT * (first - ONE)
            a, b, c = a + take(v, 0, there), b + take(v, 1, there), c + take(v, 2, there)
        put_three(v, 0, at, a, b, c)


@inlined
def twist_across(swimmer, fields, angular, linear):
    """The heads' twist (6,) in configured bodies of the given momentum, in the heads' axes; and the lanes in which the
    inertia is not positive definite, as bits."""
    turn, coupling = turning_sums(swimmer, fields)
    by_velocity, s = moving_sums(swimmer, fields)
    f = factors_of(lower_triangle(turn, coupling, by_velocity, swimmer.nose_mass))
    twist = solved(
        f,
        (
            *(angular[0] - s[0], angular[1] - s[1], angular[2] - s[2]),
            *(linear[0] - s[3], linear[1] - s[4], linear[2] - s[5]),
        ),
    )
    return twist, not_positive((f[0], f[2], f[5], f[9], f[14], f[20]))


@inlined
def not_positive(values):
    """The lanes in which any of the `values` is not positive and finite, as bits."""
    good, none = spread(1.0), spread(0.0)
    for each in values:
        good = where(each > 0.0, where(each < 1e300, good, none), none)
    return bits(good < 0.5)


@inlined
def loads_across(many, fields, twist):
    """Wrench (6,) of wake and drag on the bodies about their heads; adds the heads' twist to the velocities."""
    eight, R, r, omega, v = many.eight, fields.R, fields.r, fields.omega, fields.v
    add_head_motion(eight, r, twist, omega, v)
    tail = len(many.one.x) - 1
    at = WIDTH * tail
    wrench, _, _ = wake_of(
        *(eight.wake, many.one.added2[tail], many.one.added3[tail], many.one.added_roll[tail]),
        *(three(R, 0, at), three(R, 3, at), three(R, 6, at), three(r, 0, at), three(omega, 0, at), three(v, 0, at)),
    )
    if eight.resistive:
        section_speeds(eight, fields)
        rub(eight, fields)
        share_loads(eight, fields)
        share_steps_across(many, fields, twist)
        a, b, c, d, e, f, _ = resistive_sums(eight, fields)
        wrench = (wrench[0] + a, wrench[1] + b, wrench[2] + c, wrench[3] + d, wrench[4] + e, wrench[5] + f)
    return wrench


@inlined
def share_steps_across(many, fields, twist):
    """Have the weights integrate the steps of the loads too, as `drag.share_steps`."""
    one, speed, omega, nodes = many.one, fields.speed, fields.omega, len(many.one.x)
    at = WIDTH * (nodes - 1)
    noise = NOISE * (size(take(speed, AXIAL, at)) + size(take(speed, SIDE, at)) + size(take(speed, HEIGHT, at)))
    ox, oy, oz = three(omega, 0, at)
    noise_of_roll = NOISE * (size(ox) + size(oy) + size(oz))
    for k in range(WIDTH):
        fields.kinks[k] = 0
    if one.watched <= SIDE:
        find_steps_across(many, fields, SIDE, SIDE, twist[4], noise)
        find_steps_across(many, fields, HEIGHT, HEIGHT, twist[5], noise)
        find_steps_across(many, fields, ROLL, ROLL, twist[0], noise_of_roll)
    if one.watched <= RATIO and one.friction == PRINTED:
        find_steps_across(many, fields, RATIO, ZERO, spread(-1.0), spread(0.0))


@inlined
def find_steps_across(many, fields, kind, shared, start, noise):
    """Note the steps of the loads where row `kind` of the speeds changes its sign along the bodies, from its value
    `start` at the noses, in the weights' row `shared`; as `kinks.find_steps`."""
    put(fields.edge, 0, 0, start)
    put(fields.edge, 1, 0, noise)
    up, down = spread(1.0), spread(-1.0)
    sign = where(start < -noise, down, where(start > noise, up, spread(0.0)))
    for i in range(len(many.one.x)):
        value = take(fields.speed, kind, WIDTH * i)
        new = where(value < -noise, down, where(value > noise, up, sign))
        changes = bits(new * sign < 0.0)
        sign = new
        while changes != 0:
            lane = lowest(changes)
            note_step_across(many.one, fields, kind, shared, np.uintp(i), np.uintp(lane))
            changes &= changes - 1


@inlined
def note_step_across(swimmer, fields, kind, shared, i, lane):
    """Note the step in the load of the swimmer in `lane` before node `i`, as `kinks.note_step`."""
    speed, share, column = fields.speed, fields.share, fields.column
    value, before = speed[kind, EIGHT * i + lane], fields.edge[0, lane]
    if i > ZERO:
        before = speed[kind, EIGHT * (i - ONE) + lane]
    if abs(value - before) > fields.edge[1, lane] and fields.kinks[lane] < MOST_KINKS:
        fields.kinks[lane] += 1
        begin, count, jump = swimmer.first[i], np.int64(swimmer.count[i]), kind == RATIO
        for k in range(swimmer.count[i]):
            column[0, begin + k] = speed[kind, EIGHT * (begin + k) + lane]
        t = zero_between(swimmer, column, ZERO, begin, count, i, before, jump and swimmer.watched <= SIDE)
        step = (1.0 if jump else 2.0) * (1.0 if value >= 0.0 else -1.0)
        integrals_upto(swimmer, begin, count, t, fields.row, 0)
        for k in range(swimmer.count[i]):
            node = begin + k
            ahead = swimmer.weight[node] if node < i else 0.0
            share[shared, EIGHT * node + lane] += step * (ahead - fields.row[0, k])


@inlined
def rates_across(many, laws, fields, current, state, rate):
    """Rates (13, 8) of the states (13, 8) of eight swimmers, as `rates.rate_of_state`, for the time factors in `laws`;
    and the lanes in which the inertia is not positive definite, as bits."""
    qx, qy, qz, qw = take(state, 3, 0), take(state, 4, 0), take(state, 5, 0), take(state, 6, 0)
    axes = head_axes((qx, qx, qx, qx, qy, qz, qw))
    angular, linear = in_head(axes, *three(state, 7, 0)), in_head(axes, *three(state, 10, 0))
    configure_across(many, laws, fields)
    twist, singular = twist_across(many.eight, fields, angular, linear)
    wrench = loads_across(many, fields, twist)
    rates = rates_of(many.eight, wrench[:3], wrench[3:], linear, twist[1:3], twist[3:])
    a, b, c = in_world(axes, *twist[3:])
    u, v, w = three(current, 0, 0)
    put_three(rate, 0, 0, a + u, b + v, c + w)
    a, b, c, d = turning_rate(qx, qy, qz, qw, *twist[:3])
    put_three(rate, 3, 0, a, b, c)
    put(rate, 6, 0, d)
    a, b, c = in_world(axes, *rates[:3])
    put_three(rate, 7, 0, a, b, c)
    a, b, c = in_world(axes, *rates[3:])
    put_three(rate, 10, 0, a, b, c)
    return singular
