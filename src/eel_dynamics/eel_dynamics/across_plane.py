"""The mechanics of one instant of eight swimmers that stay in the plane, each in a lane of its own, compiled.

As `across`, with the kernel of `planar`: `Laws.node` holds angles, and rows of pitch are zero.
"""

from .across import EIGHT, combined, find_steps_across, not_positive
from .compiled import inlined
from .drag import NOISE
from .drive import cosine_and_sine
from .kinks import AXIAL, ONE, PRINTED, RATIO, SIDE, ZERO
from .lanes import WIDTH, put, size, spread, take
from .planar import (
    add_head_twist_plane,
    factors_plane,
    heading,
    rates_of_plane,
    resistive_sums_plane,
    share_loads_plane,
    solved_plane,
    sums_plane,
    wake_plane,
)


@inlined
def configure_across_plane(many, laws, fields):
    """Configuration and shape velocities, as `planar.configure_plane`."""
    R, r, omega, v, f = fields.R, fields.r, fields.omega, fields.v, fields.integrand
    rows, nodes = len(laws.value), len(many.one.x)
    for i in range(nodes):
        at = WIDTH * i
        turning = combined(laws.node, laws.rate, laws.pitch, rows, at)
        c, s = cosine_and_sine(combined(laws.node, laws.value, laws.pitch, rows, at))
        put(R, 0, at, c)
        put(R, 1, at, s)
        put(omega, 2, at, turning)
        put(f, 0, at, -turning * s)
        put(f, 1, at, turning * c)
    for i in range(nodes):
        first, count, at = many.one.first[i], many.one.count[i], WIDTH * i
        a = b = c = d = spread(0.0)
        for j in range(count):
            weight, there = many.matrix[i, j], EIGHT * (first + j)
            a += weight * take(R, 0, there)
            b += weight * take(R, 1, there)
            c += weight * take(f, 0, there)
            d += weight * take(f, 1, there)
        if first > ZERO:
            there = EIGHT * (first - ONE)
            a, b, c, d = a + take(r, 0, there), b + take(r, 1, there), c + take(v, 0, there), d + take(v, 1, there)
        put(r, 0, at, a)
        put(r, 1, at, b)
        put(v, 0, at, c)
        put(v, 1, at, d)


@inlined
def loads_across_plane(many, fields, twist):
    """Wrench (T3, F1, F2) of wake and drag on the bodies about their heads; adds the heads' `twist` (Omega3, V1, V2) to
    the velocities."""
    one, eight, R, r, speed = many.one, many.eight, fields.R, fields.r, fields.speed
    add_head_twist_plane(eight, fields, twist)
    tail = len(one.x) - 1
    at = WIDTH * tail
    v1, v2 = take(speed, AXIAL, at), take(speed, SIDE, at)
    torque, fx, fy, _ = wake_plane(
        *(one.wake * one.added2[tail], take(R, 0, at), take(R, 1, at), take(r, 0, at), take(r, 1, at), v1, v2)
    )
    if eight.resistive:
        share_loads_plane(eight, fields)
        for k in range(WIDTH):
            fields.kinks[k] = 0
        if one.watched <= SIDE:
            find_steps_across(many, fields, SIDE, SIDE, twist[2], NOISE * (size(v1) + size(v2)))
        if one.watched <= RATIO and one.friction == PRINTED:
            find_steps_across(many, fields, RATIO, ZERO, spread(-1.0), spread(0.0))
        sz, sx, sy, _ = resistive_sums_plane(eight, fields)
        torque, fx, fy = torque + sz, fx + sx, fy + sy
    return torque, fx, fy


@inlined
def rates_across_plane(many, laws, fields, current, state, rate):
    """Rates (13, 8) of the states (13, 8) of eight swimmers in the plane, as `planar.rate_of_state_plane`, for the time
    factors in `laws`; and the lanes in which the inertia is not positive definite, as bits."""
    z, w, lx, ly = take(state, 5, 0), take(state, 6, 0), take(state, 10, 0), take(state, 11, 0)
    cosine, sine = heading(z, w)
    px, py = cosine * lx + sine * ly, cosine * ly - sine * lx
    configure_across_plane(many, laws, fields)
    xx, xy, yy, cx, cy, turning, sl, sx, sy = sums_plane(many.eight, fields)
    f = factors_plane(xx + many.one.nose_mass, xy, yy, cx, cy, turning)
    twist = solved_plane(f, take(state, 9, 0) - sl, px - sx, py - sy)
    torque, fx, fy = loads_across_plane(many, fields, twist)
    vx, vy, az, aw, torque, fx, fy = rates_of_plane(
        many.eight, cosine, sine, z, w, torque, fx, fy, px, py, twist[0], twist[1], twist[2]
    )
    for k in range(3, 9):
        put(rate, k, 0, spread(0.0))
    put(rate, 12, 0, spread(0.0))
    put(rate, 0, 0, vx + take(current, 0, 0))
    put(rate, 1, 0, vy + take(current, 1, 0))
    put(rate, 2, 0, take(current, 2, 0))
    put(rate, 5, 0, az)
    put(rate, 6, 0, aw)
    put(rate, 9, 0, torque)
    put(rate, 10, 0, fx)
    put(rate, 11, 0, fy)
    return not_positive(f[:3])
