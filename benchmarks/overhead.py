# SPDX-License-Identifier: Apache-2.0
"""What observing, samples, ledger, error estimate and sweeps cost, by the motion alone."""

import time
import warnings
from functools import partial

import numpy as np
from eel_dynamics.analysis.settling import Unsettled
from eel_studies.sweeps.sweep import sweep
from measuring import MOTION, Lines, median_ratio, times_in_turn, two_processes_by_one

from eel_dynamics import Scene, Simulation, simulate
from eel_gaits import straight

TICKS = 500  # of 10 ms
PERIODS = np.linspace(0.8, 1.4, 16).tolist()  # s, of the points of a sweep


def overhead() -> Lines:
    """What is asked for besides the motion, by the motion alone: a tick of 10 ms that is observed (51 stations,
    internal wrench, loads) by one that is not; 8 s of the gait straight with ledger, wrench and 161 samples by its
    motion alone; a point of a sweep (16 periods, default measures) by `simulate` of the same settings, and two threads
    by one (least wall times, which only an idle machine tells), beside two processes that share nothing: the most that
    this machine gives. The others are CPU times of one thread."""
    swimmer = Simulation(law=straight())
    begin = partial(_begin, swimmer)
    cases: dict = {seen: (begin, partial(_ticks, swimmer, seen)) for seen in (False, True)}
    times = times_in_turn(cases)
    yield "advance and observe, by advance", median_ratio(times[True], times[False]), "times as long"

    scene = Scene(**MOTION)
    swim = partial(simulate, straight(), 8.0, accuracy=1e-3)
    times = times_in_turn(
        {
            "bare": partial(swim, scene=scene, stations=2, sample_period=8.0, estimate=False),
            "samples": partial(swim, scene=scene, estimate=False),
            "ledger, wrench, samples": partial(swim, estimate=False),
            "ledger, wrench, samples, estimate": swim,
        }
    )
    for name in list(times)[1:]:
        yield f"simulate with {name}, by bare", median_ratio(times[name], times["bare"]), "times as long"

    warnings.simplefilter("ignore", Unsettled)  # the runs of 10 s
    for duration in ("settled", 10.0):
        grid = partial(sweep, {"period": PERIODS}, gait="straight", duration=duration, progress=_silent)
        alone, threads = partial(_one_by_one, duration), {count: partial(grid, workers=count) for count in (1, 2)}
        times = times_in_turn({"sweep": threads[1], "simulate": alone}, 5)
        named = f"sweep, duration {duration}"
        yield f"{named}, by simulate", median_ratio(times["sweep"], times["simulate"]), "times as long per point"
        wall = times_in_turn(threads, 5, time.perf_counter)
        yield f"{named}, two threads", min(wall[1]) / min(wall[2]), "times as fast as one (wall)"
        yield f"{named}, two processes", two_processes_by_one(threads[1]), "times as much as one (wall)"


def _silent(done: int, points: int) -> None:
    """No bar of progress."""


def _begin(swimmer: Simulation) -> None:
    swimmer.reset()
    swimmer.advance(2.0)


def _ticks(swimmer: Simulation, seen: bool) -> None:
    for tick in range(1, TICKS + 1):
        swimmer.advance(2.0 + 0.01 * tick)
        if seen:
            swimmer.observe()


def _one_by_one(duration: float | str) -> None:
    for period in PERIODS:
        simulate(straight(period=period), duration)
