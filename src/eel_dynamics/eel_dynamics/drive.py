"""The shape that drives the body: laws, samples of a controller, and the blends between them, as rows times factors.

Every law is a sum of fields of X times functions of time alone,

    K(t, X) = sum_m c_m(t) row_m(X),

since sin(kX + phase - wt) = sin(kX + phase) cos wt - cos(kX + phase) sin wt. The rows are tabulated once: at the nodes,
at the stations, and as the Magnus moments of the intervals that lead to both; an instant needs the factors c_m only.
The difference between a motion and the law that takes over, and the quintic between two instants of a controller, are
of the same form.
"""

from typing import NamedTuple

import numpy as np

from .compiled import inlined, shared
from .lanes import WIDTH, aligned, floor, put, spread, take
from .packed import Form

AXES = {"pitch": 0, "yaw": 1}
MOMENT_POINTS = 10  # Gauss points per interval for the Magnus moments
PI_1, PI_2 = 1.5707963267341256, 6.077100506506192e-11  # pi/2 in two parts, the first with trailing zeros
# of (sin(x)/x - 1)/x^2 and (cos(x) - 1)/x^2 by x^2, from the highest power down
SINE = (-1 / 1307674368000, 1 / 6227020800, -1 / 39916800, 1 / 362880, -1 / 5040, 1 / 120, -1 / 6)
COSINE = (1 / 20922789888000, -1 / 87178291200, 1 / 479001600, -1 / 3628800, 1 / 40320, -1 / 720, 1 / 24, -0.5)


class Tables(NamedTuple):
    """A shape of m rows, tabulated on n nodes and s stations; k groups of terms."""

    axis: np.ndarray  # (m,) int, 0 pitch (K2), 1 yaw (K3)
    node: np.ndarray  # (m, n) rad/m at the nodes, per unit of factor
    angle: np.ndarray  # (m, n) rad, integral from the nose to the nodes
    bend: np.ndarray  # (m, 3, n) rad, Magnus moments between the nodes
    station: np.ndarray  # (m, s) rad/m
    station_bend: np.ndarray  # (m, 3, s) rad, from the node before each station
    sine: np.ndarray  # (k,) int, row of sin(kX + phase) of the k-th group of terms
    cosine: np.ndarray  # (k,) int, row of cos(kX + phase), -1 without a period


class Times(NamedTuple):
    """What the factors of the rows are made of."""

    origin: float  # s, simulation time of the law's own t = 0
    period: np.ndarray  # (k,) s, 0: constant
    ramp_first: np.ndarray  # (k,) int, first ramp of the envelope
    ramp_count: np.ndarray  # (k,) int, -1: no envelope
    ramps: np.ndarray  # (., 3) start s, end s, delta
    segment: int  # first of the 12 rows of a quintic between two instants, -1: none
    segment_start: float  # s
    segment_end: float  # s
    blend: int  # first of the 6 rows of a blend, -1: none
    blend_start: float  # s
    blend_end: float  # s


Drive = NamedTuple("Drive", [*Tables.__annotations__.items(), *Times.__annotations__.items()])
Drive.__doc__ = """A tabulated shape as the loops take it: `Tables` and `Times`, one behind the other."""


def _any_tables() -> Tables:
    index, rows, moments = np.zeros(1, dtype=np.int64), np.zeros((1, 1)), np.zeros((1, 1, 1))
    return Tables(index, rows, rows, moments, rows, moments, index, index)


def _any_times() -> Times:
    index = np.zeros(1, dtype=np.int64)
    return Times(0.0, np.zeros(1), index, index, np.zeros((1, 1)), -1, 0.0, 0.0, -1, 0.0, 0.0)


TABLES, TIMES = Form(_any_tables), Form(_any_times)
DRIVE = Form(lambda: Drive(*TABLES.example, *TIMES.example))


