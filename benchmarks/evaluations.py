# SPDX-License-Identifier: Apache-2.0
"""One evaluation of the head's dynamics, and what water that moves and samples add to it. CPU times, one thread."""

import statistics
import time
from functools import partial

import numpy as np
from measuring import Action, Lines, median_ratio, swimming, times_in_turn

import eel_core
from eel_dynamics import Flow, GriddedFlow, Scene, Shear, Simulation, VortexStreet, Wave, simulate_batch
from eel_gaits import falling

COUNT = 2000  # evaluations that are timed together
RESOLUTIONS = (8.0, 13.0, 36.0, 80.0, 180.0)  # points per body length


def evaluations(simulation: Simulation, flow: Flow | None = None) -> Action:
    """Evaluates the head's dynamics COUNT times in the simulation's present state, and in its scene's dimensions.

    flow: of the water; None: still.
    """
    water = None if flow is None else eel_core.Flow(flow.sources(False))
    motion = simulation.law_on_grid, simulation.time, simulation.state
    return partial(
        eel_core.repeat_rate, simulation.discretisation.swimmer, simulation.scene.planar, *motion, COUNT, water
    )


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
    yield "exponent of growth", np.polyfit(np.log(list(spent)), np.log(list(spent.values())), 1)[0], "(1: linear)"


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
