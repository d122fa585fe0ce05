"""What a sample shows: pose, velocities, energies, and the profiles along the body at the stations, compiled.

The fields go on from the nodes to the stations by the same integrals that made them, so a profile is as exact as the
run.
"""

import math
from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from .compiled import inlined
from .drag import inverse_fifth_root, turbulent_part
from .drive import combine, combine_moments
from .kernel import integrate
from .kinks import BLENDED, LAMINAR, integrate_balance
from .lanes import WIDTH, put, root, size, spread, take, where, work_space
from .packed import Form, address_of, relative
from .rates import head_axes, powers_of_state, to_head, to_world
from .rotations import product, put_axes, turns
from .vectors import bent, cross, in_section, put_three, three, two
from .wrench import kinetic_energies, moving_gain, turning_gain


class Profiles(NamedTuple):
    """Samples: T instants, M stations. Library axes, SI units."""

    position: np.ndarray  # (T, 3) m, head, world
    orientation: np.ndarray  # (T, 4) x y z w, world from head
    twist: np.ndarray  # (T, 6) rad/s, m/s, head's axes
    head_acceleration: np.ndarray  # (T, 6) rad/s^2, m/s^2, true acceleration of the head, head's axes
    center_of_mass: np.ndarray  # (T, 3) m, world
    kinetic: np.ndarray  # (T, 2) J, body and water
    powers: np.ndarray  # (T, 4) W, actuators, wake, nose, drag
    closure: np.ndarray  # (T, 2) N m, N: what is left at the nose of the internal wrench
    backbone: np.ndarray  # (T, M, 3) m, world
    section_orientation: np.ndarray  # (T, M, 4) x y z w, world from section
    curvature: np.ndarray  # (T, M, 3) rad/m
    curvature_rate: np.ndarray  # (T, M, 3) rad/m/s
    torque: np.ndarray  # (T, M, 3) N m, section axes
    force: np.ndarray  # (T, M, 3) N, section axes
    fluid_force: np.ndarray  # (T, M, 3) N/m, of the water on the body, section axes
    resistive_force: np.ndarray  # (T, M, 3) N/m, its resistive part
    tail_force: np.ndarray  # (T, 3) N, section axes at the tail
    nose_force: np.ndarray  # (T, 3) N, section axes at the nose
    whole: np.ndarray  # (.,) all of these, one behind the other


ASKED = {"torque": 0, "force": 0, "fluid_force": 1, "resistive_force": 1}  # by wrench, by load
SIZES = {"orientation": 4, "twist": 6, "head_acceleration": 6, "kinetic": 2, "powers": 4, "closure": 2}
ALONG = ("backbone", "section_orientation", "curvature", "curvature_rate", *ASKED)


def profiles_of(
    samples: int, stations: int, wrench: bool = True, load: bool = True, swimmers: tuple[int, ...] = ()
) -> Profiles:
    """Space for `samples` instants at `stations` stations; the profiles that are not asked for have no instants.
    swimmers: (B,) for so many of them, a first axis."""
    places = places_of(samples, stations, wrench, load)
    whole = np.zeros((*swimmers, places[-1][1]))
    return Profiles(*(whole[..., begin:end].reshape(*swimmers, *shape) for begin, end, shape in places), whole)


@lru_cache(maxsize=64)
def places_of(samples: int, stations: int, wrench: bool, load: bool) -> tuple[tuple[int, int, tuple[int, ...]], ...]:
    """Begin, end and shape of each of the profiles in the whole."""
    asked, end, places = (wrench, load), 0, []
    for name in Profiles._fields[:-1]:
        if name in ALONG:
            count = samples if name not in ASKED or asked[ASKED[name]] else 0
            shape = count, stations, 4 if name == "section_orientation" else 3
        else:
            shape = samples, SIZES.get(name, 3)
        begin, end = end, end + math.prod(shape)
        places.append((begin, end, shape))
    return tuple(places)


PROFILES = Form(lambda: profiles_of(1, 2))


@lru_cache(maxsize=64)
def _row(samples: int, stations: int, wrench: bool, load: bool) -> tuple[np.ndarray, np.ndarray]:
    """Row of such profiles whose whole begins at address 0, and 1 for each of its words that is an address."""
    like = profiles_of(samples, stations, wrench, load)
    return relative(PROFILES, like, like.whole)


