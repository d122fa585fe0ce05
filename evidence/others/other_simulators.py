# SPDX-License-Identifier: Apache-2.0
"""Other people's simulators at the falling gait.

The physics of MuJoCo (a chain of ellipsoids with its fluid model, held by servos, or with the joints prescribed and the
head's six equations solved outside: its best) and of PyElastica (a Cosserat rod with its slender-body drag) is another,
so each is held against its own converged answer. Costs are compared where the library has no greater error against its
own. One that cannot be installed is skipped.
"""

from collections.abc import Callable, Iterable
from functools import cache, partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from measuring import MOTION, Lines, times_in_turn

from eel_dynamics import Body, Run, Scene, Simulation, simulate
from eel_gaits import falling
from others.environments import environment, measured

BODY, LAW, DURATION = Body.boyer2010(), falling(), 10.0  # s
TARGETS = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)
BATCH = 8  # swimmers side by side
LINKS = (10, 20)  # MuJoCo
LINK_STEPS = (0.01, 0.005, 0.002, 2.5e-4)  # s, the last for its converged answer
LAG = 0.02  # s, of the servos (mujoco_chain.py)
PRESCRIBED_STEPS = (0.05, 0.02, 0.01, 0.0025)  # s, where the joints are prescribed
ELEMENTS = (25, 50)  # PyElastica
ELEMENT_STEPS = (1e-4, 5e-5, 2.5e-5)  # s; half as much again as the first is unstable
ROD_DURATION = 5.0  # s, PyElastica's
STIFFNESS = 1e7  # Pa, Young's modulus: soft enough for these steps, stiff enough to follow the law
VISCOSITY = 1e-3  # Pa s, of water
Results = dict[float, dict[str, Any]]  # by step [s], the finest last


def peers() -> Lines:
    """The falling gait in other simulators, motion alone, one thread, CPU seconds without set-up. Error: of the head's
    position at the end by max(its path, body length), of theirs against their own finest step (time alone), of ours
    against our finest run (space and time)."""
    for name, measure in (("mujoco", _mujoco), ("pyelastica", _elastica)):
        python = environment(name)
        if python is None:
            yield f"{name}: skipped, it could not be installed", None, ""
        else:
            yield from measure(python)


@cache
def _finest(duration: float) -> Run:
    scene = Scene(**MOTION)
    return simulate(LAW, duration, body=BODY, scene=scene, accuracy=1e-6, sample_period=0.01, estimate=False)


def _cheapest(error: float, duration: float) -> tuple[float, float]:
    """CPU seconds per simulated second of our cheapest target with no greater error; that error."""
    finest = _finest(duration)
    for target in TARGETS:
        swimmer = Simulation(body=BODY, scene=Scene(**MOTION), accuracy=target)
        swimmer.adopt(LAW)
        march = partial(swimmer.record, np.array([0.0, duration]), False, False)
        end = march()[0].position[-1]
        own = float(np.linalg.norm(end - finest.position[-1])) / max(finest.path_length, BODY.length)
        if own <= error:
            return median(times_in_turn({"ours": (swimmer.reset, march)}, 3)["ours"]) / duration, own
    raise ValueError(f"no target reaches an error of {error:.1e}")


def _swims(python: Path, script: str, steps: tuple[float, ...], task: Callable[[float], dict]) -> Results:
    """What `script` says about the `task` of each step [s]; the finest is not timed."""
    timed, still = {"repeats": 3, "batch": BATCH}, {"repeats": 1, "batch": 1}
    return {s: measured(python, script, step=s, **task(s), **(still if s == steps[-1] else timed)) for s in steps}


def _compared(name: str, results: Results, duration: float) -> Lines:
    """Lines of one model."""
    *coarser, finest = results
    end, scale = np.array(results[finest]["head"]), max(results[finest]["path"], BODY.length)
    for step in coarser:
        error = float(np.linalg.norm(np.array(results[step]["head"]) - end)) / scale
        seconds = results[step]["seconds"] / duration
        yield f"  {name}, step {step:g} s", seconds, f"CPU s per s, error {error:.1e} (finest step {finest:g} s)"
        cost, own = _cheapest(error, duration)
        yield "    ours is cheaper", seconds / cost, f"times ({1.0 / cost:.0f} s per CPU second, error {own:.1e})"


def _apart(what: str, ends: Iterable[np.ndarray], duration: float) -> Lines:
    """Where the coarser and the finer model of another code come to."""
    few, many = ends
    yield f"  {what} apart", float(np.linalg.norm(few - many)), "m at the end"
    way = float(np.linalg.norm(_finest(duration).position[-1]))
    yield "  the head is then from its start", float(np.linalg.norm(many)), f"m; ours {way:.3g} m"


