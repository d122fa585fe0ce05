"""Orientation of the sections from the curvature, compiled: R' = R hat(K) along the body (eq. 25)."""

import numpy as np

from .compiled import compiled, inlined
from .drive import series_of
from .lanes import WIDTH, any_of, last, moved1, moved2, moved4, put, spread, take
from .vectors import put_three

SERIES = 0.25  # square of half an angle, up to which sine and cosine are taken from their series


@inlined
def put_turns(turn, i, b2, b3, l2, l3, q2, q3):
    """Store eight rotations from `i` on, of intervals with the Magnus moments B0, alpha2, alpha3 of (K2, K3)."""
    a2, a3 = b2 - q2 * (1.0 / 12.0), b3 - q3 * (1.0 / 12.0)
    c1 = a2 * l3 - a3 * l2
    u2, u3 = 20.0 * a2 + q2, 20.0 * a3 + q3
    w1 = -(a2 * q3 - a3 * q2) * (1.0 / 30.0)
    w2 = a3 * c1 * (1.0 / 60.0) - l2
    w3 = -a2 * c1 * (1.0 / 60.0) - l3
    e1 = -(u2 * w3 - u3 * w2) * (1.0 / 240.0)
    e2 = b2 - (u3 * w1 - c1 * w3) * (1.0 / 240.0)
    e3 = b3 - (c1 * w2 - u2 * w1) * (1.0 / 240.0)
    z = 0.25 * (e1 * e1 + e2 * e2 + e3 * e3)  # half angle squared
    s, c = series_of(z)
    s *= 0.5
    put_three(turn, 0, i, s * e1, s * e2, s * e3)
    put(turn, 3, i, c)
    if any_of(z > SERIES):
        put_three(turn, 0, i, e1, e2, e3)
        turn_far(turn, i)


@inlined
def turns(bend, blocks, turn):
    """Rotations over intervals, as quaternions (4, n), by the sixth-order Magnus series of R' = R hat(K).

    bend (3, 2, n) holds B0, alpha2, alpha3 of K = (0, K2, K3) on each interval of length h, from its first three
    Legendre moments (Blanes, Casas and Ros, BIT 40 (2000)); exact where K keeps its direction.
    """
    for k in range(blocks):
        i = WIDTH * k
        b2, b3 = take(bend, 0, 0, i), take(bend, 0, 1, i)
        l2, l3 = take(bend, 1, 0, i), take(bend, 1, 1, i)
        put_turns(turn, i, b2, b3, l2, l3, take(bend, 2, 0, i), take(bend, 2, 1, i))


@compiled
def turn_far(turn, begin):
    """Eight rotations from `begin` on, of vectors (rows 0 to 2 of `turn`) as quaternions, however large."""
    for i in range(begin, begin + WIDTH):
        x, y, z = turn[0, i], turn[1, i], turn[2, i]
        angle = np.sqrt(x * x + y * y + z * z)
        s = np.sin(0.5 * angle) / angle if angle > 1e-8 else 0.5
        turn[0, i], turn[1, i], turn[2, i], turn[3, i] = s * x, s * y, s * z, np.cos(0.5 * angle)


@inlined
def product(x, y, z, w, a, b, c, d):
    """Of two quaternions, (x, y, z, w) times (a, b, c, d)."""
    return (
        (w * a + x * d) + (y * c - z * b),
        (w * b - x * c) + (y * d + z * a),
        (w * c + x * b) + (z * d - y * a),
        (w * d - x * a) - (y * b + z * c),
    )


@inlined
def put_axes(R, i, x, y, z, w):
    """Store the columns t1, t2, t3 of the rotations of eight unit quaternions (x, y, z, w)."""
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    put(R, 0, i, 1.0 - 2.0 * (yy + zz))
    put(R, 1, i, 2.0 * (xy + wz))
    put(R, 2, i, 2.0 * (xz - wy))
    put(R, 3, i, 2.0 * (xy - wz))
    put(R, 4, i, 1.0 - 2.0 * (xx + zz))
    put(R, 5, i, 2.0 * (yz + wx))
    put(R, 6, i, 2.0 * (xz + wy))
    put(R, 7, i, 2.0 * (yz - wx))
    put(R, 8, i, 1.0 - 2.0 * (xx + yy))


@inlined
def orient(turn, blocks, q, R):
    """Section axes, q (4, n) and R (9, n), from head to tail by the product of the rotations between nodes (eq. 25):
    those of 2, 4, 8 successive nodes at once, then that of all before."""
    x0 = y0 = z0 = spread(0.0)
    w0 = spread(1.0)
    for k in range(blocks):
        i = WIDTH * k
        x, y, z, w = take(turn, 0, i), take(turn, 1, i), take(turn, 2, i), take(turn, 3, i)
        x, y, z, w = product(moved1(x, 0.0), moved1(y, 0.0), moved1(z, 0.0), moved1(w, 1.0), x, y, z, w)
        x, y, z, w = product(moved2(x, 0.0), moved2(y, 0.0), moved2(z, 0.0), moved2(w, 1.0), x, y, z, w)
        x, y, z, w = product(moved4(x, 0.0), moved4(y, 0.0), moved4(z, 0.0), moved4(w, 1.0), x, y, z, w)
        x, y, z, w = product(x0, y0, z0, w0, x, y, z, w)
        x0, y0, z0, w0 = spread(last(x)), spread(last(y)), spread(last(z)), spread(last(w))
        put(q, 0, i, x)
        put(q, 1, i, y)
        put(q, 2, i, z)
        put(q, 3, i, w)
        put_axes(R, i, x, y, z, w)
