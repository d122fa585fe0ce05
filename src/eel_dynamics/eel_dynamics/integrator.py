"""March of the head in time: explicit Runge-Kutta steps of the momentum form, with dense output, compiled.

State y (17,), world axes: position of the head 0:3 [m]; orientation 3:7, quaternion x y z w; momentum of body, water
and nose about the head 7:10 [kg m^2/s] and linear 10:13 [kg m/s]; work of actuators, wake, nose and drag since the
start 13:17 [J]. The works are integrals along the way, from the acceleration form at the Lobatto points of each step.

Three methods: steps of Adams and Bashforth of orders 1 to 6 (`adams`), and the pair of Dormand and Prince of orders
5(4) (J. Comp. Appl. Math. 6 (1980); dense output of order 4 by Shampine, Math. Comp. 46 (1986)), both with a step
chosen by the error estimate; and the classical Runge-Kutta method with a given step. Steps end at the breakpoints of
the shape, where its derivatives jump. docs/integrators.md tells why these.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from .adams import HIGHEST, SHORT, SPACE, Past, adams_growth, defect_of_order, extrapolate, remember
from .compiled import inlined, spliced
from .drive import combine, factors
from .kernel import add_head_twist, configure, find_loads, momentum_rates, twist_of_momentum
from .lanes import WIDTH, inverse_root_guess, put, size, spread, take, total, work_space
from .packed import Form
from .planar import move_plane, powers_plane, rate_of_state_plane
from .wrench import accelerate, actuator_power

STATE = 13
WORKS = 4
LOBATTO = np.array([0.0, 0.5 - np.sqrt(5.0) / 10.0, 0.5 + np.sqrt(5.0) / 10.0, 1.0])
LOBATTO_SERIES = np.linalg.inv(np.vander(LOBATTO, increasing=True))  # coefficients of the cubic through values there

MARCHED, NOT_FINITE, STEP_TOO_SMALL, SINGULAR, TOO_MANY_STEPS = 0, 1, 2, 3, 4


class Method(NamedTuple):
    """A method whose last rate is the first of the next step: of s stages, or (`adams` > 0) Adams' of that order, whose
    rows are the rate at the start, the mean rate and the rate at the end."""

    a: np.ndarray  # (s, s)
    c: np.ndarray  # (s,)
    error: np.ndarray  # (s,) weights of the error estimate, zero where there is none
    dense: np.ndarray  # (s, 4) y(theta) = y + h sum_i k_i sum_j dense[i, j] theta^(j+1)
    adaptive: bool
    order: int  # of the error's size by the step's length
    adams: int  # order, 0: a Runge-Kutta method


class Control(NamedTuple):
    """What bounds a step."""

    tolerance: float  # relative error per step
    step: float  # s, the step where it is fixed, else the longest
    smallest: float  # s
    length: float  # m, scale of positions
    momentum_floor: float  # kg m/s, below which momentum counts as none
    part_of_span: float  # between two breakpoints, that a step may take
    most_steps: float  # per second of motion
    spare_steps: float  # beyond these, to be spent at any time
    ledger: bool
    planar: bool


class Step(NamedTuple):
    """The step that the state is in, and the work space; s stages. States have 13 numbers and zeros up to 16."""

    time: np.ndarray  # (3,) start s, length s, proposed next length s
    y: np.ndarray  # (16,) at its start
    end: np.ndarray  # (16,) at its end
    k: np.ndarray  # (s, 16) rates at the stages
    trial: np.ndarray  # (16,)
    defect: np.ndarray  # (16,) error estimate by the step's length
    work: np.ndarray  # (4,) at the start
    power: np.ndarray  # (4, 4) at the Lobatto points: [point, work]
    twist: np.ndarray  # (6,)
    rates: np.ndarray  # (6,)
    momentum: np.ndarray  # (6,)
    scale: np.ndarray  # (2,) squares of the greatest angular and linear momentum so far
    count: np.ndarray  # (3,) int: steps, rejected steps, evaluations
    budget: np.ndarray  # (1,) steps that may still be tried before the next are earned by motion
    fresh: np.ndarray  # (1,) int: 1 where k[-1] and power[-1] do not hold the start of the next step
    past: Past


def step_of(stages: int, past: int) -> Step:
    """Work space for steps of a method of so many `stages`, that goes back by `past` steps."""
    y, end, trial, defect, k, differences, starred = work_space(
        ((), (), (), (), (stages,), (past + 1,), (past + 2,)), STATE - WIDTH + 1
    )
    return Step(
        time=np.zeros(3),
        y=y,
        end=end,
        k=k,
        trial=trial,
        defect=defect,
        work=np.zeros(WORKS),
        power=np.zeros((4, WORKS)),
        twist=np.zeros(6),
        rates=np.zeros(6),
        momentum=np.zeros(6),
        scale=np.zeros(2),
        count=np.zeros(3, dtype=np.int64),
        budget=np.zeros(1),
        fresh=np.ones(1, dtype=np.int64),
        past=Past(
            differences=differences,
            starred=starred,
            lengths=np.ones(past + 1),
            known=np.zeros(2, dtype=np.int64),
            order=np.zeros(3, dtype=np.int64),
            weight=np.zeros(WIDTH),
        ),
    )


@cache
def classical() -> Method:
    """The classical Runge-Kutta method of order 4; between steps the cubic that meets value and rate at both ends."""
    a = np.zeros((5, 5))
    a[1, 0], a[2, 1], a[3, 2] = 0.5, 0.5, 1.0
    a[4, :4] = 1 / 6, 1 / 3, 1 / 3, 1 / 6
    return Method(a, np.array([0.0, 0.5, 0.5, 1.0, 1.0]), np.zeros(5), _hermite(a[4]), False, 4, 0)


@cache
def adams_bashforth(order: int) -> Method:
    """Steps of Adams and Bashforth of an `order` from 1 to 6; between them as with the classical method."""
    if not 1 <= order <= HIGHEST:
        raise ValueError(f"order of the method adams must be 1 to {HIGHEST}, got {order!r}")
    return Method(
        np.zeros((3, 3)), np.array([0.0, 0.5, 1.0]), np.zeros(3), _hermite([0.0, 1.0, 0.0]), True, order + 1, order
    )


def _hermite(mean) -> np.ndarray:
    """Dense output by the cubic that meets value and rate at both ends; `mean` (s,): the weights of the mean rate."""
    dense = np.outer(mean, [0.0, 3.0, -2.0, 0.0])
    dense[0] += [1.0, -2.0, 1.0, 0.0]
    dense[-1] += [0.0, -1.0, 1.0, 0.0]
    return dense


@cache
def dormand_prince() -> Method:
    """The pair of orders 5(4)."""
    a = np.zeros((7, 7))
    a[1, :1] = 1 / 5
    a[2, :2] = 3 / 40, 9 / 40
    a[3, :3] = 44 / 45, -56 / 15, 32 / 9
    a[4, :4] = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
    a[5, :5] = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
    a[6, :6] = 35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
    error = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
    dense = np.array(
        [
            [1, -8048581381 / 2820520608, 8663915743 / 2820520608, -12715105075 / 11282082432],
            [0, 0, 0, 0],
            [0, 131558114200 / 32700410799, -68118460800 / 10900136933, 87487479700 / 32700410799],
            [0, -1754552775 / 470086768, 14199869525 / 1410260304, -10690763975 / 1880347072],
            [0, 127303824393 / 49829197408, -318862633887 / 49829197408, 701980252875 / 199316789632],
            [0, -282668133 / 205662961, 2019193451 / 616988883, -1453857185 / 822651844],
            [0, 40617522 / 29380423, -110615467 / 29380423, 69997945 / 29380423],
        ]
    )
    return Method(a, np.array([0.0, 0.2, 0.3, 0.8, 8 / 9, 1.0, 1.0]), error, dense, True, 5, 0)


METHOD = Form(classical)
CONTROL = Form(lambda: Control(*([0.0] * 8), True, True))


@inlined
def begin_at(step, time, y, work, length):
    """Let the next step begin at `time` [s] in state `y` (13,) with the works `work` (4,); `length` [s]: that of the
    first of all."""
    for k in range(STATE):
        step.end[k] = y[k]
    for k in range(WORKS):
        step.work[k] = work[k]
    step.time[0], step.time[1] = time, 0.0
    if step.time[2] == 0.0:
        step.time[2] = length
    step.fresh[0] = 1


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
def to_world(t, vector, at):
    """Turn `vector[at : at + 3]` in place from the head's axes, `t` of `head_axes`, to the world's."""
    a, b, c = vector[at], vector[at + 1], vector[at + 2]
    vector[at] = t[0] * a + t[3] * b + t[6] * c
    vector[at + 1] = t[1] * a + t[4] * b + t[7] * c
    vector[at + 2] = t[2] * a + t[5] * b + t[8] * c


@inlined
def to_head(t, vector, at):
    """The inverse of `to_world`."""
    a, b, c = vector[at], vector[at + 1], vector[at + 2]
    vector[at] = t[0] * a + t[1] * b + t[2] * c
    vector[at + 1] = t[3] * a + t[4] * b + t[5] * c
    vector[at + 2] = t[6] * a + t[7] * b + t[8] * c


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
    x, v, z, w = y[3], y[4], y[5], y[6]
    ox, oy, oz = 0.5 * twist[0], 0.5 * twist[1], 0.5 * twist[2]
    dy[3] = w * ox + v * oz - z * oy
    dy[4] = w * oy + z * ox - x * oz
    dy[5] = w * oz + x * oy - v * ox
    dy[6] = -x * ox - v * oy - z * oz
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
def interpolate(method, step, theta, y):
    """State `y` (16,) at the fraction `theta` of the step."""
    low = high = spread(0.0)
    for i in range(method.a.shape[0]):
        d = method.dense
        weight = theta * (d[i, 0] + theta * (d[i, 1] + theta * (d[i, 2] + theta * d[i, 3])))
        low += weight * take(step.k, i, 0)
        high += weight * take(step.k, i, WIDTH)
    put(y, 0, take(step.y, 0) + step.time[1] * low)
    put(y, WIDTH, take(step.y, WIDTH) + step.time[1] * high)
    normalise(y)


@spliced
def works_upto(step, theta, work):
    """Works (4,) [J] at the fraction `theta` of the step: the integral of the cubic through the powers at Lobatto's
    points."""
    for k in range(WORKS):
        work[k] = step.work[k]
    power = theta
    for j in range(4):
        for i in range(4):
            weight = step.time[1] * power / (j + 1.0) * LOBATTO_SERIES[j, i]
            for k in range(WORKS):
                work[k] += weight * step.power[i, k]
        power *= theta


@spliced
def evaluate(swimmer, drive, fields, current, control, time, y, step, dy):
    """Rate `dy` (13,) of state `y` at `time`, by the scene's kernel. False where the inertia is singular."""
    if control.planar:
        return rate_of_state_plane(swimmer, drive, fields, current, time, y, step, dy)
    return rate_of_state(swimmer, drive, fields, current, time, y, step, dy)


