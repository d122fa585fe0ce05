# SPDX-License-Identifier: Apache-2.0
"""Other people's simulators, each in an environment of its own with pinned versions: `python benchmarks/run.py peers`.

MuJoCo (a chain of ellipsoids with its fluid model, held by servos, or with the joints prescribed and the head's six
equations solved outside: its best) and PyElastica (a Cosserat rod with its slender-body drag) swim the
falling gait. Their physics is another, so each is held against its own converged answer, and costs are compared where
the library has no greater error against its own. A peer that cannot be installed is skipped.
"""

from pathlib import Path
from statistics import median

import numpy as np
from measuring import times_in_turn
from peer_processes import environment, measured

from eel_dynamics import Body, Scene, Simulation, simulate
from eel_gaits import falling

REPEATS = 3
BATCH = 8  # swimmers side by side
LINKS = {10: 2.5e-4, 20: 2.5e-4}  # MuJoCo: links, s of the finest step
LINK_STEPS = (0.01, 0.005, 0.002)  # s
LAG = 0.02  # s, of the servos (mujoco_chain.py)
PRESCRIBED_STEPS = (0.05, 0.02, 0.01)  # s, where the joints are prescribed (mujoco_prescribed.py)
PRESCRIBED_FINEST = 0.0025  # s
ELEMENTS = {25: 2.5e-5, 50: 2.5e-5}  # PyElastica: elements, s of the finest step
ELEMENT_STEPS = (1e-4, 5e-5)  # s; half as much again is unstable
STIFFNESS = 1e7  # Pa, Young's modulus: soft enough for these steps, stiff enough to follow the law
VISCOSITY = 1e-3  # Pa s, of water
TARGETS = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)


def peers():
    """The falling gait in other simulators, motion alone, one thread, CPU seconds without set-up. Error: of the head's
    position at the end by max(its path, body length), of theirs against their own finest step (time alone), of ours
    against our finest run (space and time)."""
    ours = Ours()
    for name, measure in (("mujoco", _mujoco), ("pyelastica", _elastica)):
        python = environment(name)
        if python is None:
            yield f"{name}: skipped, it could not be installed", None, ""
        else:
            yield from measure(python, ours)


class Ours:
    """The library on the same gait: errors and costs at each target, by duration."""

    def __init__(self):
        self.law, self.body, self.scene = falling(), Body.boyer2010(), Scene(ledger=False, internal_wrench=False)
        self._known = {}

    def run(self, duration: float):
        """The finest run."""
        return simulate(
            self.law, duration, body=self.body, scene=self.scene, accuracy=1e-6, sample_period=0.01, estimate=False
        )

    def cheapest(self, error: float, duration: float) -> tuple[float, float]:
        """CPU seconds per simulated second of the cheapest target with no greater error; that error."""
        if duration not in self._known:
            finest = self.run(duration)
            scale = max(finest.path_length, self.body.length)
            self._known[duration] = finest.position[-1], scale
        end, scale = self._known[duration]
        for target in TARGETS:
            swimmer = Simulation(body=self.body, scene=self.scene, accuracy=target)
            swimmer.adopt(self.law)
            instants = np.array([0.0, duration])
            out, *_ = swimmer.record(instants, False, False)
            own = float(np.linalg.norm(out.position[-1] - end)) / scale
            if own <= error:
                march = (swimmer.reset, lambda s=swimmer, i=instants: s.record(i, False, False))
                return median(times_in_turn({"ours": march})["ours"]) / duration, own
        raise ValueError(f"no target reaches an error of {error:.1e}")


def _lines(name, results: dict, ours: Ours, duration: float):
    """Lines of one model: `results` by step, the finest last."""
    *coarser, finest = results
    end, scale = np.array(results[finest]["head"]), max(results[finest]["path"], ours.body.length)
    for step in coarser:
        result = results[step]
        error = float(np.linalg.norm(np.array(result["head"]) - end)) / scale
        seconds = result["seconds"] / duration
        yield f"  {name}, step {step:g} s", seconds, f"CPU s per s, error {error:.1e} (finest step {finest:g} s)"
        cost, own = ours.cheapest(error, duration)
        yield "    ours is cheaper", seconds / cost, f"times ({1.0 / cost:.0f} s per CPU second, error {own:.1e})"


def _mujoco(python: Path, ours: Ours, duration: float = 10.0):
    ends = {}
    for links, finest in LINKS.items():
        results = {}
        for step in (*LINK_STEPS, finest):
            angles = _joint_angles(ours, links, step, duration)
            results[step] = measured(
                python,
                "mujoco_chain.py",
                **_chain(ours, links),
                step=step,
                integrator="implicitfast",  # Euler and Runge-Kutta 4 are unstable with servos this stiff
                targets=angles[:-1] + LAG * (angles[1:] - angles[:-1]) / step,
                angles=angles[1:],
                repeats=REPEATS if step > finest else 1,
                batch=BATCH if step > finest else 1,
            )
        result = results[LINK_STEPS[0]]
        if not ends:
            yield f"MuJoCo {result['version']}, implicitfast, chain of ellipsoids", None, ""
        yield from _lines(f"{links} links", results, ours, duration)
        yield (
            f"    {BATCH} in one call",
            result["batch_seconds"] / duration,
            f"CPU s per s each, step {LINK_STEPS[0]:g}",
        )
        yield "    joint angles off by", max(r["shape_error"] for r in results.values()), "rad at most"
        ends[links] = np.array(results[finest]["head"])
    yield from _prescribed(python, ours, ends, duration)
    few, many = ends.values()
    yield "  10 and 20 links apart", float(np.linalg.norm(few - many)), "m at the end"
    yield "  the head is then from its start", float(np.linalg.norm(many)), f"m; ours {_way(ours, duration):.3g} m"
    yield "  a link pushed from rest weighs", result["added_mass_share"], "times its mass: 1 is without added mass"