def row_of(out: Profiles, wrench: bool = True, load: bool = True) -> np.ndarray:
    """Row (words,) of `out`, made by `profiles_of` with the same `wrench` and `load`; (B, words) for so many
    swimmers."""
    row, moves = _row(*out.backbone.shape[-3:-1], wrench, load)
    begin, whole = address_of(out.whole), out.whole
    if whole.ndim == 1:
        return row + begin * moves
    return row + (begin + np.arange(len(whole)) * whole.strides[0])[:, None] * moves


@cache
def no_profiles() -> np.ndarray:
    """Row of profiles for legs that nobody looks at."""
    return row_of(_NONE)


_NONE = profiles_of(0, 0)


class StationFields(NamedTuple):
    """Work space of the fields at M stations, as in the kernel's `Fields` and the `Balance`."""

    bend: np.ndarray
    base: np.ndarray  # (4, M) orientation of the node before
    turn: np.ndarray
    R: np.ndarray
    r: np.ndarray
    omega: np.ndarray
    v: np.ndarray
    alpha: np.ndarray
    acc: np.ndarray
    upto: np.ndarray
    curvature: np.ndarray
    rate: np.ndarray
    part: np.ndarray  # (1, M) of the turbulent law in the friction
    shown: np.ndarray  # (6, M) what goes into the sample


def station_fields_of(stations: int) -> StationFields:
    sizes = ((3, 2), (4,), (4,), (9,), (3,), (3,), (3,), (3,), (3,), (6,), (2,), (2,), (1,), (6,))
    return StationFields(*work_space(sizes, stations))


@inlined
def show(rows, first, result):
    """Put three `rows` from `first` on into the `result` (M, 3)."""
    for i in range(result.shape[0]):
        result[i, 0], result[i, 1], result[i, 2] = rows[first, i], rows[first + 1, i], rows[first + 2, i]


@inlined
def place(stations, drive, fields, here, y, sample, out):
    """Backbone, orientation and curvature at the stations."""
    section, count = stations.section, len(stations.node)
    combine_moments(drive.axis, drive.station_bend, fields.factor[0], section.blocks, here.bend)
    combine(drive.axis, drive.station, fields.factor[0], section.blocks, here.curvature)
    combine(drive.axis, drive.station, fields.factor[1], section.blocks, here.rate)
    turns(here.bend, section.blocks, here.turn)
    integrate(section.upto, fields.R, 0, fields.r, (0.0, 0.0, 0.0), here.r)
    for i in range(count):
        node = stations.node[i]
        for k in range(4):
            here.base[k, i] = fields.q[k, node] if node >= 0 else (1.0 if k == 3 else 0.0)
    t = head_axes(y)
    a0, b0, c0, d0 = spread(y[3]), spread(y[4]), spread(y[5]), spread(y[6])
    for block in range(section.blocks):
        i = WIDTH * block
        q = product(
            *(take(here.base, 0, i), take(here.base, 1, i), take(here.base, 2, i), take(here.base, 3, i)),
            *(take(here.turn, 0, i), take(here.turn, 1, i), take(here.turn, 2, i), take(here.turn, 3, i)),
        )
        put_axes(here.R, i, q[0], q[1], q[2], q[3])
        q = product(a0, b0, c0, d0, q[0], q[1], q[2], q[3])
        put(here.turn, 0, i, q[0])
        put(here.turn, 1, i, q[1])
        put(here.turn, 2, i, q[2])
        put(here.turn, 3, i, q[3])
        x, v, z = three(here.r, 0, i)
        put(here.shown, 0, i, y[0] + (t[0] * x + t[3] * v + t[6] * z))
        put(here.shown, 1, i, y[1] + (t[1] * x + t[4] * v + t[7] * z))
        put(here.shown, 2, i, y[2] + (t[2] * x + t[5] * v + t[8] * z))
    show(here.shown, 0, out.backbone[sample])
    for i in range(count):
        for k in range(4):
            out.section_orientation[sample, i, k] = here.turn[k, i]
        for k in range(2):
            out.curvature[sample, i, 1 + k] = here.curvature[k, i]
            out.curvature_rate[sample, i, 1 + k] = here.rate[k, i]


@inlined
def velocities(swimmer, stations, fields, here, twist):
    """True velocities at the stations, relative to the water."""
    R, f = fields.R, fields.integrand
    for block in range(swimmer.blocks):
        i = WIDTH * block
        x, y, z = bent(R, fields.rate, i)
        put_three(f, 0, i, x, y, z)
        ox, oy, oz = three(fields.omega, 0, i)
        tx, ty, tz = three(R, 0, i)
        x, y, z = cross(ox, oy, oz, tx, ty, tz)
        put_three(f, 3, i, x, y, z)
    upto = stations.section.upto
    integrate(upto, f, 0, fields.omega, (twist[0], twist[1], twist[2]), here.omega)
    integrate(upto, f, 3, fields.v, (twist[3], twist[4], twist[5]), here.v)