class Tabulation:
    """Points along the body at which rows are tabulated, and their Magnus moments.

    columns: [nodes n | moments of nodes 3n | stations s | moments of stations 3s]
    """

    def __init__(self, nodes: np.ndarray, previous: np.ndarray, stations: np.ndarray, station_base: np.ndarray):
        self.nodes, self.stations = len(nodes), len(stations)
        points, weights = np.polynomial.legendre.leggauss(MOMENT_POINTS)
        start, end = np.concatenate((previous, station_base)), np.concatenate((nodes, stations))
        self._length = end - start
        inside = 0.5 * (start + end)[:, None] + 0.5 * self._length[:, None] * points
        self.x = np.concatenate((nodes, stations, inside.ravel()))
        b0, b1, b2 = 0.5 * weights, 0.25 * weights * points, 0.125 * weights * points**2
        self._moments = np.stack((b0, 12.0 * b1, 180.0 * b2 - 15.0 * b0))  # B0, alpha2, alpha3 per unit length

    @property
    def width(self) -> int:
        return 4 * (self.nodes + self.stations)

    def columns(self, values: np.ndarray) -> np.ndarray:
        """Tabulated rows (..., width) of fields with `values` (..., len(x)) at the points x."""
        n, s = self.nodes, self.stations
        inside = values[..., n + s :].reshape(*values.shape[:-1], n + s, MOMENT_POINTS)
        moments = np.einsum("...ig,kg->...ki", inside, self._moments) * self._length
        flat = values.shape[:-1]
        return np.concatenate(
            (
                values[..., :n],
                moments[..., :n].reshape(*flat, 3 * n),
                values[..., n : n + s],
                moments[..., n:].reshape(*flat, 3 * s),
            ),
            axis=-1,
        )

    def split(self, rows: np.ndarray):
        """node (m, n), bend (m, 3, n), station (m, s), station_bend (m, 3, s) of tabulated `rows` (m, width), each with
        zeros behind (`lanes`)."""
        n, s, m = self.nodes, self.stations, len(rows)
        cuts = np.split(rows, [n, 4 * n, 4 * n + s], axis=1)
        shapes = (m, n), (m, 3, n), (m, s), (m, 3, s)
        return tuple(aligned(part.reshape(shape)) for part, shape in zip(cuts, shapes, strict=True))


@inlined
def series_of(z):
    """sin(x)/x and cos(x) of z = x^2 up to 0.62, x up to a quarter of pi, to round-off."""
    s = SINE[0] * z + SINE[1]
    c = (COSINE[0] * z + COSINE[1]) * z + COSINE[2]
    s, c = s * z + SINE[2], c * z + COSINE[3]
    s, c = s * z + SINE[3], c * z + COSINE[4]
    s, c = s * z + SINE[4], c * z + COSINE[5]
    s, c = s * z + SINE[5], c * z + COSINE[6]
    s, c = s * z + SINE[6], c * z + COSINE[7]
    return 1.0 + z * s, 1.0 + z * c


@inlined
def cosine_and_sine(angle):
    """Of an angle [rad], or of eight, to round-off below 1e5; without branches."""
    quarter = floor(angle * (2.0 / np.pi) + 0.5)
    x = (angle - quarter * PI_1) - quarter * PI_2
    s, c = series_of(x * x)
    s *= x
    half = quarter - 2.0 * floor(0.5 * quarter)  # 1: a quarter turn to go
    sign = 1.0 - 2.0 * (floor(0.5 * quarter) - 2.0 * floor(0.25 * quarter))  # -1: half a turn to go
    return sign * (c - half * (c + s)), sign * (s + half * (c - s))


@inlined
def quintic(s, length, sign, factor, row):
    """Factors (3, m) [value, rate, acceleration] of the value, rate and acceleration at one end of an interval of
    `length`, at the fraction `s` from that end; the polynomials vanish with two derivatives at the other end. `sign`
    -1: from the end."""
    s2, s3 = s * s, s * s * s
    d, d2 = sign / length, 1.0 / (length * length)
    factor[0, row] = 1.0 - s3 * (10.0 - s * (15.0 - 6.0 * s))
    factor[1, row] = -d * 30.0 * s2 * (1.0 - s) * (1.0 - s)
    factor[2, row] = -d2 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)
    scale = sign * length
    factor[0, row + 1] = scale * (s - s3 * (6.0 - s * (8.0 - 3.0 * s)))
    factor[1, row + 1] = scale * d * (1.0 - s2 * (18.0 - s * (32.0 - 15.0 * s)))
    factor[2, row + 1] = -scale * d2 * s * (36.0 - s * (96.0 - 60.0 * s))
    scale = length * length
    factor[0, row + 2] = scale * 0.5 * s2 * (1.0 - s) ** 3
    factor[1, row + 2] = scale * d * 0.5 * s * (1.0 - s) ** 2 * (2.0 - 5.0 * s)
    factor[2, row + 2] = scale * d2 * (1.0 - s) * (1.0 - s * (8.0 - 10.0 * s))


