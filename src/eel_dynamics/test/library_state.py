# SPDX-License-Identifier: Apache-2.0
"""The public API of eel_dynamics at one prescribed instant, for comparisons: bodies, scenes and snapshots.

What goes in and comes out has the paper's axes, as the reference has them; the library has those of REP-103.
"""

import copy
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from eel_dynamics.model.axes import SIGNS, turn_quaternion, turn_vector, turned
from reference import Reference, rotation
from reference import scene as reference_scene

import eel_dynamics
from eel_dynamics import Accuracy, Body, HydrodynamicWrench, Scene, Simulation, simulate

DENSE = Accuracy(name="dense", resolution=300.0, tolerance=1e-12)  # more nodes than any preset: physics, not presets


def library_body(body):
    """The Body of a namespace of `cases` or `reference`."""
    masses = {"mass_per_length": getattr(body, "mass", None), "centre_of_mass_offset": getattr(body, "offset", 0.0)}
    return Body(
        **masses,
        length=body.kinks[-1],
        half_width=body.half_width,
        half_height=body.half_height,
        kinks=body.kinks[1:-1],
        nose=body.nose,
        density=None if hasattr(body, "mass") else body.density,
    )


def namespace_body(body, kinks=()):
    """The other way round, with more panels where a body of arrays is not smooth."""
    return SimpleNamespace(
        half_width=body.half_width,
        half_height=body.half_height,
        nose=body.nose,
        density=body.density,
        kinks=tuple(sorted({0.0, *body.kinks, *kinks, body.length})),
    )


def snapshot(body, law, time=0.0, twist=(0,) * 6, orientation=(0, 0, 0, 1), settings=None, stations=21, accuracy=DENSE):
    """What the library observes where the law is at `time` and the head has `twist` [rad/s, m/s] (over ground)."""
    simulation = Simulation(
        body=body,
        scene=library_scene(**(settings or {})),
        accuracy=accuracy,
        stations=stations,
        orientation=turn_quaternion(orientation),
        twist=turn_twist(twist),
    )
    simulation.adopt(law, origin=-time)
    return in_paper_axes(simulation.observe(wrench=True, load=True))


def in_paper_axes(snapshot):
    """The snapshot with world and head in the paper's axes."""
    result = copy.copy(snapshot)
    result.whole = snapshot.whole.copy()
    for name, values in turned({name: getattr(snapshot, name) for name in SIGNS}).items():
        result.whole[snapshot.places[name][0]] = values.ravel()
    return result


def library_scene(**settings):
    """The Scene of these settings, whose current has the paper's axes."""
    return turn_scene(Scene(**settings))


def turn_scene(scene):
    """The scene with its current in the other axes."""
    return replace(scene, current=tuple(turn_vector(scene.current)))


def turn_twist(twist):
    """A twist, or a wrench, (6,) in the other axes."""
    return turn_vector(np.reshape(twist, (2, 3))).ravel()


def momentum(body, law, time, twist, settings, accuracy=DENSE):
    """Momentum (6,) of body, water and nose about the head, which the march carries; head's axes are the world's."""
    simulation = Simulation(
        body=body, scene=library_scene(**settings), accuracy=accuracy, stations=2, twist=turn_twist(twist)
    )
    simulation.adopt(law, origin=-time)
    return turn_twist(simulation.state[7:13])


def expected(reference, law, time, twist, orientation=(0, 0, 0, 1)):
    """The same from the reference: shape, twist relative to the water, rate of its components, head acceleration."""
    shape = law.curvature(time, reference.space.x)
    reference.up = rotation(orientation)[2]
    drift = rotation(orientation).T @ np.asarray(reference.scene.current, float)
    relative = np.array(twist, float)
    relative[3:] -= drift
    relative_rate = reference.acceleration(*shape, relative)
    acceleration = relative_rate.copy()  # the true one, the same in the water's frame as over ground
    acceleration[3:] += np.cross(relative[:3], relative[3:])
    return shape, relative, relative_rate, acceleration


def prescribed(body, law, time, twist, twist_rate, settings):
    """Torque and force (6,) of the fluid on the body, about the head, in its axes, for a given motion of the head."""
    return np.asarray(hydrodynamic_wrench(body, law, time, twist, twist_rate, Scene(**settings)))


def hydrodynamic_wrench(body, law, time, twist, twist_rate, scene):
    """That of the library, in the paper's axes."""
    twist, twist_rate = turn_twist(twist), turn_twist(twist_rate)
    got = eel_dynamics.hydrodynamic_wrench(body, law, time, twist, twist_rate, turn_scene(scene))
    return HydrodynamicWrench(*(turn_twist(part) for part in (got.inertia, got.wake, got.resistive, got.nose)))


def simulate_in_paper_axes(
    law, duration, *, scene=None, position=(0, 0, 0), orientation=(0, 0, 0, 1), twist=(0,) * 6, **options
):
    """That of the library, in the paper's axes."""
    start = {"position": turn_vector(position), "orientation": turn_quaternion(orientation), "twist": turn_twist(twist)}
    return simulate(law, duration, scene=turn_scene(scene or Scene()), **start, **options).in_axes("paper")


def random_quaternion(rng):
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)


def distance(got, wanted, scale=None):
    """Greatest difference relative to the greatest wanted value (or to `scale`)."""
    got, wanted = np.asarray(got), np.asarray(wanted)
    return np.max(np.abs(got - wanted)) / (np.max(np.abs(wanted)) if scale is None else scale)


__all__ = [
    "DENSE",
    "Accuracy",
    "Body",
    "Reference",
    "Scene",
    "Simulation",
    "distance",
    "expected",
    "hydrodynamic_wrench",
    "in_paper_axes",
    "library_body",
    "library_scene",
    "momentum",
    "namespace_body",
    "prescribed",
    "random_quaternion",
    "reference_scene",
    "rotation",
    "simulate",
    "simulate_in_paper_axes",
    "snapshot",
    "turn_twist",
]
