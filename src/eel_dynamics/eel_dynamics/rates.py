"""Rates of the state of the head, by the kernel that the scene asks for, compiled: eq. (27) in the momentum form.

A state y (13,) is that of the integrator: position, orientation and momentum in the world's axes; the kernels work in
the head's. `step` holds the work space of a twist, a momentum and their rates.
"""

import numpy as np

from .compiled import inlined, spliced
from .drive import combine, factors
from .kernel import add_head_twist, configure, find_loads, momentum_rates
from .momentum import twist_of_momentum
from .planar import move_plane, powers_plane, rate_of_state_plane
from .vectors import dot
from .wrench import accelerate, actuator_power

WORKS = 4


@inlined
def normalise(y):
    """Make the orientation of state `y` a unit quaternion."""
    size = np.sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6])
    for k in range(3, 7):
        y[k] /= size


@inlined
def head_axes(y):
    """Columns t1, t2, t3 of the rotation of state `y`, world from head, one after the other."""
    x, v, z, w = y[3], y[4], y[5], y[6]
    two = 2.0 / (x * x + v * v + z * z + w * w)
    xx, vv, zz, xv, xz, vz = two * x * x, two * v * v, two * z * z, two * x * v, two * x * z, two * v * z
    wx, wv, wz = two * w * x, two * w * v, two * w * z
    return 1.0 - vv - zz, xv + wz, xz - wv, xv - wz, 1.0 - xx - zz, vz + wx, xz + wv, vz - wx, 1.0 - xx - vv


@inlined
def in_world(t, a, b, c):
    """Components along the world's axes of a vector by those along the head's, `t` of `head_axes`."""
    return t[0] * a + t[3] * b + t[6] * c, t[1] * a + t[4] * b + t[7] * c, t[2] * a + t[5] * b + t[8] * c


@inlined
def in_head(t, a, b, c):
    """The inverse of `in_world`."""
    return dot(a, b, c, t[0], t[1], t[2]), dot(a, b, c, t[3], t[4], t[5]), dot(a, b, c, t[6], t[7], t[8])


@inlined
def to_world(t, vector, at):
    """Turn `vector[at : at + 3]` in place from the head's axes, `t` of `head_axes`, to the world's."""
    vector[at], vector[at + 1], vector[at + 2] = in_world(t, vector[at], vector[at + 1], vector[at + 2])


@inlined
def to_head(t, vector, at):
    """The inverse of `to_world`."""
    vector[at], vector[at + 1], vector[at + 2] = in_head(t, vector[at], vector[at + 1], vector[at + 2])


@inlined
def settle(swimmer, drive, fields, time, y, axes, momentum, twist):
    """Configure the body at `time` and find the head's `twist` from the momentum of state `y`, whose axes are `axes`.
    False where it has none."""
    factors(drive, time, fields.factor)
    configure(swimmer, drive, fields)
    for k in range(6):
        momentum[k] = y[7 + k]
    to_head(axes, momentum, 0)
    to_head(axes, momentum, 3)
    return twist_of_momentum(swimmer, fields, momentum, twist)


@inlined
def turning_rate(x, y, z, w, ox, oy, oz):
    """Rate (4,) [1/s] of the quaternion (x, y, z, w) by the angular velocity in the head's axes."""
    ox, oy, oz = 0.5 * ox, 0.5 * oy, 0.5 * oz
    return w * ox + y * oz - z * oy, w * oy + z * ox - x * oz, w * oz + x * oy - y * ox, -x * ox - y * oy - z * oz


@inlined
def rate_of_state(swimmer, drive, fields, current, time, y, step, dy):
    """Rate `dy` (13,) of state `y` at `time` (eq. 27 in the momentum form). False where the inertia is singular."""
    axes = head_axes(y)
    if not settle(swimmer, drive, fields, time, y, axes, step.momentum, step.twist):
        return False
    momentum_rates(swimmer, fields, step.momentum, step.twist, step.rates)
    twist, rates = step.twist, step.rates
    dy[0], dy[1], dy[2] = twist[3], twist[4], twist[5]
    to_world(axes, dy, 0)
    for k in range(3):
        dy[k] += current[k]
    dy[3], dy[4], dy[5], dy[6] = turning_rate(y[3], y[4], y[5], y[6], twist[0], twist[1], twist[2])
    for k in range(6):
        dy[7 + k] = rates[k]
    to_world(axes, dy, 7)
    to_world(axes, dy, 10)
    return True


@inlined
def powers_here(swimmer, drive, fields, balance, step, power):
    """Powers (4,) [W] of actuators, wake, nose and drag, by the acceleration form, in the state of which `fields` and
    `step.twist` hold velocities and loads."""
    combine(drive.axis, drive.node, fields.factor[2], swimmer.blocks, fields.accel)
    accelerate(swimmer, fields, step.twist, balance)
    actuator_power(swimmer, fields, balance)
    for k in range(WORKS):
        power[k] = balance.powers[k]


@inlined
def move(swimmer, drive, fields, time, y, step):
    """Velocities and loads in state `y` at `time`, into `fields` and `step.twist`. False where the inertia is
    singular."""
    if not settle(swimmer, drive, fields, time, y, head_axes(y), step.momentum, step.twist):
        return False
    add_head_twist(swimmer, fields, step.twist)
    find_loads(swimmer, fields, step.twist)
    return True


@inlined
def powers_of_state(swimmer, drive, fields, balance, time, y, step, power):
    """`powers_here` of state `y` at `time`. False where the inertia is singular."""
    if not move(swimmer, drive, fields, time, y, step):
        return False
    powers_here(swimmer, drive, fields, balance, step, power)
    return True


@spliced
def powers_in_step(swimmer, drive, fields, balance, control, time, y, there, step, power):
    """Powers (4,) [W] in state `y` at `time`, by the scene's kernel; `there`: the state was the last to be evaluated.
    False where the inertia is singular."""
    if control.planar:
        if not there and not move_plane(swimmer, drive, fields, time, y, step.momentum, step.twist):
            return False
        powers_plane(swimmer, drive, fields, balance, step.twist, power)
    else:
        if not there and not move(swimmer, drive, fields, time, y, step):
            return False
        powers_here(swimmer, drive, fields, balance, step, power)
    return True


@spliced
def evaluate(swimmer, drive, fields, current, control, time, y, step, dy):
    """Rate `dy` (13,) of state `y` at `time`, by the scene's kernel. False where the inertia is singular."""
    if control.planar:
        return rate_of_state_plane(swimmer, drive, fields, current, time, y, step, dy)
    return rate_of_state(swimmer, drive, fields, current, time, y, step, dy)
