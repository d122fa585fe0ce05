# SPDX-License-Identifier: Apache-2.0
"""One evaluation of the head's dynamics, and what a scene adds to it or is spared. CPU times, one thread."""

import statistics
import time
from functools import partial

import numpy as np
from measuring import MOTION, Action, Lines, median_ratio, swimming, times_in_turn

import eel_core
from eel_dynamics import (
    Accuracy,
    Flow,
    GriddedFlow,
    Scene,
    Shear,
    Simulation,
    VortexStreet,
    Wave,
    simulate,
    simulate_batch,
)
from eel_gaits import falling, straight

COUNT = 2000  # evaluations that are timed together
RESOLUTIONS = (8.0, 13.0, 36.0, 80.0, 180.0)  # points per body length
DURATIONS = (10.0, 30.0, 100.0, 300.0)  # s


def evaluations(simulation: Simulation, flow: Flow | None = None) -> Action:
    """Evaluates the head's dynamics COUNT times in the simulation's present state, and in its scene's dimensions.

    flow: of the water; None: still.
    """
    kind = eel_core.PlanarInstant if simulation.scene.planar else eel_core.Instant
    water = None if flow is None else eel_core.Flow(flow.sources(False))
    instant = kind(simulation.discretisation.swimmer)
    return partial(instant.repeat_rate, simulation.law_on_grid, simulation.time, simulation.state, COUNT, water)


def _microseconds(times: list[float]) -> float:
    return statistics.median(times) / COUNT * 1e6


def evaluation() -> Lines:
    """One evaluation of the head's dynamics (momentum form, three dimensions, all loads), against the number of
    nodes."""
    swimmers = {r: swimming(falling(), Scene(), resolution=r) for r in RESOLUTIONS}
    times = times_in_turn({len(each.grid.x): evaluations(each) for each in swimmers.values()})
    spent = {nodes: _microseconds(values) for nodes, values in times.items()}
    for nodes, microseconds in spent.items():
        yield f"{nodes:4d} nodes", microseconds, "us per evaluation (CPU)"
    yield "exponent of growth", _exponent(spent), "(1: linear)"


def flows() -> Lines:
    """Water that moves: one evaluation of the head's dynamics on the nodes of the preset standard by one in still
    water; and a batch of 32 swims of 5 s in such flows on two threads by one, wall time (which only an idle machine
    tells) and CPU time."""
    street = VortexStreet(circulation=0.1, core=0.3, spacing=1.5, width=0.42, start=(-13.0, 0.0, 0.0))
    axis = np.linspace(-6.0, 6.0, 25)
    rows = np.random.default_rng(1).normal(size=(3, 25, 25, 25, 3)) * 0.1
    water: dict[str, Flow] = {
        "a shear": Shear(),
        "a wave": Wave(surface=3.0),
        "a street of 34 vortices": street,
        "a grid in space": GriddedFlow(rows[0], x=axis, y=axis, z=axis),
        "a grid in space and time": GriddedFlow(rows, (-1.0, 5.0, 9.0), axis, axis, axis),
    }
    for scene, name in ((Scene(friction="laminar"), "laminar friction"), (Scene(), "printed friction")):
        simulation = Simulation(law=falling(), scene=scene)
        simulation.advance(2.3)
        cases: dict[str, Flow | None] = {"still water": None, **water}
        times = times_in_turn({case: evaluations(simulation, flow) for case, flow in cases.items()})
        yield f"{name}, {len(simulation.grid.x)} nodes, still water", _microseconds(times["still water"]), "us (CPU)"
        for case in water:
            yield f"{name}, {case}", median_ratio(times[case], times["still water"]), "evaluations in still water"
    for case in ("a shear", "a street of 34 vortices", "a grid in space and time"):
        swim = partial(simulate_batch, [falling()] * 32, 5.0, flows=water[case], estimate=False, sample_period=5.0)
        threads = {count: partial(swim, threads=count) for count in (1, 2)}
        wall, spent = (times_in_turn(threads, clock=clock) for clock in (time.perf_counter, time.process_time))
        yield f"{case}, two threads", median_ratio(wall[1], wall[2]), "times as fast (wall)"
        yield f"{case}, two threads", median_ratio(spent[2], spent[1]), "times the CPU time"


def growth() -> Lines:
    """A whole run of a straight gait, motion alone, set-up included, against its duration."""
    swim = partial(simulate, straight(), scene=Scene(**MOTION), estimate=False)
    times = times_in_turn({each: partial(swim, each, sample_period=each) for each in DURATIONS})
    spent = {duration: statistics.median(values) for duration, values in times.items()}
    for duration, seconds in spent.items():
        yield f"{duration:4.0f} s", duration / seconds, "s per CPU second"
    yield "exponent of growth", _exponent(spent), "(1: linear)"