@spliced
def state_at(method, control, step, time, y, work):
    """State `y` (13,) and works (4,) at `time` [s] within the step."""
    length, theta = step.time[1], 1.0
    if abs(step.time[0] + length - time) <= 1e-12 * max(1.0, abs(time)):
        for k in range(STATE):
            y[k] = step.end[k]
    else:
        theta = min(1.0, max(0.0, (time - step.time[0]) / length))
        interpolate(method, step, theta, step.trial)
        for k in range(STATE):
            y[k] = step.trial[k]
    if control.ledger:
        works_upto(step, theta, work)


@spliced
def square_of(values, first, last):
    """Sum of the squares of the entries `first` to `last`."""
    square = 0.0
    for k in range(first, last):
        square += values[k] * values[k]
    return square


@spliced
def error_by_tolerance(control, step, length):
    """The error estimate of the trial step by the tolerance: of position by the body's length, of orientation by one,
    of the momenta by their greatest size so far; the worst of the four. A good step has 1 or less."""
    body = control.length * control.length
    linear = max(step.scale[1], square_of(step.trial, 10, 13), control.momentum_floor * control.momentum_floor)
    angular = max(step.scale[0], square_of(step.trial, 7, 10), linear * body)
    worst = max(
        max(square_of(step.defect, 0, 3) / body, square_of(step.defect, 3, 7)),
        max(square_of(step.defect, 7, 10) / angular, square_of(step.defect, 10, 13) / linear),
    )
    return np.sqrt(worst) * length / control.tolerance