@inlined
def accelerations(swimmer, stations, fields, balance, here):
    """True accelerations at the stations."""
    R, f, head = fields.R, fields.integrand, balance.head
    for block in range(swimmer.blocks):
        i = WIDTH * block
        x, y, z = turning_gain(R, fields.omega, fields.rate, fields.accel, i)
        put_three(f, 0, i, x, y, z)
        x, y, z = moving_gain(R, fields.omega, balance.alpha, i)
        put_three(f, 3, i, x, y, z)
    upto = stations.section.upto
    integrate(upto, f, 0, balance.alpha, (head[0], head[1], head[2]), here.alpha)
    integrate(upto, f, 3, balance.acc, (head[3], head[4], head[5]), here.acc)


@inlined
def internal_wrench(swimmer, stations, fields, balance, here, distributed, sample, out):
    """Internal torque and force at the stations: the balance of the part behind each (eq. 50, 51), in its axes and
    about it, Ad*^-1 w - (V1 J_f1 Omega1 E1; V1 M_f V)."""
    section, shown = stations.section, here.shown
    integrate_balance(
        *(section.upto, fields.kinks, swimmer.count, swimmer.fraction),
        *(balance.density, balance.upto, here.upto),
    )
    behind = fields.wrench
    for k in range(6):
        behind[k] = fields.tail[k] - balance.total[k]
    for block in range(section.blocks):
        i = WIDTH * block
        tx, ty, tz = three(here.upto, 0, i)
        nx, ny, nz = three(here.upto, 3, i)
        nx, ny, nz = nx + behind[3], ny + behind[4], nz + behind[5]
        x, y, z = three(here.r, 0, i)
        x, y, z = cross(x, y, z, nx, ny, nz)
        c1, c2, c3 = in_section(here.R, i, tx + behind[0] - x, ty + behind[1] - y, tz + behind[2] - z)
        n1, n2, n3 = in_section(here.R, i, nx, ny, nz)
        v1, v2, v3 = in_section(here.R, i, *three(here.v, 0, i))
        roll, _, _ = in_section(here.R, i, *three(here.omega, 0, i))
        s1 = section.wake * take(section.added_roll, i) * roll
        p2, p3 = section.wake * take(section.added2, i) * v2, section.wake * take(section.added3, i) * v3
        if distributed:
            n1 += 0.5 * (s1 * roll + p2 * v2 + p3 * v3)
        put_three(shown, 0, i, c1 - v1 * s1, c2, c3)
        put_three(shown, 3, i, n1, n2 - v1 * p2, n3 - v1 * p3)
    show(shown, 0, out.torque[sample])
    show(shown, 3, out.force[sample])


