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

from .compiled import spliced

HIGHEST = 6  # beyond, the steps that are stable are shorter than those that are exact
SHORT = 0.0125  # of the longest step: below, the order may fall; the most exact runs that are offered do not get there


class Past(NamedTuple):
    """What Adams' steps know of the steps before."""

    differences: np.ndarray  # (k + 1, 13) phi_j at the end of the last step
    starred: np.ndarray  # (k + 1, 13) phi*_j of the step under way
    lengths: np.ndarray  # (k + 1,) s, of the last steps, the latest first
    known: np.ndarray  # (2,) int, how many of them there are; terms of the step under way
    order: np.ndarray  # (3,) int, in force; steps since it changed; 1 where it may change: steps are short
    weight: np.ndarray  # (k + 2, k + 3) g_j in the first column


def past_of(order: int, size: int) -> Past:
    """For steps of up to `order` of a state of `size` numbers."""
    order = max(order, 1)
    return Past(
        differences=np.zeros((order + 1, size)),
        starred=np.zeros((order + 1, size)),
        lengths=np.ones(order + 1),
        known=np.zeros(2, dtype=np.int64),
        order=np.zeros(3, dtype=np.int64),
        weight=np.zeros((order + 2, order + 3)),
    )


@spliced
def extrapolate(past, length, y, trial):
    """The step: `trial` (13,) from `y` (13,), and the phi*. Returns the number of terms."""
    weight = past.weight
    terms = min(past.order[0], past.known[0] + 1)
    top = terms + past.order[2]  # the last g, for the error
    beta, new, old = 1.0, length, 0.0  # new, old: s, from the end and from the start of the step to rates before
    for q in range(top + 1):
        weight[0, q] = 1.0 / (q + 1.0)
    for j in range(1, top + 1):
        for q in range(top + 1 - j):
            weight[j, q] = weight[j - 1, q] - weight[j - 1, q + 1] * length / new
        new += past.lengths[j - 1]
    new = length
    for j in range(top):
        if j > 0:
            old += past.lengths[j - 1]
            beta *= new / old
            new += past.lengths[j - 1]
        for k in range(len(y)):
            past.starred[j, k] = beta * past.differences[j, k]
    for k in range(len(y)):
        total = 0.0
        for j in range(terms):
            total += weight[j, 0] * past.starred[j, k]
        trial[k] = y[k] + length * total
    past.known[1] = terms
    return terms


@spliced
def remember(past, terms, length, rate):
    """Take on a step of `length` [s] and so many `terms`, with the `rate` (13,) at its end."""
    for k in range(len(rate)):
        value = rate[k]
        past.differences[0, k] = value
        for j in range(terms):
            value -= past.starred[j, k]
            past.differences[j + 1, k] = value
    for j in range(len(past.lengths) - 1, 0, -1):
        past.lengths[j] = past.lengths[j - 1]
    past.lengths[0] = length
    past.known[0] = min(past.known[0] + 1, len(past.lengths) - 1)


@spliced
def defect_of_order(past, terms, rate, defect):
    """Error estimate `defect` (13,) by the step's length of a step of so many `terms`, with the `rate` (13,) at its
    end."""
    for k in range(len(rate)):
        value = rate[k]
        for j in range(terms):
            value -= past.starred[j, k]
        defect[k] = past.weight[terms, 0] * value


@spliced
def adams_growth(past, growth):
    """What of a proposed `growth` of the step is taken: none where it is little, so that steps stay equal; twice at
    most while the order rises, and half as much again later."""
    if past.known[0] + 1 < past.order[0]:
        return min(2.0, growth)
    if 1.0 <= growth < 1.15:
        return 1.0
    return min(1.5, growth)