@spliced
def attempt(swimmer, drive, fields, current, method, control, step, start, length):
    """Try a step of `length` [s] from `step.end` at `start`, into `step.trial`. Returns a status and the error by
    tolerance."""
    last = method.a.shape[0] - 1
    first = last if method.adams > 0 else 1
    status, terms, stage = MARCHED, 0, 0 if step.fresh[0] == 1 else first
    while status == MARCHED and stage <= last:
        low, high = take(step.end, 0), take(step.end, WIDTH)
        if stage > 0 and method.adams > 0:
            terms = extrapolate(step.past, length, step.end, step.trial)
        else:
            for j in range(stage):
                low += length * method.a[stage, j] * take(step.k, j, 0)
                high += length * method.a[stage, j] * take(step.k, j, WIDTH)
            put(step.trial, 0, low)
            put(step.trial, WIDTH, high)
        if stage == last:
            normalise(step.trial)
        step.count[2] += 1
        time = start + method.c[stage] * length
        if not evaluate(swimmer, drive, fields, current, control, time, step.trial, step, step.k[stage]):
            status = SINGULAR
        elif stage == 0:
            begin_anew(method, step)
            stage = first
        else:
            stage += 1
    if status != MARCHED:
        return status, np.inf
    if method.adams > 0:
        put(step.k, 1, 0, (take(step.trial, 0) - take(step.end, 0)) / length)
        put(step.k, 1, WIDTH, (take(step.trial, WIDTH) - take(step.end, WIDTH)) / length)
        defect_of_order(step.past, terms, step.k, last, step.defect)
    else:
        low = high = spread(0.0)
        for i in range(last + 1):
            low += method.error[i] * take(step.k, i, 0)
            high += method.error[i] * take(step.k, i, WIDTH)
        put(step.defect, 0, low)
        put(step.defect, WIDTH, high)
    low = size(take(step.trial, 0)) + size(take(step.k, last, 0))
    high = size(take(step.trial, WIDTH)) + size(take(step.k, last, WIDTH))
    if not total(low + high) < 1e300:  # NaN too
        return NOT_FINITE, np.inf
    return MARCHED, error_by_tolerance(control, step, length) if method.adaptive else 0.0


