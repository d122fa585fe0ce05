# SPDX-License-Identifier: Apache-2.0
"""Methods of integration, measured: evaluations of the head's dynamics for an error of its position.

10 s of the falling gait with laminar friction, fixed steps that end on the kinks of the ramps: Runge-Kutta of orders 2
to 8, the classical method on the rotation group (Munthe-Kaas: steps by the exponential of the turning vector), Adams
and Bashforth (one evaluation a step), with a corrector (PEC one, PECE two); and the library's own, with adaptive steps.
"""

from collections.abc import Callable

import numpy as np
from tableaus import adams_weights, tableaus

import eel_core
from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling

DURATION, RESOLUTION = 10.0, 30.0
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
STEPS = (3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100, 130, 160, 220, 320)  # per second
MOST = 20_000  # evaluations of a run of the study
LEAN = {"ledger": False, "internal_wrench": False}
EXACT = Accuracy(name="exact", resolution=60.0, tolerance=1e-13)
PE, PECE, PEC = 0, 1, 2
STILL = np.zeros(3)  # m/s, the current
TURN = slice(3, 7)  # of the state: x y z w, world from head

UNSTABLE = np.errstate(over="ignore", invalid="ignore")  # what a method blows up to is an infinite error
Rate = Callable[[float, np.ndarray], np.ndarray]  # of the state (13,), at a time [s] and a state


def _make_unit(y: np.ndarray):
    y[TURN] /= np.sqrt(y[TURN] @ y[TURN])


