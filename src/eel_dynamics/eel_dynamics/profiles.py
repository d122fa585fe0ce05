"""What a sample shows: pose, velocities, energies, and the profiles along the body at the stations, compiled.

The fields go on from the nodes to the stations by the same integrals that made them, so a profile is as exact as the
run.
"""

from typing import NamedTuple

import numpy as np

from .compiled import compiled, inlined
from .drag import ONE, ZERO, add_steps, friction, turbulent_part
from .drive import combine, combine_moments, factors
from .integrator import MARCHED, SINGULAR, march, powers_of_state, rotate, state_at
from .kernel import add_head_twist, axes_of, configure, momentum_of_twist, turns
from .wrench import kinetic_energies, section_wrench


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


def profiles_of(samples: int, stations: int, wrench: bool = True, load: bool = True) -> Profiles:
    """Space for `samples` instants at `stations` stations; the profiles that are not asked for have no instants."""
    sizes = {
        "orientation": (4,),
        "twist": (6,),
        "head_acceleration": (6,),
        "kinetic": (2,),
        "powers": (4,),
        "closure": (2,),
    }
    along = {
        "backbone": 3,
        "section_orientation": 4,
        "curvature": 3,
        "curvature_rate": 3,
        "torque": 3,
        "force": 3,
        "fluid_force": 3,
        "resistive_force": 3,
    }
    asked = {"torque": wrench, "force": wrench, "fluid_force": load, "resistive_force": load}
    return Profiles(
        *(
            np.zeros(
                (samples if asked.get(name, True) else 0, stations, along[name])
                if name in along
                else (samples, *sizes.get(name, (3,)))
            )
            for name in Profiles._fields
        )
    )


class StationFields(NamedTuple):
    """Work space of the fields at M stations, as in the kernel's `Fields` and the `Balance`."""

    bend: np.ndarray
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
    zero: np.ndarray


def station_fields_of(stations: int) -> StationFields:
    sizes = ((3, 2), (4,), (9,), (3,), (3,), (3,), (3,), (3,), (6,), (2,), (2,))
    return StationFields(*(np.zeros((*size, stations)) for size in sizes), np.zeros(6))


@inlined
def extend(section, integrand, at_nodes, at_head, result):
    """Field (3, M) at the stations from its derivative `integrand` and its values at the nodes (3, n), `at_head` at the
    nose."""
    for i in range(result.shape[1]):
        begin = section.first[i]
        x, y, z = at_head[0], at_head[1], at_head[2]
        if begin > ZERO:
            x, y, z = at_nodes[0, begin - ONE], at_nodes[1, begin - ONE], at_nodes[2, begin - ONE]
        for j in range(section.count[i]):
            weight, node = section.matrix[i, j], begin + j
            x += weight * integrand[0, node]
            y += weight * integrand[1, node]
            z += weight * integrand[2, node]
        result[0, i], result[1, i], result[2, i] = x, y, z


@inlined
def cross_fields(a, b, result):
    """a x b of fields (3, n) into `result`."""
    for i in range(result.shape[1]):
        result[0, i] = a[1, i] * b[2, i] - a[2, i] * b[1, i]
        result[1, i] = a[2, i] * b[0, i] - a[0, i] * b[2, i]
        result[2, i] = a[0, i] * b[1, i] - a[1, i] * b[0, i]


@compiled
def set_in_motion(swimmer, drive, fields, time, twist, y):
    """Give state `y` (13,) at `time` the momentum of the head's `twist` (6,) relative to the water. Returns the kinetic
    energy [J] of body and water (without the nose's)."""
    factors(drive, time, fields.factor)
    combine_moments(drive.axis, drive.bend, fields.factor[0], fields.bend)
    combine(drive.axis, drive.node, fields.factor[1], fields.rate)
    configure(swimmer, fields)
    momentum_of_twist(swimmer, fields, twist, y[7:])
    rotate(y, False, y, 7)
    rotate(y, False, y, 10)
    add_head_twist(fields, twist)
    body, water = kinetic_energies(swimmer, fields)
    return body + water


