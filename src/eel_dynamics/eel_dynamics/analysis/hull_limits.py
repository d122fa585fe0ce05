# SPDX-License-Identifier: Apache-2.0
"""Checks whether a run is within the range of its hull's coefficients, and of a slender tail.

| limit | why | what to do |
|---|---|---|
| round sections, KC > 6, whole added mass | flow across separates: a circle has a fifth | `round_added_mass` 0.2 |
| KC < 5, reduced added mass | the flow across stays attached | `round_added_mass` 1 |
| the tail waves, k a > 0.5 | water flows around its edges: less added mass | `lateral_added_mass` along X |
| the height rises to the tail within twice its half-height | a wing, not a tail | `lateral_added_mass` along X |
| Strouhal number > 1 | separated flow at the tail: no slender theory is right there | take the thrust for too great |

KC = max|V2| T / (2 a) of the sections in the rear half (Keulegan and Carpenter 1958), with the half-height a normal to
their motion. The ratio of added masses of an endless strip of half-height a, waving with the wavenumber k or rigid, is
exact potential flow. k is the change of the phase of V2 over the last quarter of the body, divided by its length.
"""

import numpy as np
from eel_common.attitude import world_from_body

from eel_dynamics.analysis.analysis import Analysis
from eel_dynamics.model.axes import REP103
from eel_dynamics.model.body.hull import roundness_squared

MOST_ATTACHED, LEAST_SEPARATED, ROUND = 5.0, 6.0, 0.7  # KC, KC, roundness s
MOST_WAVY, MOST_STROUHAL = 0.5, 1.0
REAR, LAST = 0.5, 0.75  # of the length
STRIP = np.array([[0.0, 1.0], [0.1, 0.991], [0.2, 0.969], [0.3, 0.941], [0.5, 0.875], [0.7, 0.805], [1.0, 0.708],
                  [1.5, 0.576], [2.0, 0.479], [3.0, 0.353], [5.0, 0.229]])  # fmt: skip
"""k a, and the added mass of an endless strip that waves in this way, relative to that of a rigid one."""
PLACES = 33  # along the body
COINCIDENT = 1e-9  # of the body's length: allowed distance of the last station from the tail
RISEN = 0.02  # a smaller part of the rise of the height does not count


def hull_warnings(run) -> list[str]:
    """Limits of the hull's coefficients and of the slender tail that a `Run` exceeded, one line each.

    Limits of a motion need a gait with a period, a station at the tail, and water at rest or with a uniform current.
    """
    found = [_of_rise(run)] if run.scene.reactive else []
    if abs(run.x[-1] - run.body.length) > COINCIDENT * run.body.length:
        return [text for text in found if text]
    try:
        analysis = Analysis(run)
    except ValueError:  # no period, or too few samples
        return [text for text in found if text]
    if run.flow is None and run.scene.reactive and len(run.x) > 1:
        time, lateral = _lateral_speed(run, analysis)
        found += [_of_separation(run, time, lateral, analysis), _of_wave(run, time, lateral, analysis)]
    if (strouhal := analysis.strouhal) is not None and strouhal > MOST_STROUHAL:
        found.append(
            f"Strouhal number {strouhal:.3g} is above {MOST_STROUHAL:g}: flow at the tail separates, and no slender "
            "theory has its thrust; take the speed for too great"
        )
    return [text for text in found if text]


def _of_rise(run) -> str:
    """A warning if the body's height rises to the tail over a short length."""
    x = np.linspace(REAR * run.body.length, run.body.length, 513)
    a = run.body.half_height(x)
    high = len(a) - 1 - int(np.argmax(a[::-1]))
    least, height = float(np.min(a[: high + 1])), float(a[high])
    begin = int(np.flatnonzero(a[: high + 1] <= least + RISEN * (height - least))[-1])
    length = float(x[high] - x[begin])
    if height <= 1.01 * least or height <= 0.5 * length or _corrected(run.body):
        return ""
    return (
        f"the half-height rises to {height:.3g} m at X = {x[high]:.3g} m within {length:.3g} m: such a tail is a wing, "
        "and a slender one has too much thrust; give lateral_added_mass along X"
    )


def _of_separation(run, time: np.ndarray, lateral: np.ndarray, analysis: Analysis) -> str:
    x = run.x
    rear = x >= REAR * run.body.length
    a, b = run.body.half_height(x), run.body.half_width(x)
    rear &= a > 0.0
    if not rear.any():
        return ""
    number = np.max(np.abs(lateral), axis=0)[rear] * analysis.window.period / (2.0 * a[rear])
    roundness = np.sqrt(roundness_squared(a[rear] ** 2, b[rear] ** 2))
    place = int(np.argmax(number))
    kc, factor = float(number[place]), run.body.round_added_mass
    if roundness[place] > ROUND and kc > LEAST_SEPARATED and factor == 1.0:
        return (
            f"KC = max|V2| T/(2a) is {kc:.3g} at X = {x[rear][place]:.3g} m, above {LEAST_SEPARATED:g}, where sections "
            "are round: flow across separates, and the whole added mass is too much; try round_added_mass=0.2"
        )
    if roundness[place] > ROUND and kc < MOST_ATTACHED and factor < 1.0:
        return (
            f"KC = max|V2| T/(2a) is at most {kc:.3g}, below {MOST_ATTACHED:g}, with round_added_mass {factor:g}: flow "
            "across stays attached there; try round_added_mass=1"
        )
    return ""


def _of_wave(run, time: np.ndarray, lateral: np.ndarray, analysis: Analysis) -> str:
    if _corrected(run.body):
        return ""
    phase = np.exp(2j * np.pi * time / analysis.window.wave.period)
    ends = [int(np.argmin(np.abs(run.x - part * run.body.length))) for part in (LAST, 1.0)]
    first, last = (np.mean(lateral[:, end] * phase) for end in ends)
    way = float(run.x[ends[1]] - run.x[ends[0]])
    height = float(np.max(run.body.half_height(np.linspace(LAST * run.body.length, run.body.length, PLACES))))
    if not way > 0.0 or abs(first) < 1e-3 * abs(last):
        return ""
    wavy = abs(float(np.angle(last / first))) / way * height if first != 0.0 else 0.0
    if wavy <= MOST_WAVY:
        return ""
    factor = float(np.interp(wavy, *STRIP.T))
    return (
        f"the last quarter waves with k a = {wavy:.3g}, above {MOST_WAVY:g}: an endless strip has {factor:.2g} of the "
        f"added mass; give lateral_added_mass along X, {factor:.2g} there"
    )


def _corrected(body) -> bool:
    """Whether the added mass of the tail is given along the body."""
    return np.ndim(body.lateral_added_mass) > 0 or callable(body.lateral_added_mass)


def _lateral_speed(run, analysis: Analysis) -> tuple[np.ndarray, np.ndarray]:
    """Instants (K,) [s] of the window, and V2 (K, M) [m/s] of the stations through the water there."""
    from scipy.interpolate import CubicSpline

    run = run.in_axes(REP103)
    window = (run.time >= analysis.window.start - 1e-9) & (run.time <= analysis.window.end + 1e-9)
    velocity = CubicSpline(run.time, run.backbone)(run.time[window], 1) - np.asarray(run.scene.current)
    side = world_from_body(run.section_orientation[window])[..., 1]
    return run.time[window], np.sum(velocity * side, axis=2)
