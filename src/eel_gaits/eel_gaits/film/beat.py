# SPDX-License-Identifier: Apache-2.0
"""The mean beat of a filmed swimmer: a period, harmonics in time, smooth functions along the body.

The angle of each segment between two points, less its mean over the body, is free of rigid motion. This function is
fitted to it, weighted by the segment's length:

    theta(t, s) = sum over h = 0 ... H of (a_h(s) cos 2 pi h t / T + b_h(s) sin 2 pi h t / T),   K = d theta / ds

where the curvatures of a_h and b_h are natural cubic splines through `knots` equally spaced knots. H and the number of
knots are chosen by block cross-validation (Burman, Chow and Nolan, Biometrika 81 (1994), doi:10.1093/biomet/81.2.351):
they must best predict each beat from the others. Each whole beat, or one of 40 parts of a film with many, is left out
in turn. So errors that last several frames, which a smoothing spline takes for motion, have no influence unless they
recur with each beat. Of the fits within one standard error of the least error, the one with fewest numbers is taken
(Breiman et al., Classification and Regression Trees, 1984). The fits without each beat give the confidence bands
(jackknife).

A missing point is placed by the fitted beat, moved along with its neighbours. Fit and filling alternate until the
points stop moving (expectation maximisation), also without each beat. Only observed segments judge a fit. Missing ones
widen the bands.
"""

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eel_gaits.film.doubts import doubts_of
from eel_gaits.film.film import Film, filled, unseen_segments
from eel_gaits.film.kinematics import Kinematics, harmonics, kinematics
from eel_gaits.laws.law import Law
from eel_gaits.laws.spline import natural_spline
from eel_gaits.laws.term import Term

FEWEST_BEATS, MOST_PARTS = 3, 40  # fewest beats of a film, and most parts that are left out in turn
LEAST_FRAMES = 4.0  # in a beat
HARMONICS = 5  # at most
LEAST_KNOTS, KNOTS = 2, 12  # along the body
CONDITION = 100.0  # ratio of singular values, beyond which they are dropped: uneven points do not resolve those shapes
TRAVELS = 1.0  # rad: a wave with less phase along the body counts as standing
LEAST_SHARE = 0.5  # of the variance that the other beats must predict
ROUNDS, FILLINGS = 4, 40  # most rounds of choosing, and of filling
STILL = 1e-4  # part of the length: filling ends when points move less
THIN = 10.0  # times the seen frames' spacing: beats cannot be counted across a longer gap
FINE = 257  # places along the body at which splines are integrated
OF_LAW = 65  # knots of the law's splines, where a part of the body is rigid
QUANTILE = 0.975  # of Student's t, for the bands: 95 %


