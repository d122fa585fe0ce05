"""Work space of one evaluation, reused by the next: fields along the body, and where its drag is not smooth."""

from typing import NamedTuple

import numpy as np

from .lanes import padded, work_space

MOST_KINKS = 24  # of the drag, along the body at one instant; what is more is integrated without care


class Kinks(NamedTuple):
    """Where the drag is not smooth at the instant: steps of the loads along the body, in no order."""

    number: np.ndarray  # (1,) how many there are
    kind: np.ndarray  # (k,) which row of the speeds changes its sign
    begin: np.ndarray  # (k,) first node of the panel
    fraction: np.ndarray  # (k,) of the panel
    step: np.ndarray  # (k,) of the factor of the load
    row: np.ndarray  # (k, p) m, weights of the integral from the panel's start to the step
    density: np.ndarray  # (k, 6, p) what the step is of, per length about the head
    whole: np.ndarray  # (k, 6) its integral from the panel's start to the step


class Fields(NamedTuple):
    """Work space of one evaluation, reused; n nodes and those that fill it up (`lanes.padded`)."""

    turn: np.ndarray  # (4, n) rotation from the node before, quaternion x y z w
    q: np.ndarray  # (4, n) orientations of the sections, quaternion x y z w
    R: np.ndarray  # (9, n) t1, t2, t3 of the sections
    r: np.ndarray  # (3, n) m, positions
    bend: np.ndarray  # (3, 2, n) the Magnus moments B0, alpha2, alpha3 of (K2, K3) between nodes, rad
    rate: np.ndarray  # (2, n) rad/m/s, Kdot
    accel: np.ndarray  # (2, n) rad/m/s^2, Kddot
    omega: np.ndarray  # (3, n) rad/s, angular velocity of the sections
    v: np.ndarray  # (3, n) m/s, velocity of the sections
    speed: np.ndarray  # (5, n) m/s, rad/s, V1, V2, V3, Omega1; Re/8e4 - 1
    part: np.ndarray  # (n,) part of the turbulent law in the friction
    rubbing: np.ndarray  # (2, n) kg/m/s, friction by V1: of the laminar law, and what the turbulent one adds
    share: np.ndarray  # (4, n) m, weights of the loads with steps
    integrand: np.ndarray  # (6, n) scratch
    inertia: np.ndarray  # (6, 6) of body and water about the head, or its factors L and 1/D of L D L^T
    wrench: np.ndarray  # (6,) scratch
    tail: np.ndarray  # (6,) wrench from the wake, on the body about the head
    drag: np.ndarray  # (6,) wrench of the drag along the body
    losses: np.ndarray  # (3,) drag's power W; V1 m/s and T_f J/m at the tail, whose product is the wake's
    factor: np.ndarray  # (3, m) values and rates of the law's time factors
    kinks: Kinks


ALONG = ((4,), (4,), (9,), (3,), (3, 2), (2,), (2,), (3,), (3,), (5,), (), (2,), (4,), (6,))  # of `Fields`, by node


def fields_of(nodes: int, rows: int, widest: int) -> Fields:
    """Work space for `nodes` nodes in panels of up to `widest`, and a law of `rows` rows."""
    return Fields(
        *work_space(ALONG, nodes),
        inertia=np.zeros((6, 6)),
        wrench=np.zeros(6),
        tail=np.zeros(6),
        drag=np.zeros(6),
        losses=np.zeros(3),
        factor=np.zeros((3, rows)),
        kinks=Kinks(
            number=np.zeros(1, dtype=np.int64),
            kind=np.zeros(MOST_KINKS, dtype=np.uintp),
            begin=np.zeros(MOST_KINKS, dtype=np.uintp),
            fraction=np.zeros(MOST_KINKS),
            step=np.zeros(MOST_KINKS),
            row=np.zeros((MOST_KINKS, padded(widest))),
            density=np.zeros((MOST_KINKS, 6, padded(widest))),
            whole=np.zeros((MOST_KINKS, 6)),
        ),
    )