@inlined
def loads(stations, here, distributed, sample, out):
    """The water's force on the body per length at the stations: the reactive part, the rate at which a strip's water
    gives up momentum (eq. 50), and the resistive part; and the force -T_f t1 at the tail (eq. 51)."""
    section, R = stations.section, here.R
    none, whole, wake = spread(0.0), spread(1.0), section.wake
    for block in range(section.blocks):
        i = WIDTH * block
        u1, u2, u3 = in_section(R, i, *three(here.v, 0, i))
        o1, o2, o3 = in_section(R, i, *three(here.omega, 0, i))
        _, d2, d3 = in_section(R, i, *three(here.acc, 0, i))
        k2, k3 = two(here.curvature, i)
        m2, m3, j1 = take(section.added2, i), take(section.added3, i), take(section.added_roll, i)
        n2, n3 = take(stations.added2_slope, i), take(stations.added3_slope, i)
        p2, p3 = m2 * u2, m3 * u3
        rate_p2 = m2 * (d2 - (o3 * u1 - o1 * u3))
        rate_p3 = m3 * (d3 - (o1 * u2 - o2 * u1))
        # derivatives by X: V' = Omega x E1 - K x V, Omega' = Kdot - K x Omega
        du1, du2, du3 = k3 * u2 - k2 * u3, o3 - k3 * u1, k2 * u1 - o2
        do1 = k3 * o2 - k2 * o3
        q2, q3 = n2 * u2 + m2 * du2, n3 * u3 + m3 * du3
        # - (d/dt + Omega x) p + (d/dX + K x) V1 p, the second only where water is swept past the sections
        f1 = (o3 * p2 - o2 * p3) + wake * u1 * (k2 * p3 - k3 * p2)
        f2 = (o1 * p3 - rate_p2) + wake * (du1 * p2 + u1 * q2)
        f3 = wake * (du1 * p3 + u1 * q3) - (rate_p3 + o1 * p2)
        if distributed and wake > 0.0:
            energy = 0.5 * (j1 * o1 * o1 + p2 * u2 + p3 * u3)
            slope = take(stations.added_roll_slope, i)
            f1 -= 0.5 * (slope * o1 * o1 + n2 * u2 * u2 + n3 * u3 * u3) + j1 * o1 * do1 + p2 * du2 + p3 * du3
            f2 -= energy * k3
            f3 += energy * k2
        r1 = r2 = r3 = none
        if section.resistive:
            speed = size(u1)
            rubbing = take(section.laminar, i) * root(speed)
            if section.friction != LAMINAR:
                ratio = speed * take(section.reynolds, i)
                turbulent = take(section.turbulent, i) * ratio * inverse_fifth_root(ratio + 1e-30)
                part = where(ratio > 1.0, whole, none)
                if section.friction == BLENDED:
                    put(here.part, 0, i, speed)
                    for k in range(i, min(i + WIDTH, len(section.x))):
                        here.part[0, k] = turbulent_part(BLENDED, section.transition[k], here.part[0, k])
                    part = take(here.part, 0, i)
                rubbing += part * (turbulent - rubbing)
            r1 = -rubbing * u1
            r2 = -take(section.drag2, i) * size(u2) * u2
            r3 = -take(section.drag3, i) * size(u3) * u3
        put_three(here.shown, 0, i, r1, r2, r3)
        put_three(here.shown, 3, i, f1 + r1, f2 + r2, f3 + r3)
    show(here.shown, 0, out.resistive_force[sample])
    show(here.shown, 3, out.fluid_force[sample])


@inlined
def observe(
    swimmer,
    stations,
    drive,
    fields,
    balance,
    here,
    step,
    current,
    distributed,
    want_wrench,
    want_load,
    time,
    y,
    sample,
    out,
):
    """Fill instant `sample` of `out` with what state `y` (13,) at `time` shows. False where the state is singular."""
    if not powers_of_state(swimmer, drive, fields, balance, time, y, step, out.powers[sample]):
        return False
    twist = step.twist
    for k in range(3):
        out.position[sample, k] = y[k]
        out.twist[sample, k] = twist[k]
        out.twist[sample, 3 + k] = current[k]
        out.center_of_mass[sample, k] = 0.0
    for k in range(4):
        out.orientation[sample, k] = y[3 + k]
    axes = head_axes(y)
    to_head(axes, out.twist[sample], 3)
    for k in range(3):
        out.twist[sample, 3 + k] += twist[3 + k]
    for k in range(6):
        out.head_acceleration[sample, k] = balance.head[k]
    mass = 0.0
    for i in range(len(swimmer.x)):
        part = swimmer.weight[i] * swimmer.mass[i]
        mass += part
        for k in range(3):
            out.center_of_mass[sample, k] += part * fields.r[k, i]
    for k in range(3):
        out.center_of_mass[sample, k] /= mass
    to_world(axes, out.center_of_mass[sample], 0)
    for k in range(3):
        out.center_of_mass[sample, k] += y[k]
    out.kinetic[sample, 0], out.kinetic[sample, 1] = kinetic_energies(swimmer, fields)
    left = 0.0
    for k in range(3):
        left += (fields.tail[k] - balance.total[k]) ** 2
    out.closure[sample, 0] = np.sqrt(left)
    left = (fields.tail[3] - balance.total[3] + balance.nose[0]) ** 2
    for k in range(4, 6):
        left += (fields.tail[k] - balance.total[k]) ** 2
    out.closure[sample, 1] = np.sqrt(left)
    place(stations, drive, fields, here, y, sample, out)
    if want_wrench or want_load:
        velocities(swimmer, stations, fields, here, twist)
    if want_wrench:
        internal_wrench(swimmer, stations, fields, balance, here, distributed, sample, out)
    if want_load:
        accelerations(swimmer, stations, fields, balance, here)
        loads(stations, here, distributed, sample, out)
        out.tail_force[sample, 0] = 0.0 if distributed else -fields.losses[2]
        out.nose_force[sample, 0] = balance.nose[0]
    return True