@spliced
def begin_anew(method, step):
    """Forget the steps before: the rate at the start of this one has been evaluated."""
    past = step.past
    step.fresh[0] = 0
    past.known[0] = 0
    past.order[0], past.order[1], past.order[2] = method.adams, 0, 0
    put(past.differences, 0, 0, take(step.k, 0, 0))
    put(past.differences, 0, WIDTH, take(step.k, 0, WIDTH))


@spliced
def fitted(method, control, step, start, before, target, tiny):
    """Length [s] of the next step: as proposed, or such that steps end on `target` without a sliver before it; at most
    a part of what lies between the breakpoint `before` and it, for the works are integrals of what goes on there."""
    left = target - start
    if not method.adaptive:
        return left / np.ceil(left / control.step - 1e-9) if left < 1e100 else control.step
    length = min(control.step, step.time[2], control.part_of_span * (target - before))
    if method.adams > 0 and left < 8.0 * length:
        return left / np.ceil(left / length - 1e-9)  # equal steps
    if length > left - tiny:
        return left
    return min(length, 0.5 * left) if length > 0.5 * left else length


@spliced
def inverse_root(x, n):
    """x^(-1/n) of a positive number within half a per cent, by one step of Newton's method; for less than a power."""
    y = inverse_root_guess(x, n)
    left = x
    for _ in range(n):
        left *= y
    return y * (1.0 + (1.0 - left) / n)


@spliced
def growth_of(error, order):
    """How many times longer the next step may be, for the `error` by the tolerance of one whose error goes with the
    power `order` of its length."""
    return 5.0 if error < 1e-4 else min(5.0, 0.9 * inverse_root(error, order))


