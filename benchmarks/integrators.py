# SPDX-License-Identifier: Apache-2.0
"""Methods of integration, measured: evaluations of the head's dynamics for an error of its position.

10 s of the falling gait with laminar friction, fixed steps that end on the kinks of the ramps: Runge-Kutta of orders 2
to 8, the classical method on the rotation group (Munthe-Kaas: steps by the exponential of the turning vector), Adams
and Bashforth (one evaluation a step), with a corrector (PEC one, PECE two); and the library's own, with adaptive steps.

The explicit Runge-Kutta methods: midpoint, order 2; Bogacki and Shampine, Appl. Math. Lett. 2 (1989), 3; classical, 4;
Dormand and Prince, J. Comp. Appl. Math. 6 (1980), 5; Butcher, J. Austral. Math. Soc. 4 (1964), 6; Fehlberg, NASA
TR R-287 (1968), 7; Prince and Dormand's DOP853 (Hairer, Norsett and Wanner, section II.5), 8.
"""

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from measuring import MOTION, Lines
from scipy.integrate import RK23, RK45
from scipy.integrate._ivp import dop853_coefficients as dop853
from scipy.spatial.transform import Rotation

import eel_core
from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling

DURATION, RESOLUTION = 10.0, 30.0
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
STEPS = (3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100, 130, 160, 220, 320)  # per second
MOST = 20_000  # evaluations of a run of the study
EXACT = Accuracy(name="exact", resolution=60.0, tolerance=1e-13)
STILL = np.zeros(3)  # m/s, the current
TURN = slice(3, 7)  # of the state: x y z w, world from head
UNSTABLE = np.errstate(over="ignore", invalid="ignore")  # what a method blows up to is an infinite error
Rate = Callable[[float, np.ndarray], np.ndarray]  # of the state (13,), at a time [s] and a state
Swim = Callable[[int], tuple[np.ndarray, int]]  # of steps a second; the state (13,) after the run, its evaluations


class Tableau(NamedTuple):
    """A Runge-Kutta method of s stages."""

    order: int
    a: np.ndarray  # (s, s)
    b: np.ndarray  # (s,)

    @classmethod
    def of(cls, order: int, rows: str, weights: str) -> "Tableau":
        """Coefficients as fractions; the rows, from the second stage on, are parted by semicolons."""
        found = [np.array([float(Fraction(each)) for each in row.split()]) for row in ("", *rows.split(";"), weights)]
        return cls(order, np.array([np.pad(row, (0, len(found[-1]) - len(row))) for row in found[:-1]]), found[-1])


TABLEAUS = {
    "midpoint": Tableau.of(2, "1/2", "0 1"),
    "Bogacki-Shampine": Tableau(3, RK23.A, RK23.B),
    "classical": Tableau.of(4, "1/2; 0 1/2; 0 0 1", "1/6 1/3 1/3 1/6"),
    "Dormand-Prince": Tableau(5, np.pad(RK45.A, ((0, 0), (0, 1))), RK45.B),
    "Butcher": Tableau.of(
        6,
        "1/3; 0 2/3; 1/12 1/3 -1/12; -1/16 9/8 -3/16 -3/8; 0 9/8 -3/8 -3/4 1/2; 9/44 -9/11 63/44 18/11 0 -16/11",
        "11/120 0 27/40 27/40 -4/15 -4/15 11/120",
    ),
    "Fehlberg": Tableau.of(
        7,
        "2/27; 1/36 1/12; 1/24 0 1/8; 5/12 0 -25/16 25/16; 1/20 0 0 1/4 1/5; -25/108 0 0 125/108 -65/27 125/54;"
        "31/300 0 0 0 61/225 -2/9 13/900; 2 0 0 -53/6 704/45 -107/9 67/90 3;"
        "-91/108 0 0 23/108 -976/135 311/54 -19/60 17/6 -1/12;"
        "2383/4100 0 0 -341/164 4496/1025 -301/82 2133/4100 45/82 45/164 18/41",
        "41/840 0 0 0 0 34/105 9/35 9/35 9/280 9/280 41/840",
    ),
    "DOP853": Tableau(8, dop853.A[:12, :12], dop853.B),
}


