"""The mechanics of one instant, compiled: from shape and momentum of the body to the rates of both.

Every quantity is in the axes of the head at the instant, about the head, unless said (R(0) = 1, r(0) = 0). Fields along
the body are arrays (3, n) or (9, n) over the n nodes; `R` holds t1, t2, t3 one after the other. A wrench or momentum is
(torque, force), 6 numbers; a twist is (Omega, V).

Momentum form: the balance (60) of Boyer, Porez and Leroyer (2010) is the time derivative of the momentum of body and
water. With that momentum as the state, neither accelerations nor the second derivative of the law are needed to march.
"""

from .compiled import inlined, shared
from .drag import add_resistive_loads
from .drive import combine, combine_moments
from .kinks import ONE, ZERO
from .lanes import WIDTH, put, size, spread, take
from .rotations import orient, turns
from .vectors import bent, cross, dot, put_three, three


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


@shared
def add_head_twist(swimmer, fields, twist):
    """Add the motion of the head, `twist` (6,), to the velocities due to the change of shape: the true ones."""
    add_head_motion(swimmer, fields.r, twist, fields.omega, fields.v)


@inlined
def wake_of(wake, added2, added3, added_roll, t1, t2, t3, r, omega, v):
    """Wrench (6,) of the wake about the head, w_tail of eq. (60), of a tail with such added masses, axes, position and
    velocities; with V1 [m/s] and T_f [J/m] there. Of one tail, or of eight."""
    vx, vy, vz = v
    v1 = wake * dot(*t1, vx, vy, vz)
    v2, v3, roll = dot(*t2, vx, vy, vz), dot(*t3, vx, vy, vz), dot(*t1, *omega)
    p2, p3, s1 = added2 * v2, added3 * v3, added_roll * roll
    energy = 0.5 * wake * (s1 * roll + p2 * v2 + p3 * v3)
    nx = v1 * (p2 * t2[0] + p3 * t3[0]) - energy * t1[0]
    ny = v1 * (p2 * t2[1] + p3 * t3[1]) - energy * t1[1]
    nz = v1 * (p2 * t2[2] + p3 * t3[2]) - energy * t1[2]
    x, y, z = cross(*r, nx, ny, nz)
    return (v1 * s1 * t1[0] + x, v1 * s1 * t1[1] + y, v1 * s1 * t1[2] + z, nx, ny, nz), v1, energy


@shared
def find_loads(swimmer, fields, twist):
    """Loads on the body from the true velocities: of the wake, w_tail of eq. (60), into `tail`, and of the drag along
    the body into `drag`; what they take and give into `losses`. `twist` (6,) is the head's."""
    R, r, omega, v, tail, drag = fields.R, fields.r, fields.omega, fields.v, fields.tail, fields.drag
    i = len(swimmer.x) - 1
    loads, v1, energy = wake_of(
        *(swimmer.wake, swimmer.added2[i], swimmer.added3[i], swimmer.added_roll[i]),
        *((R[0, i], R[1, i], R[2, i]), (R[3, i], R[4, i], R[5, i]), (R[6, i], R[7, i], R[8, i])),
        *((r[0, i], r[1, i], r[2, i]), (omega[0, i], omega[1, i], omega[2, i]), (v[0, i], v[1, i], v[2, i])),
    )
    tail[0], tail[1], tail[2], tail[3], tail[4], tail[5] = loads
    fields.losses[0], fields.losses[1], fields.losses[2] = 0.0, v1, energy
    for k in range(6):
        drag[k] = 0.0
    if swimmer.resistive:
        fields.losses[0] = add_resistive_loads(swimmer, fields, twist, drag)
    else:
        fields.kinks.number[0] = 0


@shared
def configure(swimmer, drive, fields):
    """Configuration and shape velocities of the body at the instant of the time factors (the first loop of section
    7.1)."""
    combine_moments(drive.axis, drive.bend, fields.factor[0], swimmer.blocks, fields.bend)
    combine(drive.axis, drive.node, fields.factor[1], swimmer.blocks, fields.rate)
    turns(fields.bend, swimmer.blocks, fields.turn)
    orient(fields.turn, swimmer.blocks, fields.q, fields.R)
    shape_velocities(swimmer, fields)


@inlined
def momentum_rates(swimmer, fields, momentum, twist, rates):
    """Rates (6,) of momentum about the moving head, of world vectors, in the head's present axes; adds the head's twist
    to the velocities in `fields`."""
    add_head_twist(swimmer, fields, twist)
    find_loads(swimmer, fields, twist)
    tail, drag = fields.tail, fields.drag
    rates[0], rates[1], rates[2], rates[3], rates[4], rates[5] = rates_of(
        swimmer,
        (tail[0] + drag[0], tail[1] + drag[1], tail[2] + drag[2]),
        (tail[3] + drag[3], tail[4] + drag[4], tail[5] + drag[5]),
        (momentum[3], momentum[4], momentum[5]),
        (twist[1], twist[2]),
        (twist[3], twist[4], twist[5]),
    )


@inlined
def rates_of(swimmer, torque, force, impulse, turning, velocity):
    """Rates (6,) of momentum about the moving head, from the loads of wake and drag, the linear momentum and the head's
    twist (of its angular part 2 and 3). Of one swimmer, or of eight."""
    (oy, oz), (vx, vy, vz), nose = turning, velocity, swimmer.nose_mass
    # n_nose less what is the derivative of m_o V1 E1 (its gyroscopic part), and the nose's drag
    fx = force[0] - (nose * (oy * vz - oz * vy) + swimmer.nose_drag * vx * size(vx))
    fy, fz = force[1] + nose * vx * oz, force[2] - nose * vx * oy
    # about the moving head: - V x (P' - m_o V1 E1)
    x, y, z = cross(vx, vy, vz, impulse[0] - nose * vx, impulse[1], impulse[2])
    return torque[0] - x, torque[1] - y, torque[2] - z, fx, fy, fz