def _prescribed(python: Path, ours: Ours, ends: dict, duration: float):
    """Lines of MuJoCo's chain with prescribed joints; ends: where the chain with servos comes to, by links."""
    for links in LINKS:
        results = {}
        for step in (*PRESCRIBED_STEPS, PRESCRIBED_FINEST):
            results[step] = measured(
                python,
                "mujoco_prescribed.py",
                **_chain(ours, links),
                step=step,
                joints=np.stack([_joint_angles(ours, links, 0.5 * step, duration, rate) for rate in range(3)], axis=1),
                repeats=REPEATS if step > PRESCRIBED_FINEST else 1,
            )
        yield from _lines(f"{links} links, joints prescribed", results, ours, duration)
        apart = np.linalg.norm(np.array(results[PRESCRIBED_FINEST]["head"]) - ends[links])
        yield "    from the end with servos", float(apart), "m"


def _chain(ours: Ours, links: int) -> dict:
    """What MuJoCo's chain is in either way of driving it: half-axes (links,) [m] in the middle of each link, water."""
    middle = (np.arange(links) + 0.5) * ours.body.length / links
    return {
        "length": ours.body.length,
        "half_width": ours.body.half_width(middle),
        "half_height": ours.body.half_height(middle),
        "density": ours.body.density,
        "water": 1000.0,
        "viscosity": VISCOSITY,
    }


def _joint_angles(ours: Ours, links: int, step: float, duration: float, rate: int = 0):
    """Angles (steps + 1, 2 (links - 1)) [rad], pitch and yaw, at the joints: integrals of K over a link about each.

    rate: 1, 2 for their first and second time derivatives."""
    link = ours.body.length / links
    points, weights = np.polynomial.legendre.leggauss(6)
    x = (np.arange(1, links)[:, None] * link + 0.5 * link * points).ravel()
    times = np.arange(round(duration / step) + 1) * step
    curvature = np.array([ours.law.curvature(time, x)[rate][:, 1:] for time in times])
    shaped = curvature.reshape(len(times), links - 1, len(points), 2)
    angles = 0.5 * link * np.einsum("p,tjpk->tjk", weights, shaped)
    return angles.reshape(len(times), -1)


def _elastica(python: Path, ours: Ours, duration: float = 5.0):
    ends = {}
    for elements, finest in ELEMENTS.items():
        x, middle = np.arange(1, elements) / elements, (np.arange(elements) + 0.5) / elements
        area = ours.body.half_width(middle * ours.body.length) * ours.body.half_height(middle * ours.body.length)
        results = {}
        for step in (*ELEMENT_STEPS, finest):
            steps = round(duration / step)
            shapes, weights = _separated(ours.law, x * ours.body.length, np.arange(2 * steps + 2) * 0.5 * step)
            results[step] = measured(
                python,
                "elastica_rod.py",
                length=ours.body.length,
                radius=np.sqrt(area),
                density=ours.body.density,
                viscosity=VISCOSITY,
                youngs_modulus=STIFFNESS,
                step=step,
                steps=steps,
                elements=elements,
                shapes=shapes,
                weights=weights,
                repeats=REPEATS if step > finest else 1,
                batch=BATCH if step > finest else 1,
            )
        if not ends:
            version = results[finest]["version"]
            yield f"PyElastica {version}, Verlet, Young's modulus {STIFFNESS:g} Pa, {duration:g} s", None, ""
        yield from _lines(f"{elements} elements", results, ours, duration)
        batch = results[ELEMENT_STEPS[0]]["batch_seconds"] / duration
        yield f"    {BATCH} in one system", batch, f"CPU s per s each, step {ELEMENT_STEPS[0]:g} s"
        yield "    curvature off by", results[finest]["shape_error"], "rad/m at most, for the rod is elastic"
        ends[elements] = np.array(results[finest]["head"])
    few, many = ends.values()
    yield "  25 and 50 elements apart", float(np.linalg.norm(few - many)), "m at the end"
    yield "  the head is then from its start", float(np.linalg.norm(many)), f"m; ours {_way(ours, duration):.3g} m"


def _separated(law, x, times):
    """The law as a sum of shapes (m, 2, len(x)) [rad/m] times weights (len(times), m)."""
    shapes, weights = [], []
    for term in law.terms:
        amplitude, envelope = term.amplitude_at(x), term.envelope_at(times)[0]
        phase, turn = term.wave_number * x + term.phase, term.angular_frequency * times
        for shape, weight in ((np.sin(phase), np.cos(turn)), (np.cos(phase), -np.sin(turn))):
            row = np.zeros((2, len(x)))
            row[0 if term.axis == "pitch" else 1] = amplitude * shape
            shapes.append(row)
            weights.append(envelope * weight)
    return np.array(shapes), np.array(weights).T.copy()


def _way(ours: Ours, duration: float) -> float:
    return float(np.linalg.norm(ours.run(duration).position[-1]))
