# SPDX-License-Identifier: Apache-2.0
"""How the cost grows with nodes and with duration: `python benchmarks/run.py growth`."""

import statistics
from functools import partial

import numpy as np
from measuring import times_in_turn

from eel_dynamics import Accuracy, Scene, Simulation, simulate
from eel_gaits import falling, straight

RESOLUTIONS = (8.0, 13.0, 24.0, 36.0, 60.0, 90.0, 130.0, 180.0)  # points per body length
DURATIONS = (10.0, 30.0, 100.0, 300.0)  # s
LEAN = Scene(ledger=False, internal_wrench=False)


def growth():
    """Motion alone, CPU times: one evaluation against nodes, without set-up, and a whole run of a straight gait, with
    set-up, against its duration; with the exponents of growth, 1 for linear."""
    law, swims, nodes, evaluations = falling(), {}, {}, {}
    for resolution in RESOLUTIONS:
        accuracy = Accuracy(name="bench", resolution=resolution, step=0.01)
        nodes[resolution] = len(Simulation(accuracy=accuracy).grid.x)
        for duration in (1.0, 5.0):
            swim = partial(simulate, law, duration, scene=LEAN, accuracy=accuracy, sample_period=duration)
            swims[resolution, duration] = swim
            evaluations[resolution, duration] = swim().evaluations
    times = times_in_turn(swims)
    spent = {}
    for resolution in RESOLUTIONS:
        longer, shorter = (times[resolution, duration] for duration in (5.0, 1.0))
        more = evaluations[resolution, 5.0] - evaluations[resolution, 1.0]
        spent[resolution] = statistics.median(a - b for a, b in zip(longer, shorter, strict=True)) / more
        yield f"{nodes[resolution]:4d} nodes", spent[resolution] * 1e6, "us per evaluation"
    few, many = (slice(None), slice(len(RESOLUTIONS) // 2, None))
    for name, part in (("exponent over all of them", few), ("exponent over the finer half", many)):
        chosen = RESOLUTIONS[part]
        yield name, _exponent([nodes[r] for r in chosen], [spent[r] for r in chosen]), ""
    runs = {
        duration: partial(simulate, straight(), duration, scene=LEAN, sample_period=duration) for duration in DURATIONS
    }
    times = times_in_turn(runs)
    for duration in DURATIONS:
        yield f"{duration:4.0f} s", duration / statistics.median(times[duration]), "s per CPU second"
    yield "exponent in the duration", _exponent(DURATIONS, [statistics.median(times[d]) for d in DURATIONS]), ""


def _exponent(sizes, costs) -> float:
    return float(np.polyfit(np.log(sizes), np.log(costs), 1)[0])