def _mujoco(python: Path) -> Lines:
    ends: dict[int, np.ndarray] = {}
    for links in LINKS:

        def task(step: float, links: int = links) -> dict[str, Any]:
            angles = _joint_angles(links, step)
            targets = angles[:-1] + LAG * (angles[1:] - angles[:-1]) / step
            # Euler and Runge-Kutta 4 are unstable with servos this stiff
            return _chain(links) | {"integrator": "implicitfast", "targets": targets, "angles": angles[1:]}

        results = _swims(python, "mujoco_chain.py", LINK_STEPS, task)
        first, *_, last = results.values()
        if not ends:
            yield f"MuJoCo {first['version']}, implicitfast, chain of ellipsoids", None, ""
        yield from _compared(f"{links} links", results, DURATION)
        yield f"    {BATCH} in one call", first["batch_seconds"] / DURATION, f"CPU s per s each, step {LINK_STEPS[0]:g}"
        yield "    joint angles off by", max(each["shape_error"] for each in results.values()), "rad at most"
        ends[links] = np.array(last["head"])
    for links in LINKS:

        def prescribed(step: float, links: int = links) -> dict[str, Any]:
            rates = [_joint_angles(links, 0.5 * step, rate) for rate in range(3)]
            return _chain(links) | {"integrator": "Euler", "joints": np.stack(rates, axis=1)}

        results = _swims(python, "mujoco_chain.py", PRESCRIBED_STEPS, prescribed)
        yield from _compared(f"{links} links, joints prescribed", results, DURATION)
        apart = np.linalg.norm(np.array(results[PRESCRIBED_STEPS[-1]]["head"]) - ends[links])
        yield "    from the end with servos", float(apart), "m"
    yield from _apart("10 and 20 links", ends.values(), DURATION)
    yield "  a link pushed from rest weighs", last["added_mass_share"], "times its mass: 1 is without added mass"


def _chain(links: int) -> dict[str, Any]:
    """What MuJoCo's chain is in either way of driving it: half-axes (links,) [m] in the middle of each link, water."""
    middle = (np.arange(links) + 0.5) * BODY.length / links
    return {
        "length": BODY.length,
        "half_width": BODY.half_width(middle),
        "half_height": BODY.half_height(middle),
        "density": BODY.density,
        "water": 1000.0,
        "viscosity": VISCOSITY,
    }


def _joint_angles(links: int, step: float, rate: int = 0) -> np.ndarray:
    """Angles (steps + 1, 2 (links - 1)) [rad], pitch and yaw, at the joints: integrals of K over a link about each.

    rate: 1, 2 for their first and second time derivatives."""
    link = BODY.length / links
    points, weights = np.polynomial.legendre.leggauss(6)
    x = (np.arange(1, links)[:, None] * link + 0.5 * link * points).ravel()
    times = np.arange(round(DURATION / step) + 1) * step
    curvature = np.array([LAW.curvature(time, x)[rate][:, 1:] for time in times])
    shaped = curvature.reshape(len(times), links - 1, len(points), 2)
    angles: np.ndarray = 0.5 * link * np.einsum("p,tjpk->tjk", weights, shaped)
    return angles.reshape(len(times), -1)


def _elastica(python: Path) -> Lines:
    ends: list[np.ndarray] = []
    for elements in ELEMENTS:
        x, middle = (BODY.length * (np.arange(elements) + part) / elements for part in (0.0, 0.5))
        rod = {
            "length": BODY.length,
            "radius": np.sqrt(BODY.half_width(middle) * BODY.half_height(middle)),
            "density": BODY.density,
            "viscosity": VISCOSITY,
            "youngs_modulus": STIFFNESS,
            "elements": elements,
        }

        def task(step: float, x: np.ndarray = x, rod: dict = rod) -> dict[str, Any]:
            steps = round(ROD_DURATION / step)
            shapes, weights = _separated(x[1:], np.arange(2 * steps + 2) * 0.5 * step)
            return rod | {"steps": steps, "shapes": shapes, "weights": weights}

        results = _swims(python, "elastica_rod.py", ELEMENT_STEPS, task)
        first, *_, last = results.values()
        if not ends:
            said = f"Verlet, Young's modulus {STIFFNESS:g} Pa, {ROD_DURATION:g} s"
            yield f"PyElastica {first['version']}, {said}", None, ""
        yield from _compared(f"{elements} elements", results, ROD_DURATION)
        batch = first["batch_seconds"] / ROD_DURATION
        yield f"    {BATCH} in one system", batch, f"CPU s per s each, step {ELEMENT_STEPS[0]:g} s"
        yield "    curvature off by", last["shape_error"], "rad/m at most, for the rod is elastic"
        ends.append(np.array(last["head"]))
    yield from _apart("25 and 50 elements", ends, ROD_DURATION)


def _separated(x: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The law as a sum of shapes (m, 2, len(x)) [rad/m] times weights (len(times), m)."""
    shapes, weights = [], []
    for term in LAW.terms:
        amplitude, envelope = term.amplitude_at(x), term.envelope_at(times)[0]
        phase, turn = term.wave_number * x + term.phase, term.angular_frequency * times
        for shape, weight in ((np.sin(phase), np.cos(turn)), (np.cos(phase), -np.sin(turn))):
            row = np.zeros((2, len(x)))
            row[0 if term.axis == "pitch" else 1] = amplitude * shape
            shapes.append(row)
            weights.append(envelope * weight)
    return np.array(shapes), np.array(weights).T.copy()
