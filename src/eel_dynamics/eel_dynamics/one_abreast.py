"""One of those that swim abreast, in its lane: it takes on a leg, chooses its steps, leaves its samples; compiled.

Calls take the row of the work space: a tuple of arrays costs more to hand over.
"""

import numpy as np

from .adams import SHORT, adams_growth, next_order
from .compiled import compiled, inlined, spliced
from .drive import factors
from .integrator import MARCHED, STATE, fitted, growth_of, in_parts, inverse_root, span_at
from .lanes import WIDTH
from .leg import (
    COUNT,
    CURRENT,
    KNOWN,
    LEG,
    ORDER,
    begin,
    note,
    open_control,
    open_drive,
    open_method,
    open_order,
    open_out,
    open_step,
)
from .shoal import NOBODY, open_space

BEGIN = LEG.places["order"].start + ORDER.places["begin"].start  # the word of a leg's row that says how it begins


@compiled
def take_on(legs, index, lane, space):
    """Have the next of the `legs`, from `index` on, in the `lane`. Returns the index behind it."""
    shoal, laws, _ = open_space(space)
    rest(lane, laws, shoal)
    while index < legs.shape[0]:
        row = legs[index]
        index += 1
        if begin(row) != MARCHED:
            continue
        order, step, control = open_order(row), open_step(row), open_control(row)
        shoal.leg[lane], shoal.fresh[lane], shoal.again[lane] = index - 1, 1, 0
        shoal.sample[lane] = shoal.known[lane] = 0
        shoal.order[0, lane], shoal.order[1, lane], shoal.order[2, lane] = open_method(row).adams, 0, 0
        for j in range(3):
            shoal.count[j, lane] = 0
            shoal.current[j, lane] = order.place[CURRENT + j]
        shoal.start[lane], shoal.length[lane], shoal.proposed[lane] = order.time, 0.0, step.time[2]
        shoal.budget[lane] = step.budget[0]
        shoal.bounds[0, lane] = control.length * control.length
        shoal.bounds[1, lane] = control.momentum_floor * control.momentum_floor
        shoal.bounds[2, lane] = control.tolerance
        shoal.scale[0, lane], shoal.scale[1, lane] = step.scale[0], step.scale[1]
        for j in range(len(shoal.lengths)):
            shoal.lengths[j, lane] = 1.0
        for k in range(STATE):
            shoal.end[k, lane] = shoal.trial[k, lane] = step.end[k]
        take_law(open_drive(row), control.planar, lane, laws, shoal)
        if look_back(row, lane, space):
            break
        rest(lane, laws, shoal)
    return index


@inlined
def rest(lane, laws, shoal):
    """Leave the `lane` to nobody: a straight body at rest."""
    shoal.leg[lane] = NOBODY
    shoal.terms[lane] = shoal.length[lane] = shoal.taken[lane] = 0.0
    for k in range(STATE):
        shoal.end[k, lane] = 1.0 if k == 6 else 0.0
    for m in range(len(laws.value)):
        laws.value[m, lane] = laws.rate[m, lane] = 0.0


@inlined
def take_law(drive, planar, lane, laws, shoal):
    """Put the rows of a law into the `lane` of `laws`, those of pitch and of yaw apart."""
    pitch, yaw = 0, laws.pitch
    nodes = laws.node.shape[1] // WIDTH
    for m in range(len(drive.axis)):
        if drive.axis[m] == 0:
            slot, pitch = pitch, pitch + 1
        else:
            slot, yaw = yaw, yaw + 1
        shoal.slot[lane, m] = slot
        for i in range(min(nodes, drive.node.shape[1])):
            laws.node[slot, WIDTH * i + lane] = drive.angle[m, i] if planar else drive.node[m, i]
            for j in range(0 if planar else 3):
                laws.bend[slot, j, WIDTH * i + lane] = drive.bend[m, j, i]


@compiled
def look_back(row, lane, space):
    """Note the states of the samples up to the end of the step under way. Returns whether there are further ones; if
    not, the leg of the `row` is through."""
    shoal = open_space(space).shoal
    order, out, y = open_order(row), open_out(row), shoal.state
    start, length = shoal.start[lane], shoal.length[lane]
    while shoal.sample[lane] < len(order.times):
        sample = shoal.sample[lane]
        time = order.times[sample]
        tiny = 1e-12 * max(1.0, abs(time))
        if start + length < time - tiny:
            shoal.due[lane] = time - tiny
            return True
        if abs(start + length - time) <= tiny:
            for k in range(STATE):
                y[k] = shoal.trial[k, lane]
        else:
            interpolate(shoal, lane, min(1.0, max(0.0, (time - start) / length)), y)
        note(out, sample, y)
        shoal.sample[lane] += 1
    for j in range(3):
        order.place[COUNT + j] = shoal.count[j, lane]
    row[BEGIN] = KNOWN
    return False


