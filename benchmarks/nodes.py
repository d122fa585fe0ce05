# SPDX-License-Identifier: Apache-2.0
"""What the nodes cost and how soon they answer: `python benchmarks/run.py nodes`. The dynamics at 100 Hz and at the
clock's rate, 51 stations, with a subscriber on every topic; real processes on a domain of their own."""

import math
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src" / "eel_dynamics" / "test"))
import numpy as np
from eel_gaits.ros.messages import law_to_message
from eel_ros.testing.node_process import NodeProcess
from eel_ros.testing.ros_domain import reserve_domain
from geometry_msgs.msg import PoseStamped
from swim_client import LOSSLESS, SwimClient, nanoseconds
from visualiser import cpu_time

from eel_gaits import Law, Term

STARTS, SECONDS, LAWS = 5, 10.0, 31
FIRST_WORDS = {"dynamics": "waiting for curvature_law", "gait_generator": "published on", "visualiser": "saving to"}
SETTLED = 2.0  # s of simulated time, when all have found each other


def nodes():
    """Start of the dynamics node, and end of each node; CPU time of it and of the gait generator while they swim; how
    evenly samples are published; and how soon a law that is published moves them."""
    with tempfile.TemporaryDirectory() as folder:
        yield from _measured(Path(folder), reserve_domain())


def _measured(folder: Path, domain):
    running, client = [], None

    def start(executable: str, *settings: str) -> NodeProcess:
        words = ["--ros-args", *(word for setting in settings for word in ("-p", setting))]
        log = folder / f"{executable}.txt"
        running.append(NodeProcess(executable, *words, environment=domain.environment(), log=log))
        return running[-1]

    try:
        starts = [_seconds_to_start(start) for _ in range(STARTS)]
        yield "from its start to waiting for a law", statistics.median(starts), "s"
        for executable, words in FIRST_WORDS.items():
            ends = [_seconds_to_end(start, executable, words, folder) for _ in range(STARTS)]
            yield (
                f"{executable}, from SIGINT to its end",
                statistics.median(ends),
                f"s, median (greatest {max(ends):.2g})",
            )
        os.environ.update(domain.environment())
        client = SwimClient(domain=domain.number)
        published = []
        client.node.create_subscription(
            PoseStamped,
            "head_pose",
            lambda message, about: published.append((about["source_timestamp"], nanoseconds(message.header.stamp))),
            LOSSLESS,
        )
        swimming = start("dynamics", "rate:=100.0", "wait_for_subscribers:=1"), start("gait_generator", "gait:=falling")
        client.until_time(SETTLED)
        spent, began, first = _spent(swimming), time.monotonic(), len(published)
        client.spin(SECONDS)
        shares = 100.0 * (_spent(swimming) - spent) / (time.monotonic() - began)
        for node, share in zip(swimming, shares, strict=True):
            yield f"{node.name}, CPU", float(share), "% of one core"
        off = np.array([sent - stamp for sent, stamp in published[first:]]) / 1e6
        off = np.abs(off - np.median(off))
        yield (
            "samples off their time",
            float(np.percentile(off, 99.0)),
            f"ms, 99th percentile (median {np.median(off):.2g})",
        )
        running.pop().end()
        delays = [1e3 * _delay(client, k) for k in range(LAWS)]
        yield (
            "from a law to the first sample by it",
            statistics.median(delays),
            f"ms, median (greatest {max(delays):.3g})",
        )
    finally:
        if client is not None:
            client.close()
        for node in reversed(running):
            node.end()


def _seconds_to_start(start) -> float:
    began = time.monotonic()
    node = start("dynamics")
    node.wait_for_output("waiting for curvature_law")
    seconds = time.monotonic() - began
    node.end()
    return seconds


def _seconds_to_end(start, executable: str, words: str, folder: Path) -> float:
    settings = ("sink:=[save]", f"recording:={folder / 'run.rrd'}") if executable == "visualiser" else ()
    node = start(executable, *settings)
    node.wait_for_output(words)
    began = time.monotonic()
    assert node.interrupt() == 0, node.output()
    return time.monotonic() - began


def _spent(swimming) -> np.ndarray:
    return np.array([cpu_time(node.process.pid) for node in swimming])


def _delay(client: SwimClient, k: int) -> float:
    """Seconds from publishing another bend to the arrival of the first sample that moves by it."""
    client.spin(0.2 + 0.003 * (k % 9))
    received = client.received["curvature"]
    before, seen, sent = received[-1].yaw[25], len(received), time.monotonic()
    bend = Term(axis="yaw", amplitude=(1.0 + k % 2,), phase=math.pi / 2)
    client.laws.publish(law_to_message(Law(bend, name=f"bend {k}", transition=0.05)))

    def moved():
        return (j for j in range(seen, len(received)) if abs(received[j].yaw[25] - before) > 1e-9)

    client.until(lambda: next(moved(), None) is not None, "change")
    return client.arrivals["curvature"][next(moved())] - sent
