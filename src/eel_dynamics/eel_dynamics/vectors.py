"""Vectors of eight nodes at once, and their components in the axes of the sections, compiled.

R (9, n) holds t1, t2, t3 of the sections one after the other, in the axes of the head.
"""

from .compiled import inlined
from .lanes import put, take


@inlined
def cross(ax, ay, az, bx, by, bz):
    """a x b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@inlined
def dot(ax, ay, az, bx, by, bz):
    """a . b."""
    return ax * bx + ay * by + az * bz


@inlined
def two(rows, i):
    """The first two rows of an array at the nodes from i on."""
    return take(rows, 0, i), take(rows, 1, i)


@inlined
def three(rows, first, i):
    """Eight vectors: three rows of an array from `first` on, at the nodes from `i` on."""
    return take(rows, first, i), take(rows, first + 1, i), take(rows, first + 2, i)


@inlined
def put_three(rows, first, i, x, y, z):
    """Store eight vectors."""
    put(rows, first, i, x)
    put(rows, first + 1, i, y)
    put(rows, first + 2, i, z)


@inlined
def in_section(R, i, x, y, z):
    """Components of eight vectors in the axes of the sections from i on."""
    return (
        take(R, 0, i) * x + take(R, 1, i) * y + take(R, 2, i) * z,
        take(R, 3, i) * x + take(R, 4, i) * y + take(R, 5, i) * z,
        take(R, 6, i) * x + take(R, 7, i) * y + take(R, 8, i) * z,
    )


@inlined
def from_section(R, i, a, b, c):
    """The inverse of `in_section`: eight vectors by their components in the axes of the sections from i on."""
    return (
        take(R, 0, i) * a + take(R, 3, i) * b + take(R, 6, i) * c,
        take(R, 1, i) * a + take(R, 4, i) * b + take(R, 7, i) * c,
        take(R, 2, i) * a + take(R, 5, i) * b + take(R, 8, i) * c,
    )


@inlined
def bent(R, bend, i):
    """R (0, K2, K3) of eight sections from i on, by the rows (K2, K3) of `bend`, or by their rates."""
    k2, k3 = two(bend, i)
    bx, by, bz = three(R, 3, i)
    cx, cy, cz = three(R, 6, i)
    return bx * k2 + cx * k3, by * k2 + cy * k3, bz * k2 + cz * k3
