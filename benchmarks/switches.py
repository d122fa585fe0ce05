"""What a scene requires, and what it is spared: the plane against space, the switches, the search for the drag's kinks:
`python benchmarks/run.py plane switches`."""

import ast
import inspect
import statistics
from functools import partial

import numpy as np
from eel_dynamics.compiled import OPTIONS
from eel_dynamics.planar import rate_of_state_plane
from eel_dynamics.rates import rate_of_state
from measuring import median_ratio, times_in_turn
from numba import njit

from eel_dynamics import Accuracy, Scene, Simulation, kernel, rates, simulate
from eel_gaits import straight

COUNT = 2000  # evaluations that are timed together
RESOLUTION = 13.0  # points per body length
LEAN = {"ledger": False, "internal_wrench": False}
APART = {**OPTIONS, "cache": False}


@njit
def evaluate(count, swimmer, drive, fields, current, time, y, step, dy):
    for _ in range(count):
        rate_of_state(swimmer, drive, fields, current, time, y, step, dy)


@njit
def evaluate_plane(count, swimmer, drive, fields, current, time, y, step, dy):
    for _ in range(count):
        rate_of_state_plane(swimmer, drive, fields, current, time, y, step, dy)


def plane():
    """The planar kernel against that in space, straight gait: one evaluation at equal nodes, with the drag's kinks and
    without, and 10 s of motion alone at equal targets."""
    for friction in ("laminar", "printed"):
        for kinks in ("all", "jumps", "none"):
            name = f"{friction} friction, kinks {kinks}"
            there = {
                planar: _arguments(Scene(planar=planar, friction=friction, **LEAN), kinks) for planar in (False, True)
            }
            times = times_in_turn(
                {"space": partial(evaluate, *there[False]), "plane": partial(evaluate_plane, *there[True])}
            )
            space, flat = (statistics.median(times[each]) / COUNT * 1e6 for each in ("space", "plane"))
            yield f"{name}, in space", space, "us per evaluation (CPU)"
            yield f"{name}, in the plane", flat, "us per evaluation (CPU)"
            yield f"{name}, ratio", median_ratio(times["space"], times["plane"]), "times cheaper"
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
    """What a switch of the scene costs: time of 10 s of a straight gait by that with everything on, at equal steps and
    points. Switches are branches outside the loops: what they cost where they are off is an evaluation without drag by
    one whose source has no drag in it."""
    step = Accuracy(name="bench", resolution=20.0, step=0.02)
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
            name: partial(simulate, straight(), scene=scene, accuracy=_with(step, kinks))
            for name, (scene, kinks) in cases.items()
        }
    )
    whole = times["everything"]
    for name, values in times.items():
        yield name, 1.0 / median_ratio(whole, values), f"of {statistics.median(whole) * 1e3:.1f} ms"
    arguments = _arguments(Scene(resistive=False, **LEAN))
    times = times_in_turn(
        {"branch": partial(evaluate, *arguments), "none": partial(_evaluation_without_drag(), *arguments)}
    )
    yield "no drag, by a source without it", median_ratio(times["branch"], times["none"]), "of an evaluation"


def _with(accuracy: Accuracy, kinks: str) -> Accuracy:
    return Accuracy(name="bench", resolution=accuracy.resolution, step=accuracy.step, kinks=kinks)


def _arguments(scene: Scene, kinks: str = "all"):
    swimmer = Simulation(
        scene=scene, law=straight(), accuracy=Accuracy(name="bench", resolution=RESOLUTION, kinks=kinks)
    )
    swimmer.advance(2.3)
    return (
        *(COUNT, swimmer.swimmer, swimmer.drive, swimmer.fields, np.zeros(3), 2.3),
        *(swimmer.state, swimmer.step, np.zeros(13)),
    )


def _evaluation_without_drag():
    """`evaluate` of the same source, but for the branch on `swimmer.resistive`."""
    inner = dict(vars(kernel))
    _compile_again(kernel.find_loads, inner)
    outer = dict(vars(rates), momentum_rates=_compile_again(kernel.momentum_rates, inner))
    outer["rate_of_state"] = _compile_again(rates.rate_of_state, outer)
    return _compile_again(evaluate, outer, forceinline=False)


def _compile_again(function, names: dict, forceinline: bool = True):
    tree = Without().visit(ast.parse(inspect.getsource(function.py_func)))
    tree.body[0].decorator_list = []
    exec(compile(tree, "<again>", "exec"), names)
    name = function.py_func.__name__
    names[name] = njit(**APART, forceinline=forceinline)(names[name])
    return names[name]


class Without(ast.NodeTransformer):
    """Source without the branch on `swimmer.resistive`."""

    def visit_If(self, node):
        self.generic_visit(node)
        return node.orelse if ast.unparse(node.test) == "swimmer.resistive" else node
