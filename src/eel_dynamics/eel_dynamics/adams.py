"""Steps of Adams and Bashforth of variable length: one evaluation a step, from the rates at the ends of earlier steps.

    y(t + h) = y(t) + h sum_j g_j phi*_j,  phi*_j = beta_j phi_j
    phi_0 = f,  phi_(j+1) = phi_j - phi*_j of the step before

in modified divided differences (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section III.5,
eqs 5.7 to 5.10). The next term of the sum, known once the new rate is, estimates the error of the step. The first steps
after a start rise in order, from one.

Steps that are stable get longer as the order falls: 2/7, 6/11, 1 and 2 times the time of the fastest decay at orders 4
to 1. So where steps have become very short, the order is that of three neighbours that promises the longest step, as in
Hindmarsh's LSODE; elsewhere it is the one asked for.
"""

from typing import NamedTuple

import numpy as np

from .compiled import inlined, spliced
from .lanes import WIDTH, aligned, first, following, put, spread, take

SPACE = 2 * WIDTH  # that a state takes
FRACTIONS = aligned(1.0 / np.arange(1.0, WIDTH + 1.0), WIDTH)
EQUAL = np.array([1, 1 / 2, 5 / 12, 3 / 8, 251 / 720, 95 / 288, 19087 / 60480, 5257 / 17280])  # g_j of equal steps
HIGHEST = 6  # beyond, the steps that are stable are shorter than those that are exact
SHORT = 0.0125  # of the longest step: below, the order may fall; the most exact runs that are offered do not get there


class Past(NamedTuple):
    """What Adams' steps know of the steps before; states have 13 numbers and zeros up to 16."""

    differences: np.ndarray  # (k + 1, 16) phi_j at the end of the last step
    starred: np.ndarray  # (k + 2, 16) phi*_j of the step under way
    lengths: np.ndarray  # (k + 1,) s, of the last steps, the latest first; 1 before they are known
    known: np.ndarray  # (2,) int, how many of them there are; terms of the step under way
    order: np.ndarray  # (3,) int, in force; steps since it changed; 1 where it may change: steps are short
    weight: np.ndarray  # (8,) g_j


@spliced
def extrapolate(past, length, y, trial):
    """The step: `trial` (16,) from `y` (16,), and the phi*. Returns the number of terms."""
    terms = min(past.order[0], past.known[0] + 1)
    top = terms + past.order[2]  # the last g, for the error
    equal = True
    for j in range(top - 1):
        equal &= past.lengths[j] == length
    if equal:
        put(past.weight, 0, take(EQUAL, 0))
    else:
        row = take(FRACTIONS, 0)
        new = length  # s, from the end of the step to rates before
        for j in range(1, top + 1):
            row -= following(row) * (length / new)
            past.weight[j] = first(row)
            new += past.lengths[j - 1]
    low = high = spread(0.0)
    beta, new, old = 1.0, length, 0.0  # old: s, from the start of the step to rates before
    for j in range(top):
        if j > 0 and not equal:
            old += past.lengths[j - 1]
            beta *= new / old
            new += past.lengths[j - 1]
        a, b = beta * take(past.differences, j, 0), beta * take(past.differences, j, WIDTH)
        put(past.starred, j, 0, a)
        put(past.starred, j, WIDTH, b)
        if j < terms:
            low += past.weight[j] * a
            high += past.weight[j] * b
    put(trial, 0, take(y, 0) + length * low)
    put(trial, WIDTH, take(y, WIDTH) + length * high)
    past.known[1] = terms
    return terms


@spliced
def remember(past, terms, length, rate, row):
    """Take on a step of `length` [s] and so many `terms`, with the `rate[row]` (16,) at its end."""
    low, high = take(rate, row, 0), take(rate, row, WIDTH)
    put(past.differences, 0, 0, low)
    put(past.differences, 0, WIDTH, high)
    for j in range(terms):
        low -= take(past.starred, j, 0)
        high -= take(past.starred, j, WIDTH)
        put(past.differences, j + 1, 0, low)
        put(past.differences, j + 1, WIDTH, high)
    for j in range(len(past.lengths) - 1, 0, -1):
        past.lengths[j] = past.lengths[j - 1]
    past.lengths[0] = length
    past.known[0] = min(past.known[0] + 1, len(past.lengths) - 1)


@spliced
def defect_of_order(past, terms, rate, row, defect):
    """Error estimate `defect` (16,) by the step's length of a step of so many `terms`, with the `rate[row]` (16,) at
    its end."""
    low, high = take(rate, row, 0), take(rate, row, WIDTH)
    for j in range(terms):
        low -= take(past.starred, j, 0)
        high -= take(past.starred, j, WIDTH)
    put(defect, 0, past.weight[terms] * low)
    put(defect, WIDTH, past.weight[terms] * high)


@inlined
def next_order(order, since, terms, highest, short, growth, below, above):
    """The order in force after a step of so many `terms`, `since` how many steps it has been, 1 where it may rise by a
    look at its neighbour, and the `growth` of the step. Where steps are `short`: `below` and `above` are the growths
    that the neighbours promise, 0 where they were not looked at."""
    settled, change = since > order, 0
    since += 1
    if not short:
        if settled and order < highest:
            order, since = order + 1, 0
        return order, since, 0, growth
    if below > 1.1 * growth:
        growth, change = below, -1
    elif settled and terms == order < highest and above > 1.3 * growth:
        growth, change = above, 1
    if change != 0:
        order, since = terms + change, 0
    return order, since, 1 if since > terms and order < highest else 0, growth


@spliced
def adams_growth(known, order, growth):
    """What of a proposed `growth` of the step is taken: none where it is little, so that steps stay equal; twice at
    most while the `order` is not yet reached by the steps that are `known`, and half as much again later."""
    if known + 1 < order:
        return min(2.0, growth)
    if 1.0 <= growth < 1.15:
        return 1.0
    return min(1.5, growth)
