# SPDX-License-Identifier: Apache-2.0
"""Speed and accuracy, measured: `python benchmarks/run.py [NAME ...]`, one line per figure with its unit.

Each figure is the median of repeats in one process; ratios come from repeats taken in turn. Timings mean something on
an otherwise idle machine only.
"""

import platform
import statistics
import subprocess
import sys
import time
from functools import partial

import numpy as np
from against_paper_scheme import paper_scheme
from against_peers import peers
from batch import batch
from eel_studies.tradeoff.settings import REFERENCE
from growth import growth
from gym_steps import gym
from integrators import integrators
from lockstep import lockstep
from measuring import median_ratio, times_in_turn
from nodes import nodes
from switches import COUNT, evaluations, plane, switches
from ticks import ticks
from visualiser import visualiser

from eel_dynamics import Accuracy, Body, Scene, Simulation, simulate
from eel_gaits import falling

REPEATS = 9
BODY = Body.boyer2010()


def median_seconds(action, repeats: int = REPEATS) -> float:
    """Median wall time [s] of `action` over `repeats` calls, after one that does not count."""
    action()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def evaluation():
    """One evaluation of the head's dynamics (momentum form, three dimensions, all loads), against the number of
    nodes."""
    for resolution in (8.0, 13.0, 36.0, 80.0, 180.0):
        swimmer = Simulation(body=BODY, law=falling(), accuracy=Accuracy(name="bench", resolution=resolution))
        swimmer.advance(2.3)
        times = times_in_turn({"one": evaluations(swimmer)})["one"]
        yield f"{len(swimmer.grid.x):4d} nodes", statistics.median(times) / COUNT * 1e6, "us per evaluation (CPU)"


def falling_gait():
    """10 s of the falling gait, laminar friction: times real time, and the error of the head's position by its path
    (against a finer run)."""
    lean = Scene(friction="laminar", ledger=False, internal_wrench=False)
    finest = simulate(falling(), body=BODY, accuracy=REFERENCE, scene=lean, estimate=False)
    all_of_it = Scene(friction="laminar")
    for name, scene, period in (("motion alone", lean, 10.0), ("ledger, wrench, 201 samples", all_of_it, 0.05)):
        for accuracy in (1e-2, 1e-3, 1e-4, 1e-6):
            swim = partial(simulate, falling(), body=BODY, accuracy=accuracy, scene=scene, sample_period=period)
            swim, estimated = partial(swim, estimate=False), swim
            run = swim()
            seconds = median_seconds(swim)
            error = np.linalg.norm(run.position[-1] - finest.position[-1]) / finest.path_length
            yield (
                f"{name}, target {accuracy:g}",
                10.0 / seconds,
                f"times real time, error {error:.1e}, {run.evaluations} evaluations",
            )
            yield (
                f"with the error estimate, {name}, target {accuracy:g}",
                median_seconds(estimated) / seconds,
                "times as long as the bare run",
            )


def wrench():
    """One sample at 51 stations, preset standard: motion and powers, the internal wrench besides, the water's load
    besides; and an evaluation of the head's dynamics on the same nodes."""
    swimmer = Simulation(body=BODY, law=falling())
    swimmer.advance(2.3)
    instants = np.full(COUNT, 2.3)
    asked = {"motion, powers": (False, False), "and the internal wrench": (True, False), "and the load": (True, True)}
    cases = {name: partial(swimmer.record, instants, *wanted) for name, wanted in asked.items()}
    times = times_in_turn({"an evaluation": evaluations(swimmer)} | cases)
    for name, values in times.items():
        yield name, statistics.median(values) / COUNT * 1e6, "us (CPU)"
    for name in cases:
        yield f"{name}, by evaluations", median_ratio(times[name], times["an evaluation"]), "evaluations"
    before, after = times["motion, powers"], times["and the internal wrench"]
    alone = [b - a for a, b in zip(before, after, strict=True)]
    yield "what the wrench adds", median_ratio(alone, times["an evaluation"]), "evaluations"


def start():
    """A fresh process: import of the library, and the first step and sample."""
    code = (
        "import time; a = time.perf_counter(); from eel_dynamics import simulate; from eel_gaits import falling; "
        "b = time.perf_counter(); simulate(falling(), 0.05, estimate=False); print(b - a, time.perf_counter() - b)"
    )
    runs = [
        tuple(map(float, subprocess.check_output([sys.executable, "-c", code], text=True).split())) for _ in range(5)
    ]
    yield "import", statistics.median(first for first, _ in runs), "s"
    yield "first step and sample", statistics.median(second for _, second in runs), "s"


FIGURES = {
    "evaluation": evaluation,
    "plane": plane,
    "falling": falling_gait,
    "wrench": wrench,
    "switches": switches,
    "start": start,
    "ticks": ticks,
    "growth": growth,
    "integrators": integrators,
    "batch": batch,
    "visualiser": visualiser,
    "nodes": nodes,
    "lockstep": lockstep,
    "gym": gym,
}
OPTIONAL = {"peers": peers, "paper_scheme": paper_scheme}  # on request: they install other people's packages


def main(names: list[str]) -> int:
    """Run the named figures, or all. Exit status 2 for an unknown name."""
    known = FIGURES | OPTIONAL
    unknown = [name for name in names if name not in known]
    if unknown:
        print(f"run.py: unknown figure {unknown[0]!r}, must be one of {', '.join(known)}", file=sys.stderr)
        return 2
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    machine = f"{platform.processor() or platform.machine()}, Python {platform.python_version()}"
    print(f"{machine}, commit {commit or 'unknown'}, medians of {REPEATS}")
    for name in names or FIGURES:
        print(f"{name}: {' '.join(known[name].__doc__.split())}")
        for label, value, unit in known[name]():
            print(f"  {label:42s} {value:10.4g} {unit}" if value is not None else f"  {label}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