@dataclass(frozen=True, eq=False)
class Beat:
    """The beat of a `film`. Fits without one beat, or with other harmonics, are further `Beat`s."""

    film: Film
    period: float  # s
    harmonics: int
    knots: int  # along the bending part of the body
    rigid: float  # part of the length from the head on that does not bend
    curvature: np.ndarray  # (1 + 2 harmonics, FINE) rad/m, at equal distances along the body: mean, cos, sin, cos ...
    share: float  # of the variance of the angles that the fit explains
    predicted: float  # of that variance, predicted from the other beats
    residual: float  # m, root mean square distance of the points, rigid motion removed
    others: tuple["Beat", ...] = ()  # the fits without each of the beats

    @property
    def most_harmonics(self) -> int:
        """The most harmonics that the frames in a beat resolve: fewer than half of their number."""
        return most_harmonics(self.film, self.period)

    @property
    def measured(self) -> Kinematics:
        """Figures of the swimmer in the film."""
        return kinematics(self.film.time, self.film.points, self.period)

    @property
    def band(self) -> float:
        """Half of the curvature's 95 % band, mean over the body, divided by the greatest amplitude."""
        size = np.max(np.hypot(self.curvature[1], self.curvature[2]))
        return float(np.mean(self.half_band([each.curvature[1:3] for each in self.others])) / size)

    def half_band(self, values: Any) -> np.ndarray:
        """Half of the 95 % band of a figure with the `values` (n, ...) in the `others` (jackknife).

        With missing points it grows as the square root of the number of data falls.
        """
        from scipy.stats import t

        rows, count = np.asarray(values), len(values)
        error = np.sqrt((count - 1) / count * np.sum((rows - rows.mean(axis=0)) ** 2, axis=0))
        unseen = 0.0 if self.film.missing is None else float(np.mean(unseen_segments(self.film.missing)))
        return np.asarray(t.ppf(QUANTILE, count - 1) * error / math.sqrt(1.0 - unseen))

    @property
    def doubts(self) -> list[str]:
        """What the film shows that no real body does, in sentences."""
        return doubts_of(self.film, self.period, self.measured.stride)

    def law(self, length: float, name: str | None = None) -> Law:
        """The beat repeated for ever on a body of `length` [m]. The angles are kept: curvature scales as 1 / length."""
        ratio, count = self.film.length / length, OF_LAW if self.rigid else self.knots
        place = np.linspace(0.0, length, count)
        values = ratio * natural_spline(np.linspace(0.0, length, FINE), self.curvature, place)
        values[:, place < (self.rigid - 1e-9) * length] = 0.0
        terms = [Term(amplitude=tuple(values[0]), knots=tuple(place), phase=0.5 * math.pi)]
        for h, phase in itertools.product(range(1, self.harmonics + 1), (0.5 * math.pi, math.pi)):
            row = values[2 * h - 1 if phase < 2.0 else 2 * h]
            terms.append(Term(amplitude=tuple(row), knots=tuple(place), period=self.period / h, phase=phase))
        return Law(terms, name=name or self.film.name.rpartition(".")[0] or "beat")

    def about(self) -> list[tuple[str, str]]:
        """How the film was read and smoothed: names and sentences."""
        film, seen = self.film, self.measured
        rigid = f", rigid up to {self.rigid:g} of the length" if self.rigid else ""
        beats = (film.time[-1] - film.time[0]) / self.period
        kept = f"{beats:.0f} beats, {self.harmonics} harmonic{'s' if self.harmonics > 1 else ''} kept"
        periods = self.half_band([each.period for each in self.others])
        return [
            ("film", f"{film.name}: {film.points.shape[1]} points, {len(film.time)} frames, {film.length:.4g} m long"),
            *([("read", film.read)] if film.read else []),
            *([("points", ", ".join(film.names))] if film.names else []),
            *(("repaired", note) for note in film.notes),
            *(("doubtful", text) for text in self.doubts),
            ("beat", f"period {self.period:.4g} +- {float(periods):.2g} s (95 %), {kept}"),
            ("along the body", f"splines through {self.knots} knots{rigid}"),
            ("fit", f"{self.share:.1%} of the variance, {self.predicted:.1%} predicted from the other beats; residual "
                    f"{1e3 * self.residual:.3g} mm (RMS), {self.residual / film.length:.2%} of the length; curvature "
                    f"+- {self.band:.1%} (95 %)"),
            ("in the film", f"{seen.speed:.4g} m/s, stride {seen.stride:.3f} L, tail {seen.excursion[-1]:.3f} L from "
                            f"side to side, wave {seen.wavelength:.3f} L, slip {seen.slip:.2f}, Strouhal number "
                            f"{seen.strouhal:.3f}{'' if seen.ahead else '; it drifts tail first: flowing water?'}"),
        ]  # fmt: skip


