"""A body in a scene, tabulated for eight swimmers that swim it side by side."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .lanes import WIDTH, Each
from .packed import Form, Packed
from .sections import SWIMMER, Swimmer

EVERYWHERE = (  # what the kernel takes node by node
    *("weight", "mass", "added2", "added3", "inertia1", "inertia2", "inertia3", "drag2", "drag3", "drag_roll"),
    *("laminar", "turbulent", "reynolds"),
)


class Many(NamedTuple):
    """A body in a scene, as eight swimmers have it; n nodes."""

    one: Swimmer
    eight: Swimmer  # every node eight times, its arrays `Each`
    matrix: np.ndarray  # (n, p) m, of the integral from a panel's start to each node


@lru_cache(maxsize=16)
def many_of(swimmer: Packed) -> Packed:
    """The `Many` of a packed swimmer."""
    return MANY.packed(eight_times(swimmer.value))


def eight_times(one: Swimmer) -> Many:
    """A swimmer's tables, also with every node eight times."""
    nodes, matrix = len(one.x), np.zeros((len(one.x), int(one.count.max())))
    for i in range(nodes):
        block, lane = divmod(i, WIDTH)
        begin = int(one.upto.start[block] + one.first[i] - one.upto.source[block])
        matrix[i, : one.count[i]] = one.upto.columns[begin : begin + int(one.count[i]), lane]

    each = {name: Each(getattr(one, name)) for name in EVERYWHERE}
    return Many(one, one._replace(blocks=nodes, **each), matrix)


MANY = Form(lambda: eight_times(SWIMMER.example))
