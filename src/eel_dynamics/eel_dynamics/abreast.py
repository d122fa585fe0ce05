"""Eight swimmers of one body at a time, each in a lane, by steps of Adams and Bashforth: a batch's march, compiled.

Every lane has its own swimmer, time and step; what is left of a batch moves into the lanes that come free. The states
at the samples are left where they will be observed (`leg.KNOWN`). A swimmer that cannot go on (its motion is not
finite, its steps get too small or too many) is given up here: it swims alone, from its start, and stops as it would.
"""

import numpy as np
from numba import typeof

from .across import rates_across
from .across_plane import rates_across_plane
from .adams import FRACTIONS, HIGHEST
from .compiled import compiled, inlined, spliced
from .integrator import STATE
from .lanes import WIDTH, bits, put, root, size, spread, take, where
from .leg import LEG, open_control, open_method
from .many import MANY, many_of
from .one_abreast import set_out, take_on, weigh
from .shoal import NOBODY, open_space, space_layout

MOST_ABREAST = WIDTH
MOST_ROWS = 64  # of a law: each lane has space for as many as the law with the most of them takes
open_many = MANY.opener()


@spliced
def extrapolate_across(shoal, most):
    """The steps, `trial` from `end`, and the phi*; `most`: terms of the longest sum. As `adams.extrapolate`."""
    length = take(shoal.length, 0)
    some = where(length > 0.0, length, spread(1.0))  # a swimmer that begins has no step yet
    new, old, beta = some, spread(0.0), spread(1.0)
    for k in range(WIDTH):
        put(shoal.series, k, 0, spread(FRACTIONS[k]))
    put(shoal.weight, 0, 0, spread(1.0))
    put(shoal.beta, 0, 0, beta)
    for j in range(1, min(most + 2, WIDTH)):
        ratio, last = some / new, take(shoal.lengths, j - 1, 0)
        for k in range(WIDTH - j):
            put(shoal.series, k, 0, take(shoal.series, k, 0) - ratio * take(shoal.series, k + 1, 0))
        put(shoal.weight, j, 0, take(shoal.series, 0, 0))
        old += last
        beta *= new / old
        new += last
        put(shoal.beta, j, 0, beta)
    for lane in range(WIDTH):
        shoal.behind[lane] = shoal.weight[int(shoal.terms[lane]), lane]
    terms, none = take(shoal.terms, 0), spread(0.0)
    for k in range(STATE):
        change = none
        for j in range(most):
            term = where(terms > 1.0 * j, take(shoal.beta, j, 0) * take(shoal.differences, j, k, 0), none)
            put(shoal.starred, j, k, 0, term)
            change += take(shoal.weight, j, 0) * term
        put(shoal.trial, k, 0, take(shoal.end, k, 0) + length * change)
    x, y, z, w = take(shoal.trial, 3, 0), take(shoal.trial, 4, 0), take(shoal.trial, 5, 0), take(shoal.trial, 6, 0)
    by = 1.0 / root(x * x + y * y + z * z + w * w)
    put(shoal.trial, 3, 0, x * by)
    put(shoal.trial, 4, 0, y * by)
    put(shoal.trial, 5, 0, z * by)
    put(shoal.trial, 6, 0, w * by)


@inlined
def squares_across(values, first, last):
    """Sums of the squares of the rows `first` to `last` of `values` (m, 8)."""
    square = spread(0.0)
    for k in range(first, last):
        value = take(values, k, 0)
        square += value * value
    return square


@inlined
def larger(a, b):
    """Of two numbers, lane by lane."""
    return where(a > b, a, b)


@spliced
def judge_across(shoal, most):
    """Errors of the steps by the tolerance, as `integrator.error_by_tolerance`. Returns the lanes in which the motion
    is not finite, as bits."""
    behind = take(shoal.behind, 0)
    position = orientation = angular = linear = amount = spread(0.0)
    for k in range(STATE):
        rate = defect = take(shoal.rate, k, 0)
        for j in range(most):
            defect -= take(shoal.starred, j, k, 0)
        defect *= behind
        square = defect * defect
        if k < 3:
            position += square
        elif k < 7:
            orientation += square
        elif k < 10:
            angular += square
        else:
            linear += square
        amount += size(take(shoal.trial, k, 0)) + size(rate)
    body = take(shoal.bounds, 0, 0)
    most_linear = larger(larger(take(shoal.scale, 1, 0), squares_across(shoal.trial, 10, 13)), take(shoal.bounds, 1, 0))
    most_angular = larger(larger(take(shoal.scale, 0, 0), squares_across(shoal.trial, 7, 10)), most_linear * body)
    worst = larger(larger(position / body, orientation), larger(angular / most_angular, linear / most_linear))
    put(shoal.error, 0, root(worst) * take(shoal.length, 0) / take(shoal.bounds, 2, 0))
    return 255 - bits(amount < 1e300)