@spliced
def adapt_order(method, control, step, length, growth):
    """Choose the order of the next step of Adams; returns the `growth` that goes with it."""
    past, last = step.past, method.a.shape[0] - 1
    terms, settled = past.known[1], past.order[1] > past.order[0]
    past.order[1] += 1
    if length > SHORT * control.step:
        past.order[2] = 0
        if settled and past.order[0] < method.adams:
            past.order[0], past.order[1] = past.order[0] + 1, 0
        return growth
    change = 0
    if terms > 1:
        defect_of_order(past, terms - 1, step.k, last, step.defect)
        other = growth_of(error_by_tolerance(control, step, length), terms)
        if other > 1.1 * growth:
            growth, change = other, -1
    if change == 0 and settled and terms == past.order[0] < method.adams and past.order[2] == 1:
        defect_of_order(past, terms + 1, step.k, last, step.defect)
        other = growth_of(error_by_tolerance(control, step, length), terms + 2)
        if other > 1.3 * growth:
            growth, change = other, 1
    if change != 0:
        past.order[0], past.order[1] = terms + change, 0
    past.order[2] = 1 if past.order[1] > terms and past.order[0] < method.adams else 0
    return growth


@spliced
def accept(control, step, start, length):
    """Make the trial step the step."""
    if control.ledger:
        works_upto(step, 1.0, step.work)
        for k in range(WORKS):
            step.power[0, k] = step.power[3, k]
    for k in range(0, SPACE, WIDTH):
        put(step.y, k, take(step.end, k))
        put(step.end, k, take(step.trial, k))
    step.time[0], step.time[1] = start, length
    step.count[0] += 1
    step.budget[0] = min(control.spare_steps, step.budget[0] + control.most_steps * length) - 1.0
    step.scale[0] = max(step.scale[0], square_of(step.end, 7, 10))
    step.scale[1] = max(step.scale[1], square_of(step.end, 10, 13))


@spliced
def march(swimmer, drive, fields, balance, current, method, control, breakpoints, step, until):
    """March until the step holds the time `until` [s]. Returns MARCHED, or why it could not."""
    tiny = 1e-12 * max(1.0, abs(until))
    while step.time[0] + step.time[1] < until - tiny:
        start = step.time[0] + step.time[1]
        if step.budget[0] < 0.0:
            return TOO_MANY_STEPS
        before, target = -np.inf, np.inf
        for j in range(len(breakpoints)):
            if breakpoints[j] > start + tiny:
                target = breakpoints[j]
                break
            before = breakpoints[j]
        anew = step.fresh[0]
        if anew == 0:  # the last rate of a step is the first of the next
            for k in range(0, SPACE, WIDTH):
                put(step.k, 0, k, take(step.k, method.a.shape[0] - 1, k))
        proposed = step.time[2]
        length = fitted(method, control, step, start, before, target, tiny)
        accepted = 4.0 if method.adams > 0 else 1.0  # Adams' next step is the shorter: cheaper than to repeat this one
        while True:
            status, error = attempt(swimmer, drive, fields, current, method, control, step, start, length)
            if status == MARCHED and error <= accepted:
                break
            step.count[1] += 1
            step.budget[0] -= 1.0
            length *= 0.1 if status != MARCHED else max(0.2, 0.9 * inverse_root(error, method.order))
            proposed = length
            if not method.adaptive or length < control.smallest:
                step.fresh[0] = 1
                return STEP_TOO_SMALL if status == MARCHED else status
        growth = growth_of(error, method.order if method.adams == 0 else step.past.order[0] + 1)
        if method.adams > 0:
            growth = adams_growth(step.past, adapt_order(method, control, step, length, growth))
            remember(step.past, step.past.known[1], length, step.k, method.a.shape[0] - 1)
        grown = length * growth
        step.time[2] = min(control.step, grown if length >= proposed else max(proposed, grown))
        if abs(start + length - target) <= tiny:
            length = target - start
        accept(control, step, start, length)
        if control.ledger:
            for j in range(3, -anew, -1):  # the step's end first, which was evaluated last
                there = j == 3
                if not there:
                    interpolate(method, step, LOBATTO[j], step.trial)
                time = start + LOBATTO[j] * length
                if not powers_in_step(
                    swimmer, drive, fields, balance, control, time, step.trial, there, step, step.power[j]
                ):
                    return SINGULAR
    return MARCHED