@compiled
def place(stations, drive, fields, here, y, sample, out):
    """Backbone, orientation and curvature at the stations."""
    combine_moments(drive.axis, drive.station_bend, fields.factor[0], here.bend)
    combine(drive.axis, drive.station, fields.factor[0], here.curvature)
    combine(drive.axis, drive.station, fields.factor[1], here.rate)
    turns(here.bend, here.turn)
    a, b, c, d = y[3], y[4], y[5], y[6]
    for i in range(here.R.shape[1]):
        x, v, z, w = 0.0, 0.0, 0.0, 1.0
        node = stations.node[i]
        if node >= 0:
            x, v, z, w = fields.q[0, node], fields.q[1, node], fields.q[2, node], fields.q[3, node]
        e, f, g, h = here.turn[0, i], here.turn[1, i], here.turn[2, i], here.turn[3, i]
        x, v, z, w = (
            w * e + x * h + v * g - z * f,
            w * f - x * g + v * h + z * e,
            w * g + x * f - v * e + z * h,
            w * h - x * e - v * f - z * g,
        )
        axes_of(x, v, z, w, here.R, i)
        q = out.section_orientation[sample, i]
        q[0], q[1], q[2], q[3] = (
            d * x + a * w + b * z - c * v,
            d * v - a * z + b * w + c * x,
            d * z + a * v - b * x + c * w,
            d * w - a * x - b * v - c * z,
        )
        for k in range(2):
            out.curvature[sample, i, 1 + k] = here.curvature[k, i]
            out.curvature_rate[sample, i, 1 + k] = here.rate[k, i]
    extend(stations.section, fields.R[:3], fields.r, here.zero, here.r)
    for i in range(here.r.shape[1]):
        for k in range(3):
            out.backbone[sample, i, k] = here.r[k, i]
        rotate(y, False, out.backbone[sample, i], 0)
        for k in range(3):
            out.backbone[sample, i, k] += y[k]


@compiled
def velocities(stations, fields, here, twist):
    """True velocities at the stations, relative to the water."""
    R, f = fields.R, fields.integrand
    for i in range(R.shape[1]):
        k2, k3 = fields.rate[0, i], fields.rate[1, i]
        for k in range(3):
            f[k, i] = R[3 + k, i] * k2 + R[6 + k, i] * k3
    extend(stations.section, f[:3], fields.omega, twist[:3], here.omega)
    cross_fields(fields.omega, R[:3], f[:3])
    extend(stations.section, f[:3], fields.v, twist[3:], here.v)


@compiled
def accelerations(stations, fields, balance, here):
    """True accelerations at the stations."""
    R, f, omega = fields.R, fields.integrand, fields.omega
    for i in range(R.shape[1]):
        k2, k3, l2, l3 = fields.rate[0, i], fields.rate[1, i], fields.accel[0, i], fields.accel[1, i]
        kx, ky, kz = R[3, i] * k2 + R[6, i] * k3, R[4, i] * k2 + R[7, i] * k3, R[5, i] * k2 + R[8, i] * k3
        f[0, i] = R[3, i] * l2 + R[6, i] * l3 + omega[1, i] * kz - omega[2, i] * ky
        f[1, i] = R[4, i] * l2 + R[7, i] * l3 + omega[2, i] * kx - omega[0, i] * kz
        f[2, i] = R[5, i] * l2 + R[8, i] * l3 + omega[0, i] * ky - omega[1, i] * kx
    extend(stations.section, f[:3], balance.alpha, balance.head[:3], here.alpha)
    cross_fields(omega, R[:3], f[:3])
    cross_fields(omega, f[:3], f[3:])
    cross_fields(balance.alpha, R[:3], f[:3])
    for k in range(3):
        for i in range(R.shape[1]):
            f[k, i] += f[3 + k, i]
    extend(stations.section, f[:3], balance.acc, balance.head[3:], here.acc)


