"""Eight swimmers under way side by side, each in a lane of its own: what is kept of them, and work space."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .adams import HIGHEST
from .integrator import STATE
from .lanes import WIDTH, padded, work_space
from .packed import Form, Layout

NOBODY = -1
WATER = (9,), (3,), (3,), (3,), (5,), (), (2,), (4,), (3,)  # of `Abreast` from R on, by node


class Abreast(NamedTuple):
    """Work space of one evaluation of eight swimmers; n nodes. As `Fields`, with 8n nodes."""

    turn: np.ndarray  # (4, 8) rotation from the node before
    edge: np.ndarray  # (2, 8) m/s or rad/s, a speed at the nose and its noise
    R: np.ndarray  # (9, 8n)
    r: np.ndarray  # (3, 8n) m
    omega: np.ndarray  # (3, 8n) rad/s
    v: np.ndarray  # (3, 8n) m/s
    speed: np.ndarray  # (5, 8n) m/s, rad/s, V1, V2, V3, Omega1; Re/8e4 - 1
    part: np.ndarray  # (8n,)
    rubbing: np.ndarray  # (2, 8n) kg/m/s
    share: np.ndarray  # (4, 8n) m
    integrand: np.ndarray  # (3, 8n) scratch
    column: np.ndarray  # (1, n) scratch, of one swimmer
    row: np.ndarray  # (1, p) m, weights of the integral from a panel's start to a step of the drag
    kinks: np.ndarray  # (8,) how many were noted at the instant


class Laws(NamedTuple):
    """What drives eight swimmers: sums of rows, those of pitch first; m rows, zero where a law has fewer."""

    node: np.ndarray  # (m, 8n) rad/m; where all stay in the plane its integral from the nose, rad
    bend: np.ndarray  # (m, 3, 8n) rad, Magnus moments between the nodes
    value: np.ndarray  # (m, 8) time factors
    rate: np.ndarray  # (m, 8) 1/s
    pitch: int  # rows, of the m


class Shoal(NamedTuple):
    """Eight swimmers under way, a lane for each: the last axis. States have 13 numbers."""

    leg: np.ndarray  # (8,) int, whose leg it is; NOBODY
    fresh: np.ndarray  # (8,) int, 1: the rate at the start is to be evaluated
    again: np.ndarray  # (8,) int, 1: the step is tried again, shorter
    sample: np.ndarray  # (8,) int, the next one
    known: np.ndarray  # (8,) int, steps before it
    order: np.ndarray  # (3, 8) int, in force; steps since it changed; 1 where it may rise by a look at the next one
    count: np.ndarray  # (3, 8) int, steps, rejected steps, evaluations
    slot: np.ndarray  # (8, m) int, row of `Laws` for each row of a swimmer's law
    factor: np.ndarray  # (3, m) time factors of one law
    terms: np.ndarray  # (8,) of the step under way
    start: np.ndarray  # (8,) s, of the step under way
    length: np.ndarray  # (8,) s, its length
    target: np.ndarray  # (8,) s, the breakpoint ahead
    due: np.ndarray  # (8,) s, when the next sample is reached
    proposed: np.ndarray  # (8,) s, length of the next step
    budget: np.ndarray  # (8,) steps that may still be tried before the next are earned by motion
    taken: np.ndarray  # (8,) 1: the step is good
    error: np.ndarray  # (8,) of the step, by the tolerance
    behind: np.ndarray  # (8,) g_j of the term behind the last one
    bounds: np.ndarray  # (3, 8) squares of the body's length and of the least momentum that counts; the tolerance
    scale: np.ndarray  # (2, 8) squares of the greatest angular and linear momentum so far
    lengths: np.ndarray  # (7, 8) s, of the last steps, the latest first
    series: np.ndarray  # (8, 8) scratch
    weight: np.ndarray  # (8, 8) g_j
    beta: np.ndarray  # (8, 8) beta_j
    end: np.ndarray  # (13, 8) state at the start of the step
    trial: np.ndarray  # (13, 8) and at its end
    first: np.ndarray  # (13, 8) rates at its start
    rate: np.ndarray  # (13, 8) and at its end
    differences: np.ndarray  # (7, 13, 8) phi_j at its start
    starred: np.ndarray  # (7, 13, 8) phi*_j
    current: np.ndarray  # (3, 8) m/s
    state: np.ndarray  # (13,) of one swimmer


class Space(NamedTuple):
    """All the work space."""

    shoal: Shoal
    laws: Laws
    fields: Abreast


def abreast_of(nodes: int, widest: int) -> Abreast:
    """Work space for bodies of `nodes` nodes in panels of up to `widest`."""
    return Abreast(
        np.zeros((4, WIDTH)),
        np.zeros((2, WIDTH)),
        *work_space(WATER, WIDTH * nodes),
        column=np.zeros((1, padded(nodes))),
        row=np.zeros((1, padded(widest))),
        kinks=np.zeros(WIDTH, dtype=np.int64),
    )


def laws_of(nodes: int, pitch: int, yaw: int) -> Laws:
    """Space for laws of up to so many rows of pitch and of yaw, on `nodes` nodes."""
    rows = pitch + yaw
    node, bend = work_space(((rows,), (rows, 3)), WIDTH * nodes)
    return Laws(node, bend, np.zeros((rows, WIDTH)), np.zeros((rows, WIDTH)), pitch)


def shoal_of(rows: int) -> Shoal:
    """Eight lanes without swimmers, for laws of up to so many `rows`."""
    index = tuple(np.zeros(WIDTH, dtype=np.int64) for _ in range(5))
    numbers = tuple(np.zeros(WIDTH) for _ in range(10))
    states = tuple(np.zeros((STATE, WIDTH)) for _ in range(4))
    for state in states[:2]:
        state[6] = 1.0
    index[0][:] = NOBODY
    return Shoal(
        *index,
        *(np.zeros((3, WIDTH), dtype=np.int64), np.zeros((3, WIDTH), dtype=np.int64)),
        *(np.zeros((WIDTH, rows), dtype=np.int64), np.zeros((3, rows))),
        *numbers,
        *(np.ones((3, WIDTH)), np.ones((2, WIDTH)), np.ones((HIGHEST + 1, WIDTH))),
        *(np.zeros((WIDTH, WIDTH)), np.zeros((WIDTH, WIDTH)), np.zeros((WIDTH, WIDTH))),
        *states,
        *(np.zeros((HIGHEST + 1, STATE, WIDTH)), np.zeros((HIGHEST + 1, STATE, WIDTH))),
        *(np.zeros((3, WIDTH)), np.zeros(STATE)),
    )


SPACE = Form(lambda: Space(shoal_of(1), laws_of(1, 1, 1), abreast_of(1, 1)))


@lru_cache(maxsize=8)
def space_layout(nodes: int, widest: int, pitch: int, yaw: int) -> Layout:
    """For bodies of `nodes` nodes in panels of up to `widest`, and laws of up to so many rows of pitch and of yaw."""
    return Layout(SPACE, Space(shoal_of(pitch + yaw), laws_of(nodes, pitch, yaw), abreast_of(nodes, widest)))


open_space = SPACE.opener()