@spliced
def remember_across(shoal, most):
    """Take on the states and rates of the lanes whose step is good, as `adams.remember`."""
    good = take(shoal.taken, 0) > 0.5
    for j in range(HIGHEST, 0, -1):
        put(shoal.lengths, j, 0, where(good, take(shoal.lengths, j - 1, 0), take(shoal.lengths, j, 0)))
    put(shoal.lengths, 0, 0, where(good, take(shoal.length, 0), take(shoal.lengths, 0, 0)))
    for k in range(STATE):
        rate = take(shoal.rate, k, 0)
        put(shoal.end, k, 0, where(good, take(shoal.trial, k, 0), take(shoal.end, k, 0)))
        put(shoal.first, k, 0, where(good, rate, take(shoal.first, k, 0)))
        put(shoal.differences, 0, k, 0, where(good, rate, take(shoal.differences, 0, k, 0)))
        for j in range(most):
            rate -= take(shoal.starred, j, k, 0)
            put(shoal.differences, j + 1, k, 0, where(good, rate, take(shoal.differences, j + 1, k, 0)))
    for row, first, last in ((0, 7, 10), (1, 10, 13)):
        before = take(shoal.scale, row, 0)
        put(shoal.scale, row, 0, where(good, larger(before, squares_across(shoal.trial, first, last)), before))


@compiled
def march_abreast(legs, many_row, space):
    """Swim the `legs` (B, words), all of one body and method, that begin with FIRST. Those that came through begin with
    KNOWN thereafter."""
    many, method, planar = open_many(many_row), open_method(legs[0]), open_control(legs[0]).planar
    shoal, laws, fields = open_space(space)
    index, lane = 0, 0
    for lane in range(WIDTH):
        index = take_on(legs, index, lane, space)
    while True:
        most, swimming = 0, False
        for lane in range(WIDTH):
            while shoal.leg[lane] != NOBODY and not set_out(legs[shoal.leg[lane]], method, lane, laws, shoal):
                index = take_on(legs, index, lane, space)
            if shoal.leg[lane] != NOBODY:
                swimming = True
                most = max(most, int(shoal.terms[lane]))
        if not swimming:
            return
        extrapolate_across(shoal, most)
        if planar:
            poor = rates_across_plane(many, laws, fields, shoal.current, shoal.trial, shoal.rate)
        else:
            poor = rates_across(many, laws, fields, shoal.current, shoal.trial, shoal.rate)
        poor |= judge_across(shoal, most)
        through = 0
        for lane in range(WIDTH):
            leg = shoal.leg[lane]
            if leg != NOBODY and (poor >> lane & 1 or not weigh(legs[leg], method, lane, shoal, space)):
                through |= 1 << lane
        remember_across(shoal, most)
        for lane in range(WIDTH):
            if through >> lane & 1:
                index = take_on(legs, index, lane, space)


def can_abreast(leg) -> bool:
    """Whether a `ReadyLeg` can be swum abreast: by Adams' steps, without the ledger, by a law of no more rows than
    there is space for."""
    few = len(leg.tables.value.axis) <= MOST_ROWS
    return few and leg.method.value.adams > 0 and not leg.control.value.ledger


def swim_abreast(group, rows: np.ndarray):
    """Swim a `group` of legs of one body and method, whose rows are `rows` (B, words), up to eight at a time."""
    many, axes = many_of(group[0].swimmer), [leg.tables.value.axis for leg in group]
    yaw = max(int(axis.sum()) for axis in axes)
    pitch = max(len(axis) - int(axis.sum()) for axis in axes)
    nodes, widest = many.value.matrix.shape
    space = space_layout(nodes, widest, pitch, yaw).space()
    march_abreast(rows, many.row, space.row)


def warm_up():
    """Compile (or load) what `swim_abreast` needs, without swimming."""
    rows = np.zeros((1, LEG.words), dtype=np.int64), MANY.packed(MANY.example).row, space_layout(1, 1, 1, 1).space().row
    march_abreast.compile(tuple(typeof(each) for each in rows))