def _exponent(costs: dict) -> float:
    return float(np.polyfit(np.log(list(costs)), np.log(list(costs.values())), 1)[0])


def plane() -> Lines:
    """Evaluations in the plane against those in space, straight gait: one evaluation at equal nodes, with the drag's
    kinks and without, and 10 s of motion alone at equal targets."""
    for friction in ("laminar", "printed"):
        for kinks in ("all", "jumps", "none"):
            scenes = {flat: Scene(planar=flat, friction=friction, **MOTION) for flat in (False, True)}
            swimmers = {flat: swimming(straight(), scene, kinks=kinks) for flat, scene in scenes.items()}
            times = times_in_turn({flat: evaluations(swimmer) for flat, swimmer in swimmers.items()})
            name = f"{friction} friction, kinks {kinks}"
            yield f"{name}, in space", _microseconds(times[False]), "us per evaluation (CPU)"
            yield f"{name}, in the plane", _microseconds(times[True]), "us per evaluation (CPU)"
            yield f"{name}, ratio", median_ratio(times[False], times[True]), "times cheaper"
    for target in (1e-2, 1e-4, 1e-6):
        swim = partial(simulate, straight(), accuracy=target, sample_period=10.0)
        times = times_in_turn({flat: partial(swim, scene=Scene(planar=flat, **MOTION)) for flat in (False, True)})
        yield f"ratio, 10 s, target {target:g}", median_ratio(times[False], times[True]), "times cheaper"


def switches() -> Lines:
    """What a switch of the scene costs: time of 10 s of a straight gait relative to that with everything on, at equal
    steps and points; and what one evaluation costs without each load, relative to that with all of them."""
    loads: dict[str, tuple[dict, str]] = {  # the scene beside the motion alone, and which kinks of the drag are located
        "no ledger, no wrench": ({}, "all"),
        "  and kinks: jumps": ({}, "jumps"),
        "  and kinks: none": ({}, "none"),
        "  and no friction": ({"friction": "none"}, "all"),
        "  and no wake": ({"wake": False}, "all"),
        "  and no drag": ({"resistive": False}, "all"),
        "  and planar": ({"planar": True}, "all"),
        "  and planar, no drag": ({"planar": True, "resistive": False}, "all"),
    }
    cases = {
        "everything": (Scene(), "all"),
        "no ledger": (Scene(ledger=False), "all"),
        "no internal wrench": (Scene(internal_wrench=False), "all"),
    } | {name: (Scene(**MOTION | settings), kinks) for name, (settings, kinks) in loads.items()}

    def run(scene: Scene, kinks: str) -> Action:
        accuracy = Accuracy(name="bench", resolution=20.0, step=0.02, kinks=kinks)
        return partial(simulate, straight(), scene=scene, accuracy=accuracy)

    def single(scene: Scene, kinks: str) -> Action:
        return evaluations(swimming(straight(), scene, kinks=kinks))

    times = times_in_turn({name: run(*case) for name, case in cases.items()})
    whole = f"of {statistics.median(times['everything']) * 1e3:.1f} ms"
    for name, values in times.items():
        yield name, 1.0 / median_ratio(times["everything"], values), whole
    times = times_in_turn({name: single(*cases[name]) for name in loads})
    first, *_ = loads
    for name, values in times.items():
        label = "all loads" if name == first else name.strip()
        yield (
            f"an evaluation, {label}",
            1.0 / median_ratio(times[first], values),
            f"of {_microseconds(times[first]):.2f} us",
        )


def wrench() -> Lines:
    """One sample at 51 stations, preset standard: motion and powers, the internal wrench besides, the water's load
    besides; and an evaluation of the head's dynamics on the same nodes."""
    swimmer = Simulation(law=falling())
    swimmer.advance(2.3)
    asked = {"motion, powers": (False, False), "and the internal wrench": (True, False), "and the load": (True, True)}
    cases: dict = {name: partial(swimmer.record, np.full(COUNT, 2.3), *wanted) for name, wanted in asked.items()}
    times = times_in_turn({"an evaluation": evaluations(swimmer)} | cases)
    for name, values in times.items():
        yield name, _microseconds(values), "us (CPU)"
    for name in cases:
        yield f"{name}, by evaluations", median_ratio(times[name], times["an evaluation"]), "evaluations"
    alone = [b - a for a, b in zip(times["motion, powers"], times["and the internal wrench"], strict=True)]
    yield "what the wrench adds", median_ratio(alone, times["an evaluation"]), "evaluations"
