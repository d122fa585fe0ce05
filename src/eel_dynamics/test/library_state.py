# SPDX-License-Identifier: Apache-2.0
"""The public API of eel_dynamics at one prescribed instant, for comparisons: bodies, scenes and snapshots."""

from types import SimpleNamespace

import numpy as np
from reference import Reference, rotation
from reference import scene as reference_scene

from eel_dynamics import Accuracy, Body, Scene, Simulation, hydrodynamic_wrench, simulate

DENSE = Accuracy(name="dense", resolution=300.0, tolerance=1e-12)  # more nodes than any preset: physics, not presets


def library_body(body):
    """The Body of a namespace of `cases` or `reference`."""
    return Body(
        length=body.kinks[-1],
        half_width=body.half_width,
        half_height=body.half_height,
        kinks=body.kinks[1:-1],
        nose=body.nose,
        density=body.density,
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
        scene=Scene(**(settings or {})),
        accuracy=accuracy,
        stations=stations,
        orientation=orientation,
        twist=twist,
    )
    simulation.adopt(law, origin=-time)
    return simulation.observe(wrench=True, load=True)


def momentum(body, law, time, twist, settings, accuracy=DENSE):
    """Momentum (6,) of body, water and nose about the head, which the march carries; head's axes are the world's."""
    simulation = Simulation(body=body, scene=Scene(**settings), accuracy=accuracy, stations=2, twist=twist)
    simulation.adopt(law, origin=-time)
    return simulation.state[7:13].copy()


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
    wrench = hydrodynamic_wrench(
        body, law, time, np.asarray(twist, float), np.asarray(twist_rate, float), Scene(**settings)
    )
    return np.concatenate([wrench.torque, wrench.force]) if hasattr(wrench, "torque") else np.asarray(wrench)


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
    "library_body",
    "momentum",
    "namespace_body",
    "prescribed",
    "random_quaternion",
    "reference_scene",
    "rotation",
    "simulate",
    "snapshot",
]