def beat_of(film: Film, *, harmonics: int | None = None, rigid: float = 0.0) -> Beat:
    """The mean beat of a `film`.

    harmonics: None: the number that predicts best. rigid: part of the length, from the head, that does not bend.
    `ValueError` for a motion that does not repeat, and for points in an implausible order.
    """
    if not 0.0 <= rigid <= 0.9:
        raise ValueError(f"rigid must be a part of the length from 0 to 0.9, got {rigid:g}")
    fit = _Fit(film, rigid)
    found = fit.best(harmonics)
    if not rigid and _phase(found) > TRAVELS:  # a rigid part marks the head
        seen = found.measured.excursion
        if seen[0] <= seen[-1]:
            raise ValueError(
                f"{film.name}: the wave runs from the last point to the first, and the last moves most. Points must "
                "stand from head to tail; a swimmer that swims backward is read by --file"
            )
        note = "points reversed: the wave ran from the last to the first, and the first moved most"
        missing = None if film.missing is None else film.missing[:, ::-1]
        turned = film._replace(
            points=film.points[:, ::-1], names=film.names[::-1], notes=(*film.notes, note), missing=missing
        )
        return beat_of(turned, harmonics=harmonics, rigid=rigid)
    return found


def most_harmonics(film: Film, period: float) -> int:
    """The most harmonics that the frames in a beat of this `period` [s] resolve: fewer than half of their number."""
    frames = (len(film.time) - 1) * period / float(film.time[-1] - film.time[0])
    return max(1, min(HARMONICS, math.ceil(0.5 * frames) - 1))


def _phase(beat: Beat) -> float:
    """Phase [rad] of the curvature's first harmonic from head to tail: negative for a wave towards the last point."""
    wave = beat.curvature[1] - 1j * beat.curvature[2]
    return float(FINE * np.sum(np.imag(np.conj(wave[:-1]) * wave[1:])) / np.sum(np.abs(wave) ** 2))


