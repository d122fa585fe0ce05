# SPDX-License-Identifier: Apache-2.0
"""Arrays of a run's samples: poses, velocities, energies, and profiles along the body at the stations."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

import eel_core


class Observations(NamedTuple):
    """Samples: T instants, M stations. Library axes, SI units. All are views of `whole`."""

    position: np.ndarray  # (T, 3) m, head, world
    orientation: np.ndarray  # (T, 4) x y z w, world from head
    twist: np.ndarray  # (T, 6) rad/s, m/s, head's axes
    head_acceleration: np.ndarray  # (T, 6) rad/s^2, m/s^2, true acceleration of the head, head's axes
    center_of_mass: np.ndarray  # (T, 3) m, world
    energies: np.ndarray  # (T, 3) J, kinetic of body and of water, potential
    powers: np.ndarray  # (T, 4) W, actuators, wake, nose, drag
    closure: np.ndarray  # (T, 2) N m, N: what is left at the nose of the internal wrench
    backbone: np.ndarray  # (T, M, 3) m, world
    section_orientation: np.ndarray  # (T, M, 4) x y z w, world from section
    curvature: np.ndarray  # (T, M, 3) rad/m
    curvature_rate: np.ndarray  # (T, M, 3) rad/m/s
    torque: np.ndarray  # (T, M, 3) N m, section axes
    force: np.ndarray  # (T, M, 3) N, section axes
    fluid_force: np.ndarray  # (T, M, 3) N/m, of the water on the body, section axes
    resistive_force: np.ndarray  # (T, M, 3) N/m, its resistive part
    tail_force: np.ndarray  # (T, 3) N, section axes at the tail
    nose_force: np.ndarray  # (T, 3) N, section axes at the nose
    wake_momentum_rate: np.ndarray  # (T, 3) N, section axes at the tail
    whole: np.ndarray  # (.,) all of these, one behind the other


def empty_observations(
    samples: int, stations: int, wrench: bool = True, load: bool = True, swimmers: tuple[int, ...] = ()
) -> Observations:
    """Space for `samples` instants at `stations` stations.

    The profiles that are not asked for have no instants. swimmers: (B,) adds a first axis for B swimmers.
    """
    places = _places(samples, stations, bool(wrench), bool(load))
    whole = np.zeros((*swimmers, places[-1][1]))
    parts = (whole[..., begin:end].reshape(*swimmers, *shape) for begin, end, shape in places)
    return Observations(*(*parts, whole))


Places = dict[str, tuple[slice, tuple[int, ...] | None]]


@lru_cache(maxsize=64)
def places_of_instant(stations: int, wrench: bool, load: bool) -> tuple[Places, int]:
    """Place and shape of each quantity of one instant, None where it is not asked for; how many numbers they hold."""
    places = _places(1, stations, wrench, load)
    named = zip(Observations._fields[:-1], places, strict=True)
    found = {name: (slice(begin, end), shape[1:] if shape[0] else None) for name, (begin, end, shape) in named}
    return found, places[-1][1]


def size_of(samples: int, stations: int, wrench: bool, load: bool) -> int:
    """How many numbers the profiles of so many samples and stations hold."""
    return _places(samples, stations, bool(wrench), bool(load))[-1][1]


@lru_cache(maxsize=64)
def _places(samples: int, stations: int, wrench: bool, load: bool) -> tuple[tuple[int, int, tuple[int, ...]], ...]:
    """Begin, end and shape of each of the profiles in the whole."""
    layout = eel_core.layout(samples, stations, wrench, load)
    places = []
    for name in Observations._fields[:-1]:
        begin, instants, numbers, along_body = layout[name]
        shape = (instants, stations, numbers) if along_body else (instants, numbers)
        places.append((begin, begin + int(np.prod(shape)), shape))
    return tuple(places)
