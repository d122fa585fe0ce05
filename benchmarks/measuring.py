# SPDX-License-Identifier: Apache-2.0
"""How benchmarks measure: contenders in turn, so that whatever else the machine does meets all alike, and medians.

The CPU time of this process does not count what others take; it is for contenders that use one thread. Nodes run in a
ROS domain of their own.
"""

import contextlib
import multiprocessing
import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from eel_common.ros.testing.fixtures import starter
from eel_common.ros.testing.ros_domain import reserve_domain

from eel_dynamics import Accuracy, Scene, Simulation
from eel_gaits import Law

REPEATS = 9
MOTION: dict[str, Any] = {"ledger": False, "internal_wrench": False}  # of a Scene: the motion alone
Lines = Iterator[tuple[str, float | None, str]]  # label, value (None: there is the label alone), unit
Action = Callable[[], object]


def times_in_turn(
    contenders: dict[Any, Any], repeats: int = REPEATS, clock: Callable[[], float] = time.process_time
) -> dict[Any, list[float]]:
    """Times [s] of the contenders, taken in turn after one call each that does not count. A contender is a function to
    be timed, or a pair: one that prepares, and does not count, and the one to be timed."""
    times: dict[Any, list[float]] = {name: [] for name in contenders}
    for repeat in range(repeats + 1):
        for name, contender in contenders.items():
            prepare, action = contender if isinstance(contender, tuple) else (None, contender)
            if prepare:
                prepare()
            start = clock()
            action()
            if repeat:
                times[name].append(clock() - start)
    return times


def median_ratio(slow: list[float], fast: list[float]) -> float:
    """Median over the turns of how many times longer `slow` took than `fast`."""
    return statistics.median(a / b for a, b in zip(slow, fast, strict=True))


def two_processes_by_one(action: Action, repeats: int = 5) -> float:
    """How many times as much of `action` two processes do as one, by the least wall times: the most that two threads
    can gain on this machine. They are forks of this process; one of them acts alone in turn with both."""
    forking = multiprocessing.get_context("fork")
    barrier, times = forking.Barrier(2), forking.SimpleQueue()

    def act(first: bool) -> None:
        action()
        for alone in [True, False] * repeats:
            barrier.wait()
            start = time.perf_counter()
            if first or not alone:
                action()
            barrier.wait()
            if first:
                times.put(time.perf_counter() - start)

    processes = [forking.Process(target=act, args=(first,)) for first in (True, False)]
    for process in processes:
        process.start()
    found = [times.get() for _ in range(2 * repeats)]
    for process in processes:
        process.join()
    return 2.0 * min(found[::2]) / min(found[1::2])


def swimming(law: Law, scene: Scene, resolution: float = 13.0, kinks: str = "all") -> Simulation:
    """A swimmer in the midst of its gait, 2.3 s after the start. resolution: points per body length."""
    accuracy = Accuracy(name="bench", resolution=resolution, kinks=kinks)
    simulation = Simulation(scene=scene, law=law, accuracy=accuracy)
    simulation.advance(2.3)
    return simulation


@contextlib.contextmanager
def nodes_in_a_domain() -> Iterator[tuple[Callable[..., Any], Callable[..., Any], Path, Any]]:
    """start(node, *parameters) and begin(executable, *words), which give a NodeProcess; a folder; the ROS domain. After
    the block all have ended."""
    domain = reserve_domain()
    starting = contextlib.contextmanager(starter)
    with tempfile.TemporaryDirectory() as name, starting(Path(name), **domain.environment()) as begin:

        def start(executable: str, *parameters: str) -> Any:
            return begin(executable, "--ros-args", *(word for each in parameters for word in ("-p", each)))

        yield start, begin, Path(name), domain
    domain.claim.close()


def cpu_time(pid: int) -> float:
    """CPU time [s] that all threads of a process have used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
