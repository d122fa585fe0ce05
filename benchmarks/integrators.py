"""Methods of integration, measured: evaluations of the head's dynamics for an error of its position.

10 s of the falling gait with laminar friction, fixed steps that end on the kinks of the ramps: Runge-Kutta of orders 2
to 8, the classical method on the rotation group (Munthe-Kaas: steps by the exponential of the turning vector), Adams
and Bashforth (one evaluation a step), with a corrector (PEC one, PECE two); and the library's own, with adaptive steps.
"""

import numpy as np
from eel_dynamics.fields import Kinks
from eel_dynamics.rates import rate_of_state
from numba import njit
from tableaus import adams_weights, tableaus

from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling

DURATION, RESOLUTION = 10.0, 30.0
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
STEPS = (3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 32, 40, 50, 64, 80, 100, 130, 160, 220, 320)  # per second
MOST = 20_000  # evaluations of a run of the study
LEAN = {"ledger": False, "internal_wrench": False}
EXACT = Accuracy(name="exact", resolution=60.0, tolerance=1e-13)
PE, PECE, PEC = 0, 1, 2
_COMPILE = {"error_model": "numpy", "cache": True}


@njit(**_COMPILE)
def _unit(y):
    size = np.sqrt(y[3] ** 2 + y[4] ** 2 + y[5] ** 2 + y[6] ** 2)
    for k in range(3, 7):
        y[k] /= size


@njit(**_COMPILE)
def _turned(y, u, result):
    """Orientation of `y` turned by the vector `u` [rad] in its own axes, into `result`."""
    angle = np.sqrt(u[0] ** 2 + u[1] ** 2 + u[2] ** 2)
    s, w = (0.5 * np.sinc(0.5 * angle / np.pi)), np.cos(0.5 * angle)
    a, b, c = s * u[0], s * u[1], s * u[2]
    x, v, z, q = y[3], y[4], y[5], y[6]
    result[3] = q * a + x * w + v * c - z * b
    result[4] = q * b - x * c + v * w + z * a
    result[5] = q * c + x * b - v * a + z * w
    result[6] = q * w - x * a - v * b - z * c


@njit(**_COMPILE)
def _runge_kutta(swimmer, drive, fields, step, y, start, h, count, a, b, c, group):
    stages, none = len(b), np.zeros(3)
    k, trial, turn, w = np.zeros((stages, 13)), np.zeros(13), np.zeros((stages, 3)), np.zeros(3)
    for m in range(count):
        for i in range(stages + 1):
            weights = a[i] if i < stages else b
            for q in range(13):
                total = 0.0
                for j in range(min(i, stages)):
                    total += weights[j] * k[j, q]
                trial[q] = y[q] + h * total
            if group:
                for q in range(3):
                    w[q] = 0.0
                    for j in range(min(i, stages)):
                        w[q] += h * weights[j] * turn[j, q]
                _turned(y, w, trial)
            if i == stages:
                break
            rate_of_state(swimmer, drive, fields, none, start + (m + c[i]) * h, trial, step, k[i])
            if group:  # inverse of the exponential's derivative: 1 + ad/2 + ad^2/12, rates in the body's axes
                omega = step.twist[:3]
                first = np.cross(w, omega)
                turn[i] = omega + 0.5 * first + np.cross(w, first) / 12.0
        y[:] = trial
        _unit(y)


@njit(**_COMPILE)
def _rate(swimmer, drive, fields, step, y, time, rate):
    rate_of_state(swimmer, drive, fields, np.zeros(3), time, y, step, rate)


@njit(**_COMPILE)
def _adams(swimmer, drive, fields, step, y, start, h, count, predictor, corrector, mode, rates):
    order, none, trial, new = len(predictor), np.zeros(3), np.zeros(13), np.zeros(13)
    head = order - 1
    for m in range(count):
        time, following = start + (m + 1) * h, (head + 1) % order
        for q in range(13):
            total = 0.0
            for j in range(order):
                total += predictor[j] * rates[(head - j) % order, q]
            trial[q] = y[q] + h * total
        _unit(trial)
        rate_of_state(swimmer, drive, fields, none, time, trial, step, new)
        if mode == PE:
            y[:] = trial
        else:
            for q in range(13):
                total = corrector[0] * new[q]
                for j in range(order - 1):
                    total += corrector[j + 1] * rates[(head - j) % order, q]
                y[q] += h * total
            _unit(y)
            if mode == PECE:
                rate_of_state(swimmer, drive, fields, none, time, y, step, new)
        rates[following] = new
        head = following


def _begin(scene, located=True):
    simulation = Simulation(accuracy=Accuracy(name="study", resolution=RESOLUTION), scene=scene, law=falling())
    fields = simulation.fields
    if not located:  # no room to note kinks: the drag is summed over the nodes as it is
        fields = fields._replace(kinks=Kinks(*(array[:0] if name != "number" else array for name, array in
                                               zip(Kinks._fields, fields.kinks, strict=True))))  # fmt: skip
    return (simulation.swimmer, simulation.drive, fields, simulation.step), simulation.state.copy()


def runge_kutta(tableau, per_second, scene, group=False, located=True) -> tuple[np.ndarray, int]:
    """The state (13,) after the run, and its evaluations."""
    _, a, b, c = tableau
    parts, y = _begin(scene, located)
    count = round(DURATION * per_second)
    _runge_kutta(*parts, y, 0.0, 1.0 / per_second, count, a, b, c, group)
    return y, count * len(b)


def adams(order, mode, per_second, scene) -> tuple[np.ndarray, int]:
    """As `runge_kutta`; begun by the classical method with half the step."""
    parts, y = _begin(scene)
    h, count = 1.0 / per_second, round(DURATION * per_second)
    _, a, b, c = tableaus()["classical"]
    rates = np.zeros((order, 13))
    _rate(*parts, y, 0.0, rates[0])
    for m in range(1, order):
        _runge_kutta(*parts, y, (m - 1) * h, 0.5 * h, 2, a, b, c, False)
        _rate(*parts, y, m * h, rates[m])
    predictor, corrector = adams_weights(-np.arange(order)), adams_weights(1.0 - np.arange(order))
    _adams(*parts, y, (order - 1) * h, h, count - order + 1, predictor, corrector, mode, rates)
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
    exact = simulate(falling(), DURATION, scene=scene, accuracy=EXACT, sample_period=0.1)
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
                run = simulate(falling(), DURATION, scene=scene, accuracy=accuracy, sample_period=DURATION)
                points.append((error_of(run.position[-1]), run.evaluations))
            yield row(f"adaptive: {method} {order}", points)
    yield from _orders()


def _orders():
    """Orders that Dormand and Prince's method shows, from 20 to 80 steps a second, by what is not smooth."""
    tableau = tableaus()["Dormand-Prince"]
    for name, friction, resistive, located in (
        ("no drag", "laminar", False, True),
        ("laminar friction, kinks located", "laminar", True, True),
        ("laminar friction, kinks ignored", "laminar", True, False),
        ("printed friction, jump located", "printed", True, True),
        ("printed friction, jump ignored", "printed", True, False),
    ):
        scene = Scene(friction=friction, resistive=resistive, **LEAN)
        exact = runge_kutta(tableau, 640, scene, located=located)[0][:3]
        found = [np.linalg.norm(runge_kutta(tableau, n, scene, located=located)[0][:3] - exact) for n in (20, 40, 80)]
        yield (
            f"order seen, {name}",
            float(np.log2(found[0] / found[2]) / 2.0),
            f"errors {found[0]:.1e} to {found[2]:.1e} m",
        )