@shared
def factors(drive, time, factor):
    """Factors c_m (3, m) at `time` [s]: value, rate [1/s] and acceleration [1/s^2]."""
    own = time - drive.origin
    for k in range(len(drive.period)):
        e, e1, e2 = 1.0, 0.0, 0.0
        if drive.ramp_count[k] >= 0:
            e = 0.0
            for j in range(drive.ramp_first[k], drive.ramp_first[k] + drive.ramp_count[k]):
                start, end, delta = drive.ramps[j, 0], drive.ramps[j, 1], drive.ramps[j, 2]
                if own >= end:
                    e += delta
                elif own > start:
                    length = end - start
                    part = (own - start) / length
                    angle = 2.0 * np.pi * part
                    c, s = cosine_and_sine(angle)
                    e += delta * (part - s / (2.0 * np.pi))
                    e1 += delta * (1.0 - c) / length
                    e2 += delta * 2.0 * np.pi * s / (length * length)
        row = drive.sine[k]
        if drive.period[k] == 0.0:
            factor[0, row], factor[1, row], factor[2, row] = e, e1, e2
        else:
            turns = own / drive.period[k]
            angle = 2.0 * np.pi * (turns - np.floor(turns))
            w = 2.0 * np.pi / drive.period[k]
            c, s = cosine_and_sine(angle)
            factor[0, row] = e * c
            factor[1, row] = e1 * c - e * w * s
            factor[2, row] = (e2 - e * w * w) * c - 2.0 * e1 * w * s
            row = drive.cosine[k]
            factor[0, row] = -e * s
            factor[1, row] = -e1 * s - e * w * c
            factor[2, row] = -(e2 - e * w * w) * s - 2.0 * e1 * w * c
    if drive.segment >= 0:
        length = drive.segment_end - drive.segment_start
        part = min(1.0, max(0.0, (time - drive.segment_start) / length))
        for axis in range(2):
            quintic(part, length, 1.0, factor, drive.segment + 6 * axis)
            quintic(1.0 - part, length, -1.0, factor, drive.segment + 6 * axis + 3)
    if drive.blend >= 0:
        length = drive.blend_end - drive.blend_start
        part = (time - drive.blend_start) / length
        for axis in range(2):
            if part >= 1.0:
                factor[:, drive.blend + 3 * axis : drive.blend + 3 * axis + 3] = 0.0
            else:
                quintic(max(0.0, part), length, 1.0, factor, drive.blend + 3 * axis)


@shared
def combine(axis, rows, factor, blocks, result):
    """Sum over rows of factor (m,) times rows (m, n), apart for pitch and yaw, into `result` (2, n)."""
    for k in range(blocks):
        i = WIDTH * k
        pitch = yaw = spread(0.0)
        for m in range(len(axis)):
            if axis[m] == 0:
                pitch += factor[m] * take(rows, m, i)
            else:
                yaw += factor[m] * take(rows, m, i)
        put(result, 0, i, pitch)
        put(result, 1, i, yaw)


@inlined
def combine_moments(axis, rows, factor, blocks, result):
    """Sum over rows of factor (m,) times rows (m, 3, n), apart for pitch and yaw, into `result` (3, 2, n)."""
    for k in range(blocks):
        i = WIDTH * k
        p0 = p1 = p2 = y0 = y1 = y2 = spread(0.0)
        for m in range(len(axis)):
            c = factor[m]
            if axis[m] == 0:
                p0 += c * take(rows, m, 0, i)
                p1 += c * take(rows, m, 1, i)
                p2 += c * take(rows, m, 2, i)
            else:
                y0 += c * take(rows, m, 0, i)
                y1 += c * take(rows, m, 1, i)
                y2 += c * take(rows, m, 2, i)
        put(result, 0, 0, i, p0)
        put(result, 1, 0, i, p1)
        put(result, 2, 0, i, p2)
        put(result, 0, 1, i, y0)
        put(result, 1, 1, i, y1)
        put(result, 2, 1, i, y2)
