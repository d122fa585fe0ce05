# SPDX-License-Identifier: Apache-2.0
"""What a scene requires, and what it is spared: the plane against space, the switches, the search for the drag's kinks:
`python benchmarks/run.py plane switches`."""

import statistics
from collections.abc import Callable
from functools import partial

from measuring import median_ratio, times_in_turn

import eel_core
from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import straight

COUNT = 2000  # evaluations that are timed together
RESOLUTION = 13.0  # points per body length
LEAN = {"ledger": False, "internal_wrench": False}


def evaluations(simulation: Simulation) -> Callable[[], None]:
    """Evaluates the head's dynamics COUNT times in the simulation's present state, and in its scene's dimensions."""
    kind = eel_core.PlanarInstant if simulation.scene.planar else eel_core.Instant
    instant = kind(simulation.discretisation.swimmer)
    return partial(instant.repeat_rate, simulation.tabulated_law, simulation.time, simulation.state, COUNT)


def plane():
    """Evaluations in the plane against those in space, straight gait: one evaluation at equal nodes, with the drag's
    kinks and without, and 10 s of motion alone at equal targets."""
    for friction in ("laminar", "printed"):
        for kinks in ("all", "jumps", "none"):
            name = f"{friction} friction, kinks {kinks}"
            times = times_in_turn(
                {
                    planar: evaluations(_swimming(Scene(planar=planar, friction=friction, **LEAN), kinks))
                    for planar in (False, True)
                }
            )
            space, flat = (statistics.median(times[planar]) / COUNT * 1e6 for planar in (False, True))
            yield f"{name}, in space", space, "us per evaluation (CPU)"
            yield f"{name}, in the plane", flat, "us per evaluation (CPU)"
            yield f"{name}, ratio", median_ratio(times[False], times[True]), "times cheaper"
    for target in (1e-2, 1e-4, 1e-6):
        swim = {
            planar: partial(
                simulate, straight(), accuracy=target, scene=Scene(planar=planar, **LEAN), sample_period=10.0
            )
            for planar in (False, True)
        }
        times = times_in_turn(swim)
        yield f"ratio, 10 s, target {target:g}", median_ratio(times[False], times[True]), "times cheaper"


def switches():
    """What a switch of the scene costs: time of 10 s of a straight gait relative to that with everything on, at equal
    steps and points; and what one evaluation costs without each load, relative to that with all of them."""
    cases = {
        "everything": (Scene(), "all"),
        "no ledger": (Scene(ledger=False), "all"),
        "no internal wrench": (Scene(internal_wrench=False), "all"),
        "no ledger, no wrench": (Scene(**LEAN), "all"),
        "  and kinks: jumps": (Scene(**LEAN), "jumps"),
        "  and kinks: none": (Scene(**LEAN), "none"),
        "  and no friction": (Scene(friction="none", **LEAN), "all"),
        "  and no wake": (Scene(wake=False, **LEAN), "all"),
        "  and no drag": (Scene(resistive=False, **LEAN), "all"),
        "  and planar": (Scene(planar=True, **LEAN), "all"),
        "  and planar, no drag": (Scene(planar=True, resistive=False, **LEAN), "all"),
    }
    times = times_in_turn(
        {
            name: partial(
                simulate,
                straight(),
                scene=scene,
                accuracy=Accuracy(name="bench", resolution=20.0, step=0.02, kinks=kinks),
            )
            for name, (scene, kinks) in cases.items()
        }
    )
    whole = times["everything"]
    for name, values in times.items():
        yield name, 1.0 / median_ratio(whole, values), f"of {statistics.median(whole) * 1e3:.1f} ms"
    loads = {
        "all loads": _swimming(Scene(**LEAN), "all"),
        "  without the search for kinks": _swimming(Scene(**LEAN), "none"),
        "  without friction": _swimming(Scene(friction="none", **LEAN), "all"),
        "  without the wake": _swimming(Scene(wake=False, **LEAN), "all"),
        "  without drag": _swimming(Scene(resistive=False, **LEAN), "all"),
    }
    times = times_in_turn({name: evaluations(simulation) for name, simulation in loads.items()})
    one = times["all loads"]
    for name, values in times.items():
        yield f"an evaluation, {name.strip()}", 1.0 / median_ratio(one, values), _of(one)


def _of(times: list[float]) -> str:
    return f"of {statistics.median(times) / COUNT * 1e6:.2f} us (CPU)"


def _swimming(scene: Scene, kinks: str) -> Simulation:
    """A swimmer in the midst of a straight gait."""
    accuracy = Accuracy(name="bench", resolution=RESOLUTION, kinks=kinks)
    simulation = Simulation(scene=scene, law=straight(), accuracy=accuracy)
    simulation.advance(2.3)
    return simulation
