"""March of the head in time: steps of the momentum form, with dense output, compiled.

State y (17,), world axes: position of the head 0:3 [m]; orientation 3:7, quaternion x y z w; momentum of body, water
and nose about the head 7:10 [kg m^2/s] and linear 10:13 [kg m/s]; work of actuators, wake, nose and drag since the
start 13:17 [J]. The works are integrals along the way, from the acceleration form at the Lobatto points of each step.

Three methods (`methods`): steps of Adams and Bashforth (`adams`) and the pair of Dormand and Prince, both with a step
chosen by the error estimate; and the classical Runge-Kutta method with a given step. Steps end at the breakpoints of
the shape, where its derivatives jump.
"""

from typing import NamedTuple

import numpy as np

from .adams import SHORT, SPACE, Past, adams_growth, defect_of_order, extrapolate, next_order, remember
from .compiled import inlined, spliced
from .lanes import WIDTH, floor, inverse_root_guess, put, size, spread, take, total, work_space
from .packed import Form
from .rates import WORKS, evaluate, normalise, powers_in_step

STATE = 13
LOBATTO = np.array([0.0, 0.5 - np.sqrt(5.0) / 10.0, 0.5 + np.sqrt(5.0) / 10.0, 1.0])
LOBATTO_SERIES = np.linalg.inv(np.vander(LOBATTO, increasing=True))  # coefficients of the cubic through values there

MARCHED, NOT_FINITE, STEP_TOO_SMALL, SINGULAR, TOO_MANY_STEPS = 0, 1, 2, 3, 4


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


@inlined
def span_at(breakpoints, time):
    """The last of the `breakpoints` [s] up to `time`, and the next one."""
    before, target = -np.inf, np.inf
    for j in range(len(breakpoints)):
        if breakpoints[j] > time:
            target = breakpoints[j]
            break
        before = breakpoints[j]
    return before, target


@spliced
def fitted(method, control, proposed, start, before, target, tiny):
    """Length [s] of the next step: as `proposed`, or such that steps end on `target` without a sliver before it; at
    most a part of what lies between the breakpoint `before` and it, for the works are integrals of what goes on
    there."""
    left = target - start
    if not method.adaptive:
        return left / np.ceil(left / control.step - 1e-9) if left < 1e100 else control.step
    length = min(control.step, proposed, control.part_of_span * (target - before))
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


@inlined
def in_parts(growth):
    """A `growth` of the step in whole parts of 32, no greater: as it is chosen by an estimate of the error, steps that
    went with all its digits would hand the last one, which hangs on the processor, on to all that follow."""
    return floor(32.0 * growth) / 32.0


@spliced
def growth_of(error, order):
    """How many times longer the next step may be, for the `error` by the tolerance of one whose error goes with the
    power `order` of its length."""
    return 5.0 if error < 1e-4 else min(5.0, 0.9 * inverse_root(error, order))


@spliced
def adapt_order(method, control, step, length, growth):
    """Choose the order of the next step of Adams; returns the `growth` that goes with it."""
    past, last, terms = step.past, method.a.shape[0] - 1, step.past.known[1]
    below = above = 0.0
    if length <= SHORT * control.step:
        if terms > 1:
            defect_of_order(past, terms - 1, step.k, last, step.defect)
            below = growth_of(error_by_tolerance(control, step, length), terms)
        if past.order[2] == 1:
            defect_of_order(past, terms + 1, step.k, last, step.defect)
            above = growth_of(error_by_tolerance(control, step, length), terms + 2)
    past.order[0], past.order[1], past.order[2], growth = next_order(
        *(past.order[0], past.order[1], terms, method.adams, length <= SHORT * control.step, growth, below, above)
    )
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
        before, target = span_at(breakpoints, start + tiny)
        anew = step.fresh[0]
        if anew == 0:  # the last rate of a step is the first of the next
            for k in range(0, SPACE, WIDTH):
                put(step.k, 0, k, take(step.k, method.a.shape[0] - 1, k))
        proposed = step.time[2]
        length = fitted(method, control, proposed, start, before, target, tiny)
        accepted = 4.0 if method.adams > 0 else 1.0  # Adams' next step is the shorter: cheaper than to repeat this one
        while True:
            status, error = attempt(swimmer, drive, fields, current, method, control, step, start, length)
            if status == MARCHED and error <= accepted:
                break
            step.count[1] += 1
            step.budget[0] -= 1.0
            length *= 0.1 if status != MARCHED else in_parts(max(0.2, 0.9 * inverse_root(error, method.order)))
            proposed = length
            if not method.adaptive or length < control.smallest:
                step.fresh[0] = 1
                return STEP_TOO_SMALL if status == MARCHED else status
        growth = growth_of(error, method.order if method.adams == 0 else step.past.order[0] + 1)
        if method.adams > 0:
            growth = adapt_order(method, control, step, length, growth)
            growth = adams_growth(step.past.known[0], step.past.order[0], growth)
            remember(step.past, step.past.known[1], length, step.k, method.a.shape[0] - 1)
        grown = length * in_parts(growth)
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