@compiled
def internal_wrench(swimmer, stations, fields, balance, here, result, distributed, sample, out):
    """Internal torque and force at the stations: the balance of the part behind each (eq. 50, 51)."""
    section = stations.section
    extend(section, balance.density[:3], balance.upto[:3], here.zero, here.upto[:3])
    extend(section, balance.density[3:], balance.upto[3:], here.zero, here.upto[3:])
    if swimmer.resistive:
        add_steps(swimmer, fields, section, False, here.upto)
    for i in range(here.R.shape[1]):
        for k in range(6):
            fields.wrench[k] = balance.tail[k] - balance.total[k] + here.upto[k, i]
        energy = section_wrench(
            here.R,
            here.r,
            here.omega,
            here.v,
            i,
            section.wake * section.added2[i],
            section.wake * section.added3[i],
            section.wake * section.added_roll[i],
            fields.wrench,
            result,
        )
        for k in range(3):
            out.torque[sample, i, k] = result[k]
            out.force[sample, i, k] = result[3 + k]
        if distributed:
            out.force[sample, i, 0] += energy


@compiled
def loads(stations, here, distributed, sample, out):
    """The water's force on the body per length at the stations: the reactive part, the rate at which a strip's water
    gives up momentum (eq. 50), and the resistive part; and the force -T_f t1 at the tail (eq. 51)."""
    section, R = stations.section, here.R
    for i in range(R.shape[1]):
        u = (
            R[0, i] * here.v[0, i] + R[1, i] * here.v[1, i] + R[2, i] * here.v[2, i],
            R[3, i] * here.v[0, i] + R[4, i] * here.v[1, i] + R[5, i] * here.v[2, i],
            R[6, i] * here.v[0, i] + R[7, i] * here.v[1, i] + R[8, i] * here.v[2, i],
        )
        o = (
            R[0, i] * here.omega[0, i] + R[1, i] * here.omega[1, i] + R[2, i] * here.omega[2, i],
            R[3, i] * here.omega[0, i] + R[4, i] * here.omega[1, i] + R[5, i] * here.omega[2, i],
            R[6, i] * here.omega[0, i] + R[7, i] * here.omega[1, i] + R[8, i] * here.omega[2, i],
        )
        d = (
            R[0, i] * here.acc[0, i] + R[1, i] * here.acc[1, i] + R[2, i] * here.acc[2, i],
            R[3, i] * here.acc[0, i] + R[4, i] * here.acc[1, i] + R[5, i] * here.acc[2, i],
            R[6, i] * here.acc[0, i] + R[7, i] * here.acc[1, i] + R[8, i] * here.acc[2, i],
        )
        k2, k3 = here.curvature[0, i], here.curvature[1, i]
        m2, m3, j1 = section.added2[i], section.added3[i], section.added_roll[i]
        n2, n3, i1 = stations.added2_slope[i], stations.added3_slope[i], stations.added_roll_slope[i]
        p2, p3 = m2 * u[1], m3 * u[2]
        rate_p2 = m2 * (d[1] - (o[2] * u[0] - o[0] * u[2]))
        rate_p3 = m3 * (d[2] - (o[0] * u[1] - o[1] * u[0]))
        # derivatives by X: V' = Omega x E1 - K x V, Omega' = Kdot - K x Omega
        du1, du2, du3 = -(k2 * u[2] - k3 * u[1]), o[2] - k3 * u[0], -o[1] + k2 * u[0]
        do1 = -(k2 * o[2] - k3 * o[1])
        q2, q3 = n2 * u[1] + m2 * du2, n3 * u[2] + m3 * du3
        # - (d/dt + Omega x) p + (d/dX + K x) V1 p, the second only where water is swept past the sections
        wake = section.wake
        f1 = -(o[1] * p3 - o[2] * p2) + wake * u[0] * (k2 * p3 - k3 * p2)
        f2 = -(rate_p2 - o[0] * p3) + wake * (du1 * p2 + u[0] * q2)
        f3 = -(rate_p3 + o[0] * p2) + wake * (du1 * p3 + u[0] * q3)
        if distributed and wake > 0.0:
            energy = 0.5 * (j1 * o[0] * o[0] + p2 * u[1] + p3 * u[2])
            f1 -= 0.5 * (i1 * o[0] * o[0] + n2 * u[1] * u[1] + n3 * u[2] * u[2]) + j1 * o[0] * do1 + p2 * du2 + p3 * du3
            f2 -= energy * k3
            f3 += energy * k2
        r1 = r2 = r3 = 0.0
        if section.resistive:
            part = turbulent_part(section.friction, section.transition[i], abs(u[0]))
            r1 = -friction(section.laminar[i], section.turbulent[i], section.transition[i], part, abs(u[0])) * u[0]
            r2 = -section.drag2[i] * abs(u[1]) * u[1]
            r3 = -section.drag3[i] * abs(u[2]) * u[2]
        rows = out.resistive_force[sample, i], out.fluid_force[sample, i]
        rows[0][0], rows[0][1], rows[0][2] = r1, r2, r3
        rows[1][0], rows[1][1], rows[1][2] = f1 + r1, f2 + r2, f3 + r3