@inlined
def interpolate(shoal, lane, theta, y):
    """State `y` (13,) in the `lane` at the fraction `theta` of the step: the cubic that meets value and rate at both
    ends."""
    length = shoal.length[lane]
    passed = theta * theta * (3.0 - 2.0 * theta)
    leaving, arriving = theta * (1.0 - theta) * (1.0 - theta) * length, theta * theta * (theta - 1.0) * length
    for k in range(STATE):
        here = shoal.end[k, lane]
        y[k] = here + passed * (shoal.trial[k, lane] - here)
        y[k] += leaving * shoal.first[k, lane] + arriving * shoal.rate[k, lane]
    length = np.sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6])
    for k in range(3, 7):
        y[k] /= length


@inlined
def round_off(row, lane, shoal):
    """Of the time [s] of the next sample, as in `march`."""
    return 1e-12 * max(1.0, abs(open_order(row).times[shoal.sample[lane]]))


@spliced
def set_out(row, method, lane, laws, shoal):
    """Choose the step of the `lane`, and have the factors of its law at the end. False where it cannot go on here."""
    order, control, drive = open_order(row), open_control(row), open_drive(row)
    start, length = shoal.start[lane], shoal.length[lane]
    if shoal.fresh[lane] == 0 and shoal.again[lane] == 0:
        tiny = round_off(row, lane, shoal)
        before, target = span_at(order.breakpoints, start + tiny)
        shoal.target[lane] = target
        length = fitted(method, control, shoal.proposed[lane], start, before, target, tiny)
        shoal.length[lane] = length
        shoal.terms[lane] = min(shoal.order[0, lane], shoal.known[lane] + 1)
    factors(drive, start + length, shoal.factor)
    for m in range(len(drive.axis)):
        slot = shoal.slot[lane, m]
        laws.value[slot, lane], laws.rate[slot, lane] = shoal.factor[0, m], shoal.factor[1, m]
    shoal.count[2, lane] += 1
    return shoal.budget[lane] >= 0.0 and (shoal.fresh[lane] == 1 or length >= control.smallest)


@compiled
def error_of_order(space, lane, terms):
    """Error by the tolerance that the step in the `lane` would have had with so many `terms`."""
    shoal = open_space(space).shoal
    position = orientation = angular = linear = most_angular = most_linear = 0.0
    for k in range(STATE):
        defect, moved = shoal.rate[k, lane], shoal.trial[k, lane]
        for j in range(terms):
            defect -= shoal.beta[j, lane] * shoal.differences[j, k, lane]
        square = (shoal.weight[terms, lane] * defect) ** 2
        if k < 3:
            position += square
        elif k < 7:
            orientation += square
        elif k < 10:
            angular, most_angular = angular + square, most_angular + moved * moved
        else:
            linear, most_linear = linear + square, most_linear + moved * moved
    body = shoal.bounds[0, lane]
    most_linear = max(shoal.scale[1, lane], most_linear, shoal.bounds[1, lane])
    most_angular = max(shoal.scale[0, lane], most_angular, most_linear * body)
    worst = max(position / body, orientation, angular / most_angular, linear / most_linear)
    return np.sqrt(worst) * shoal.length[lane] / shoal.bounds[2, lane]


@spliced
def weigh(row, method, lane, shoal, space):
    """Take the step of the `lane`, or have it tried again. Returns whether the leg is not yet through."""
    control, error, length = open_control(row), shoal.error[lane], shoal.length[lane]
    shoal.taken[lane] = 1.0
    if shoal.fresh[lane] == 1:
        shoal.fresh[lane] = 0
        return True
    if error > 4.0:  # as in `march`
        shoal.taken[lane] = 0.0
        shoal.count[1, lane] += 1
        shoal.budget[lane] -= 1.0
        length *= in_parts(max(0.2, 0.9 * inverse_root(error, method.order)))
        shoal.length[lane] = shoal.proposed[lane] = length
        shoal.again[lane] = 1
        return True
    order, terms, below, above = shoal.order[:, lane], int(shoal.terms[lane]), 0.0, 0.0
    growth, short = growth_of(error, order[0] + 1), length <= SHORT * control.step
    if short:
        if terms > 1:
            below = growth_of(error_of_order(space, lane, terms - 1), terms)
        if order[2] == 1:
            above = growth_of(error_of_order(space, lane, terms + 1), terms + 2)
    order[0], order[1], order[2], growth = next_order(
        order[0], order[1], terms, method.adams, short, growth, below, above
    )
    growth = adams_growth(shoal.known[lane], order[0], growth)
    shoal.known[lane] = min(shoal.known[lane] + 1, method.adams)
    grown, proposed = length * in_parts(growth), shoal.proposed[lane]
    shoal.proposed[lane] = min(control.step, grown if length >= proposed else max(proposed, grown))
    start, target = shoal.start[lane], shoal.target[lane]
    if abs(start + length - target) <= round_off(row, lane, shoal):
        length = target - start
    shoal.length[lane] = length
    shoal.again[lane] = 0
    shoal.count[0, lane] += 1
    shoal.budget[lane] = min(control.spare_steps, shoal.budget[lane] + control.most_steps * length) - 1.0
    more = start + length < shoal.due[lane] or look_back(row, lane, space)
    shoal.start[lane] = start + length
    return more