def _product(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Product of two quaternions x y z w."""
    (a, b, c, d), (x, y, z, w) = p, q
    return np.array(
        [
            d * x + a * w + b * z - c * y,
            d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w,
            d * w - a * x - b * y - c * z,
        ]
    )


def _turned(orientation: np.ndarray, u: np.ndarray) -> np.ndarray:
    """`orientation` turned by the vector `u` [rad] in its own axes."""
    angle = np.sqrt(u @ u)
    return _product(orientation, np.array([*(0.5 * np.sinc(0.5 * angle / np.pi) * u), np.cos(0.5 * angle)]))


def _angular_velocity(orientation: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Angular velocity (3,) [rad/s], head's axes, of an `orientation` that changes with `rate`."""
    x, y, z, w = orientation
    return 2.0 * _product(np.array([-x, -y, -z, w]), rate)[:3]


def _runge_kutta(rate: Rate, y, start, h, count, tableau, group=False):
    """Advances `y` by `count` steps of `h` [s]. group: the orientation takes its steps on the rotation group."""
    _, a, b, c = tableau
    stages = len(b)
    weights = np.vstack((a, b))
    k, turn = np.zeros((stages, 13)), np.zeros((stages, 3))
    for m in range(count):
        for i in range(stages + 1):
            trial = y + h * (weights[i, :i] @ k[:i])
            if group:
                w = h * (weights[i, :i] @ turn[:i])
                trial[TURN] = _turned(y[TURN], w)
            if i == stages:
                break
            k[i] = rate(start + (m + c[i]) * h, trial)
            if group:  # inverse of the exponential's derivative: 1 + ad/2 + ad^2/12, rates in the head's axes
                omega = _angular_velocity(trial[TURN], k[i, TURN])
                first = np.cross(w, omega)
                turn[i] = omega + 0.5 * first + np.cross(w, first) / 12.0
        y[:] = trial
        _make_unit(y)


def _adams(rate: Rate, y, start, h, count, predictor, corrector, mode, rates):
    """Advances `y` by `count` steps of `h` [s]; `rates` (order, 13) are those at the last instants, newest first."""
    for m in range(count):
        time = start + (m + 1) * h
        trial = y + h * (predictor @ rates)
        _make_unit(trial)
        new = rate(time, trial)
        if mode == PE:
            y[:] = trial
        else:
            y += h * (corrector[0] * new + corrector[1:] @ rates[:-1])
            _make_unit(y)
            if mode == PECE:
                new = rate(time, y)
        rates = np.vstack((new, rates[:-1]))


def _begin(scene, kinks="all") -> tuple[Rate, np.ndarray]:
    """The rate of a swimmer's state, and the state that it starts from. Kinks of the drag that are not located are
    summed over the nodes as they are."""
    accuracy = Accuracy(name="study", resolution=RESOLUTION, kinks=kinks)
    simulation = Simulation(accuracy=accuracy, scene=scene, law=falling())
    instant, law = eel_core.Instant(simulation.discretisation.swimmer), simulation.tabulated_law

    def rate(time, y):
        return np.array(instant.rate(law, STILL, time, y))

    return rate, simulation.state


@UNSTABLE
def runge_kutta(tableau, per_second, scene, group=False, kinks="all") -> tuple[np.ndarray, int]:
    """The state (13,) after the run, and its evaluations."""
    rate, y = _begin(scene, kinks)
    count = round(DURATION * per_second)
    _runge_kutta(rate, y, 0.0, 1.0 / per_second, count, tableau, group)
    return y, count * len(tableau[2])


@UNSTABLE
def adams(order, mode, per_second, scene) -> tuple[np.ndarray, int]:
    """As `runge_kutta`; begun by the classical method with half the step."""
    rate, y = _begin(scene)
    h, count = 1.0 / per_second, round(DURATION * per_second)
    rates = [rate(0.0, y)]
    for m in range(1, order):
        _runge_kutta(rate, y, (m - 1) * h, 0.5 * h, 2, tableaus()["classical"])
        rates.insert(0, rate(m * h, y))
    predictor, corrector = adams_weights(-np.arange(order)), adams_weights(1.0 - np.arange(order))
    _adams(rate, y, (order - 1) * h, h, count - order + 1, predictor, corrector, mode, np.array(rates))
    return y, (count - order + 1) * (2 if mode == PECE else 1) + 9 * (order - 1)


def _contenders(scene):
    for name, tableau in tableaus().items():
        yield f"Runge-Kutta {tableau[0]}, {name}", len(tableau[2]), lambda n, t=tableau: runge_kutta(t, n, scene)
    classical = tableaus()["classical"]
    yield "Runge-Kutta 4 on the rotation group", 4, lambda n: runge_kutta(classical, n, scene, group=True)
    for mode, name, cost in ((PE, "Adams-Bashforth", 1), (PEC, "Adams PEC", 1), (PECE, "Adams PECE", 2)):
        for order in (2, 3, 4, 5, 6):
            yield f"{name} {order}", cost, lambda n, o=order, m=mode: adams(o, m, n, scene)


def _fewest(points, target) -> str:
    """Fewest evaluations among (error, evaluations) from which on the error stays below `target`."""
    good = None
    for error, count in sorted(points, key=lambda point: -point[1]):
        if not error <= target:
            break
        good = count
    return f"{good:7d}" if good else "      -"


def integrators():
    """Evaluations for an error of the head's position after 10 s of falling, laminar friction, by the method; and the
    orders that are seen."""
    scene = Scene(friction="laminar", **LEAN)
    exact = simulate(falling(), DURATION, scene=scene, accuracy=EXACT, sample_period=0.1, estimate=False)
    yield "method" + " " * 36 + "".join(f"{target:8.0e}" for target in TARGETS), None, ""

    def row(name, points):
        return f"{name:42s}" + "".join(" " + _fewest(points, target) for target in TARGETS), None, ""

    def error_of(position):
        error = np.linalg.norm(position - exact.position[-1]) / exact.path_length
        return error if np.isfinite(error) else np.inf

    for name, cost, swim in _contenders(scene):
        points = []
        for per_second in STEPS:
            if per_second * cost * DURATION <= MOST:
                y, evaluations = swim(per_second)
                points.append((error_of(y[:3]), evaluations))
        yield row(name, points)
    for method, orders in (("adams", (3, 4, 5, 6)), ("dormand_prince", (5,))):
        for order in orders:
            points = []
            for tolerance in np.logspace(-3, -10, 22):
                accuracy = Accuracy(
                    name="study", resolution=RESOLUTION, tolerance=tolerance, method=method, order=order
                )
                run = simulate(
                    falling(), DURATION, scene=scene, accuracy=accuracy, sample_period=DURATION, estimate=False
                )
                points.append((error_of(run.position[-1]), run.evaluations))
            yield row(f"adaptive: {method} {order}", points)
    yield from _orders()


def _orders():
    """Orders that Dormand and Prince's method shows, from 20 to 80 steps a second, by what is not smooth."""
    tableau = tableaus()["Dormand-Prince"]
    for name, friction, resistive, kinks in (
        ("no drag", "laminar", False, "all"),
        ("laminar friction, kinks located", "laminar", True, "all"),
        ("laminar friction, kinks ignored", "laminar", True, "none"),
        ("printed friction, jump located", "printed", True, "all"),
        ("printed friction, jump ignored", "printed", True, "none"),
    ):
        scene = Scene(friction=friction, resistive=resistive, **LEAN)
        exact = runge_kutta(tableau, 640, scene, kinks=kinks)[0][:3]
        found = [np.linalg.norm(runge_kutta(tableau, n, scene, kinks=kinks)[0][:3] - exact) for n in (20, 40, 80)]
        yield (
            f"order seen, {name}",
            float(np.log2(found[0] / found[2]) / 2.0),
            f"errors {found[0]:.1e} to {found[2]:.1e} m",
        )