@compiled
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
    rotate(y, True, out.twist[sample], 3)
    for k in range(3):
        out.twist[sample, 3 + k] += twist[3 + k]
    for k in range(6):
        out.head_acceleration[sample, k] = balance.head[k]
    mass = 0.0
    for i in range(fields.r.shape[1]):
        part = swimmer.weight[i] * swimmer.mass[i]
        mass += part
        for k in range(3):
            out.center_of_mass[sample, k] += part * fields.r[k, i]
    for k in range(3):
        out.center_of_mass[sample, k] /= mass
    rotate(y, False, out.center_of_mass[sample], 0)
    for k in range(3):
        out.center_of_mass[sample, k] += y[k]
    out.kinetic[sample, 0], out.kinetic[sample, 1] = kinetic_energies(swimmer, fields)
    left = 0.0
    for k in range(3):
        left += (balance.tail[k] - balance.total[k]) ** 2
    out.closure[sample, 0] = np.sqrt(left)
    left = (balance.tail[3] - balance.total[3] + balance.nose[0]) ** 2
    for k in range(4, 6):
        left += (balance.tail[k] - balance.total[k]) ** 2
    out.closure[sample, 1] = np.sqrt(left)
    place(stations, drive, fields, here, y, sample, out)
    if want_wrench or want_load:
        velocities(stations, fields, here, twist)
    if want_wrench:
        internal_wrench(swimmer, stations, fields, balance, here, step.rates, distributed, sample, out)
    if want_load:
        accelerations(stations, fields, balance, here)
        loads(stations, here, distributed, sample, out)
        tail = fields.R.shape[1] - 1
        for k in range(6):
            fields.wrench[k] = 0.0
        energy = section_wrench(
            fields.R,
            fields.r,
            fields.omega,
            fields.v,
            tail,
            swimmer.wake * swimmer.added2[tail],
            swimmer.wake * swimmer.added3[tail],
            swimmer.wake * swimmer.added_roll[tail],
            fields.wrench,
            step.rates,
        )
        out.tail_force[sample, 0] = 0.0 if distributed else -energy
        out.nose_force[sample, 0] = balance.nose[0]
    return True


@compiled
def swim(
    swimmer,
    stations,
    drive,
    fields,
    balance,
    here,
    step,
    current,
    distributed,
    method,
    control,
    breakpoints,
    lobatto,
    series,
    look,
    want_wrench,
    want_load,
    times,
    y,
    works,
    out,
):
    """March through `times` (T,) [s], ascending: the state `y` (13,) ends as the last, `works` (T, 4) holds each; where
    `look`, one instant of `out` is filled at each. Returns the number of instants reached, and a status.

    The one entry to all loops: what is compiled once for it serves every use.
    """
    for sample in range(len(times)):
        status = march(
            swimmer, drive, fields, balance, current, method, control, breakpoints, lobatto, series, step, times[sample]
        )
        if status != MARCHED:
            return sample, status
        state_at(method, series, step, times[sample], y, works[sample])
        if look and not observe(
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
            times[sample],
            y,
            sample,
            out,
        ):
            return sample, SINGULAR
    return len(times), MARCHED