class _Fit:
    """Least squares of the angles of a film."""

    def __init__(self, film: Film, rigid: float) -> None:
        self.film, self.rigid, self.arc = film, rigid, film.arc
        self.weight = np.diff(self.arc) / np.mean(np.diff(self.arc))  # a point's error turns a short segment further
        self.missing = np.zeros(film.points.shape[:2], dtype=bool) if film.missing is None else film.missing
        self.seen = ~unseen_segments(self.missing)
        self.points = film.points
        self.angles, self.mean = self._angles_of(film.points)
        self.time, self.all = film.time - film.time[0], np.ones(len(film.time), dtype=bool)
        self.power = self._squares(self.angles - self.angles.mean(axis=0))
        if self.power <= 1e-12 * self.angles.size:
            raise ValueError(f"{film.name}: the body does not bend")
        self.period = self._first_period()
        self.beats = np.floor(self.time / self.period + 1e-6).astype(int)
        self.beats = np.minimum(self.beats, max(0, round(self.time[-1] / self.period + 1e-6) - 1))
        self.beats = np.unique(self.beats, return_inverse=True)[1]  # only beats that were seen
        count = int(self.beats[-1]) + 1
        self.beats = self.beats * min(count, MOST_PARTS) // count  # many beats are grouped
        if count < FEWEST_BEATS:
            raise ValueError(
                f"{film.name}: there must be {FEWEST_BEATS} beats or more, got {count} of {self.period:.3g} s"
            )
        told = int(np.sum(self.arc[1:] > rigid * self.arc[-1])) - (0 if rigid else 1)  # angles without rigid rotation
        if told < LEAST_KNOTS:
            raise ValueError(f"{film.name}: rigid up to {rigid:g} of the length leaves {told} points to bend, too few")
        self.bases = {knots: self._basis(knots) for knots in range(LEAST_KNOTS, min(KNOTS, told) + 1)}

    def best(self, harmonics: int | None) -> Beat:
        """The fit that predicts best, together with the fits without each beat."""
        most = most_harmonics(self.film, self.period)
        if harmonics is not None and not 1 <= harmonics <= most:
            raise ValueError(f"harmonics must be 1 to {most} with this film, got {harmonics}")
        orders = range(1, most + 1) if harmonics is None else [harmonics]
        chosen = None
        for turn in range(ROUNDS):
            some = orders if turn or not np.any(self.missing) else orders[:1]  # gaps at one phase hide harmonics
            tried = {each: self._errors(*each) for each in itertools.product(some, self.bases)}
            least = min(tried.values(), key=np.mean)
            good = [each for each, errors in tried.items() if _within_one_error(errors, least)]
            order, knots = min(good, key=lambda each: ((1 + 2 * each[0]) * each[1], np.mean(tried[each])))
            predicted = 1.0 - float(np.sum(tried[order, knots])) / self.power
            period = self._refined(self.period, order, self.all)
            found = self._beat(order, knots, period, self.all, predicted)
            if chosen == (order, knots) or not np.any(self.missing):
                break
            chosen, self.points = (order, knots), found.film.points
            self.angles, self.mean = self._angles_of(self.points)
        if predicted < LEAST_SHARE:
            raise ValueError(
                f"{self.film.name}: the motion does not repeat: at its best period, {self.period:.3g} s, the other "
                f"beats predict {max(predicted, 0.0):.0%} of its variance. Motions that are not steady: --file"
                + "".join(f"; {text}" for text in doubts_of(self.film, self.period)[:1])
            )
        rests = [self.beats != beat for beat in range(self.beats[-1] + 1)]
        others = [self._beat(order, knots, self._refined(period, order, rest), rest, predicted) for rest in rests]
        return replace(found, others=tuple(others))

    def _beat(self, order: int, knots: int, period: float, frames: np.ndarray, predicted: float) -> Beat:
        basis, curvature = self.bases[knots]
        design, points, angles, mean = self._in_time(period, order), self.points, self.angles, self.mean
        for _ in range(FILLINGS):
            found = _solved(design[frames], angles[frames], basis)
            fitted = design @ found @ basis.T
            before, points = points, filled(points, self.missing, self.arc, self._shape(fitted, mean))
            angles, mean = self._angles_of(points)
            if np.max(np.abs(points - before)) <= STILL * self.arc[-1]:
                break
        power = self._squares(self.angles - self.angles.mean(axis=0), frames)
        share = 1.0 - self._squares(fitted - angles, frames) / max(power, 1e-300)
        film = self.film._replace(points=points)
        fit = found @ curvature, share, predicted, self._distance(self._shape(fitted, mean))
        return Beat(film, period, order, knots, self.rigid, *fit)

    def _angles_of(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The weighted angles (N, n - 1) of the segments, without the rotation (N, 1) of the whole body."""
        steps = np.diff(points, axis=1)
        angles = np.unwrap(np.arctan2(steps[..., 1], steps[..., 0]), axis=1)
        mean = self._mean(angles)
        return self.weight * (angles - mean), mean

    def _squares(self, angles: np.ndarray, frames: np.ndarray | None = None) -> float:
        """The sum of squares of these `angles` (N, n - 1) in the `frames`, over observed segments."""
        squares = np.where(self.seen, angles, 0.0) ** 2
        return float(np.sum(squares if frames is None else squares[frames]))

    def _errors(self, order: int, knots: int) -> np.ndarray:
        """The sum of squared errors of each beat, predicted by the fit of the others."""
        angles, _ = self.bases[knots]
        design, found = self._in_time(self.period, order), []
        for beat in range(self.beats[-1] + 1):
            out = self.beats == beat
            guess = design @ _solved(design[~out], self.angles[~out], angles) @ angles.T
            found.append(self._squares(guess - self.angles, out))
        return np.array(found)

    def _basis(self, knots: int) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the segments less their mean (n - 1, P), and curvatures (P, FINE) [rad/m], of P splines."""
        from scipy.interpolate import make_interp_spline

        arc, length = self.arc, float(self.arc[-1])
        fine = np.linspace(0.0, length, FINE)
        start = self.rigid * length
        places = np.linspace(start, length, knots + (1 if self.rigid else 0))
        shapes = np.eye(len(places))[len(places) - knots :]  # 0 at the end of a rigid part
        curvature = np.where(fine < start, 0.0, natural_spline(places, shapes, fine)).T
        twice = make_interp_spline(fine, curvature, k=3).antiderivative(2)
        angles = np.diff(twice(arc), axis=0) / np.diff(arc)[:, None]  # of a chord: the mean over the segment
        return self.weight[:, None] * (angles - self._mean(angles.T).T), curvature.T

    def _mean(self, angles: np.ndarray) -> np.ndarray:
        """The weighted mean (m, 1) over the body of angles (m, n - 1)."""
        return np.average(angles, axis=1, weights=self.weight**2)[:, None]

    def _first_period(self) -> float:
        """The period whose first harmonic explains most of the angles."""
        step, span = float(np.median(np.diff(self.time))), float(self.time[-1])
        if span > THIN * step * len(self.time):
            gap = int(np.argmax(np.diff(self.film.time)))
            raise ValueError(
                f"{self.film.name}: its {len(self.time)} frames are too far apart to count the beats between them, "
                f"with none from {self.film.time[gap]:g} s to {self.film.time[gap + 1]:g} s: give one side of that"
            )
        periods = 1.0 / np.arange(1.5 / span, 1.0 / (LEAST_FRAMES * step), 0.1 / span)
        if not len(periods):
            raise ValueError(f"{self.film.name}: its frames are too few for a beat, {len(self.time)} in {span:.3g} s")
        missed = [self._missed(period, 1, self.all) for period in periods]
        return self._refined(float(periods[int(np.argmin(missed))]), 1, self.all)

    def _refined(self, period: float, order: int, frames: np.ndarray) -> float:
        from scipy.optimize import minimize_scalar

        width = 0.2 * period / self.time[-1]  # the frequency is known to a part of 1 / span
        bounds = period * (1.0 - width), period * (1.0 + width)
        found = minimize_scalar(self._missed, args=(order, frames), bounds=bounds, method="bounded",
                                options={"xatol": 1e-7 * period})  # fmt: skip
        return float(found.x)

    def _missed(self, period: float, order: int, frames: np.ndarray) -> float:
        design, values = self._in_time(period, order)[frames], self.angles[frames]
        along = np.linalg.qr(design)[0]
        return float(np.sum((values - along @ (along.T @ values)) ** 2))

    def _in_time(self, period: float, order: int) -> np.ndarray:
        """1, cos and sin (N, 1 + 2 order) from the middle of the film on, where the phase is least uncertain."""
        turns = 2.0 * math.pi / period * (self.time - 0.5 * self.time[-1])
        return np.column_stack([np.ones_like(turns), *harmonics(turns, order)])

    def _shape(self, fitted: np.ndarray, mean: np.ndarray) -> np.ndarray:
        """The points (N, n, 2) [m] from the `fitted` angles (N, n - 1) and a rotation of the whole body."""
        whole = fitted / self.weight + mean
        steps = np.diff(self.arc)[:, None] * np.stack((np.cos(whole), np.sin(whole)), axis=-1)
        return np.concatenate((np.zeros((len(whole), 1, 2)), np.cumsum(steps, axis=1)), axis=1)

    def _distance(self, shape: np.ndarray) -> float:
        """Root mean square distance [m] between the observed points and a `shape` (N, n, 2)."""
        apart = np.where(self.missing[..., None], np.nan, shape - self.film.points)
        apart = apart - np.nanmean(apart, axis=1, keepdims=True)
        return float(np.sqrt(np.nanmean(np.sum(apart**2, axis=2))))


def _solved(design: np.ndarray, values: np.ndarray, along: np.ndarray) -> np.ndarray:
    """The coefficients C (2 H + 1, P) that minimise the distance of design C along^T from the `values`."""
    basis, root = np.linalg.qr(design)  # leaves a small matrix, which needs no threads
    rows = np.linalg.lstsq(root, basis.T @ values, rcond=None)[0]
    return np.asarray(np.linalg.lstsq(along, rows.T, rcond=1.0 / CONDITION)[0].T)


def _within_one_error(errors: np.ndarray, least: np.ndarray) -> bool:
    apart = errors - least
    return bool(np.mean(apart) <= np.std(apart, ddof=1) / math.sqrt(len(apart)) or np.mean(apart) <= 0.0)