def adams_weights(points: np.ndarray) -> np.ndarray:
    """Weights that integrate from 0 to 1 the polynomial through values at `points`."""
    return np.linalg.solve(np.vander(points, increasing=True).T, 1.0 / np.arange(1, len(points) + 1))


def _make_unit(y: np.ndarray) -> None:
    y[TURN] /= np.sqrt(y[TURN] @ y[TURN])


def _angular_velocity(orientation: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Angular velocity (3,) [rad/s], head's axes, of an `orientation` that changes with `rate`."""
    v, w, v_rate, w_rate = orientation[:3], orientation[3], rate[:3], rate[3]
    return 2.0 * (w * v_rate - w_rate * v - np.cross(v, v_rate))


def _runge_kutta(rate: Rate, y: np.ndarray, start: float, h: float, count: int, method: Tableau, group=False) -> None:
    """Advances `y` by `count` steps of `h` [s]. group: the orientation takes its steps on the rotation group."""
    stages, instants = len(method.b), method.a.sum(axis=1)
    weights = np.vstack((method.a, method.b))
    k, turn = np.zeros((stages, 13)), np.zeros((stages, 3))
    for m in range(count):
        for i in range(stages + 1):
            trial = y + h * (weights[i, :i] @ k[:i])
            if group:
                w = h * (weights[i, :i] @ turn[:i])
                if not np.all(np.abs(w) < 1e3):  # rad: it has blown up
                    y[:] = np.nan
                    return
                trial[TURN] = (Rotation.from_quat(y[TURN]) * Rotation.from_rotvec(w)).as_quat()
            if i == stages:
                break
            k[i] = rate(start + (m + instants[i]) * h, trial)
            if group:  # inverse of the exponential's derivative: 1 + ad/2 + ad^2/12, rates in the head's axes
                omega = _angular_velocity(trial[TURN], k[i, TURN])
                first = np.cross(w, omega)
                turn[i] = omega + 0.5 * first + np.cross(w, first) / 12.0
        y[:] = trial
        _make_unit(y)


def _begin(scene: Scene, kinks: str = "all") -> tuple[Rate, np.ndarray]:
    """The rate of a swimmer's state, and the state that it starts from. Kinks of the drag that are not located are
    summed over the nodes as they are."""
    accuracy = Accuracy(name="study", resolution=RESOLUTION, kinks=kinks)
    simulation = Simulation(accuracy=accuracy, scene=scene, law=falling())
    instant, law = eel_core.Instant(simulation.discretisation.swimmer), simulation.law_on_grid
    return lambda time, y: np.array(instant.rate(law, STILL, time, y)), simulation.state


@UNSTABLE
def runge_kutta(method: Tableau, scene: Scene, per_second: int, group: bool = False, kinks: str = "all"):
    """As a `Swim`."""
    rate, y = _begin(scene, kinks)
    count = round(DURATION * per_second)
    _runge_kutta(rate, y, 0.0, 1.0 / per_second, count, method, group)
    return y, count * len(method.b)


@UNSTABLE
def adams(order: int, corrects: bool, evaluates: bool, scene: Scene, per_second: int) -> tuple[np.ndarray, int]:
    """As a `Swim`, begun by the classical method with half the step. corrects: by the implicit method; evaluates: once
    more after that."""
    rate, y = _begin(scene)
    h, count = 1.0 / per_second, round(DURATION * per_second)
    rates = [rate(0.0, y)]  # at the last instants, newest first
    for m in range(1, order):
        _runge_kutta(rate, y, (m - 1) * h, 0.5 * h, 2, TABLEAUS["classical"])
        rates.insert(0, rate(m * h, y))
    predictor, corrector = adams_weights(-np.arange(order)), adams_weights(1.0 - np.arange(order))
    for m in range(order, count + 1):
        trial = y + h * (predictor @ rates)
        _make_unit(trial)
        rates = [rate(m * h, trial), *rates[:-1]]
        y = y + h * (corrector @ rates) if corrects else trial
        _make_unit(y)
        if evaluates:
            rates[0] = rate(m * h, y)
    return y, (count - order + 1) * (2 if evaluates else 1) + 9 * (order - 1)


def _fixed_steps(scene: Scene) -> Iterator[tuple[str, int, Swim]]:
    """Name, evaluations of a step, and swim of each method."""
    for name, method in TABLEAUS.items():
        yield f"Runge-Kutta {method.order}, {name}", len(method.b), partial(runge_kutta, method, scene)
    yield "Runge-Kutta 4 on the rotation group", 4, partial(runge_kutta, TABLEAUS["classical"], scene, group=True)
    for name, corrects, evaluates in (
        ("Adams-Bashforth", False, False),
        ("Adams PEC", True, False),
        ("Adams PECE", True, True),
    ):
        for order in (2, 3, 4, 5, 6):
            yield f"{name} {order}", 1 + evaluates, partial(adams, order, corrects, evaluates, scene)


def _fewest(points: Iterable[tuple[float, int]], target: float) -> str:
    """Fewest evaluations among (error, evaluations) from which on the error stays below `target`."""
    good = None
    for error, count in sorted(points, key=lambda point: -point[1]):
        if not error <= target:
            break
        good = count
    return f"{good:7d}" if good else "      -"


def integrators() -> Lines:
    """Evaluations for an error of the head's position after 10 s of falling, laminar friction, by the method; and the
    orders that are seen."""
    scene = Scene(friction="laminar", **MOTION)
    swim = partial(simulate, falling(), DURATION, scene=scene, estimate=False)
    exact = swim(accuracy=EXACT, sample_period=0.1)
    yield "method" + " " * 36 + "".join(f"{target:8.0e}" for target in TARGETS), None, ""

    def row(name: str, swims: Iterable[tuple[np.ndarray, int]]) -> tuple[str, None, str]:
        points = []
        for position, evaluations in swims:
            error = float(np.linalg.norm(position[:3] - exact.position[-1])) / exact.path_length
            points.append((error if np.isfinite(error) else np.inf, evaluations))
        return f"{name:42s}" + "".join(" " + _fewest(points, target) for target in TARGETS), None, ""

    for name, cost, fixed in _fixed_steps(scene):
        yield row(name, (fixed(n) for n in STEPS if n * cost * DURATION <= MOST))
    for method, order in (*(("adams", order) for order in (3, 4, 5, 6)), ("dormand_prince", 5)):
        settings: dict[str, Any] = {"name": "study", "resolution": RESOLUTION, "method": method, "order": order}
        targets = [Accuracy(tolerance=each, **settings) for each in np.logspace(-3, -10, 22)]
        runs = (swim(accuracy=accuracy, sample_period=DURATION) for accuracy in targets)
        yield row(f"adaptive: {method} {order}", ((run.position[-1], run.evaluations) for run in runs))
    yield from _orders()


def _orders() -> Lines:
    """Orders that Dormand and Prince's method shows, from 20 to 80 steps a second, by what is not smooth."""
    for name, friction, resistive, kinks in (
        ("no drag", "laminar", False, "all"),
        ("laminar friction, kinks located", "laminar", True, "all"),
        ("laminar friction, kinks ignored", "laminar", True, "none"),
        ("printed friction, jump located", "printed", True, "all"),
        ("printed friction, jump ignored", "printed", True, "none"),
    ):
        scene = Scene(friction=friction, resistive=resistive, **MOTION)
        swim = partial(runge_kutta, TABLEAUS["Dormand-Prince"], scene, kinks=kinks)
        exact, *swims = (swim(per_second)[0][:3] for per_second in (640, 20, 40, 80))
        errors = [np.linalg.norm(each - exact) for each in swims]
        order = float(np.log2(errors[0] / errors[2]) / 2.0)
        yield f"order seen, {name}", order, f"errors {errors[0]:.1e} to {errors[2]:.1e} m"
