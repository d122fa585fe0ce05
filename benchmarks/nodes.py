# SPDX-License-Identifier: Apache-2.0
"""What the nodes cost and how soon they answer. Real processes in a ROS domain of their own."""

import math
import os
import statistics
import sys
import time
from functools import partial
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src" / "eel_dynamics" / "test"))
import numpy as np
from eel_gaits.ros.messages import law_to_message
from geometry_msgs.msg import PoseStamped
from measuring import Lines, cpu_time, nodes_in_a_domain
from swim_client import LOSSLESS, SwimClient, nanoseconds

from eel_gaits import Law, Term

STARTS, SECONDS, LAWS = 5, 10.0, 31
FIRST_WORDS = {"dynamics": "waiting for curvature_law", "gait_generator": "published on", "visualiser": "saving to"}
DISCOVERED = 2.0  # s of simulated time, when all have found each other
SINKS = {"save": "saving to", "serve": "look at it", "save, serve": "look at it"}  # and what is said when it is ready
BEFORE_THE_SWIM = 3.0  # s of wall time after the start of the dynamics node, when all have found each other


def visualiser() -> Lines:
    """10 s of the falling gait at 50 Hz, 51 stations: CPU time of the visualiser by wall time, and size of the
    recording."""
    for sink, ready in SINKS.items():
        shares, sizes = zip(*(_shown(sink, ready) for _ in range(3)), strict=True)
        yield f"sink {sink}, CPU", 100.0 * statistics.median(shares), "% of one core"
        if "save" in sink:
            yield f"sink {sink}, recording", statistics.median(sizes) / 1e6, "MB"


def _shown(sink: str, ready: str) -> tuple[float, int]:
    """CPU time of the visualiser by wall time while the swimmer swims, and bytes of the recording."""
    with nodes_in_a_domain() as (start, _, folder, _):
        recording = folder / "run.rrd"
        shown = start("visualiser", f"sink:=[{sink}]", f"recording:={recording}", "stop_with_publisher:=true")
        shown.wait_for_output(ready, 60.0)
        start("gait_generator", "gait:=falling")
        swum = start("dynamics", "duration:=10.0", "rate:=50.0", "wait_for_subscribers:=1")
        time.sleep(BEFORE_THE_SWIM)
        first = last = (cpu_time(shown.process.pid), time.monotonic())
        while swum.status is None:
            last = (cpu_time(shown.process.pid), time.monotonic())
            time.sleep(0.1)
        shown.wait(30.0)
        return (last[0] - first[0]) / (last[1] - first[1]), recording.stat().st_size if recording.exists() else 0


def nodes() -> Lines:
    """Start of the dynamics node, and end of each node; CPU time of it and of the gait generator while they swim at 100
    Hz, 51 stations, a subscriber on every topic; how evenly samples are published; and how soon a law that is published
    moves them."""
    with nodes_in_a_domain() as (start, _, folder, domain):
        starts = []
        for executable, words in FIRST_WORDS.items():
            settings = ("sink:=[save]", f"recording:={folder / 'run.rrd'}") if executable == "visualiser" else ()
            times = np.array([_start_and_end(partial(start, executable, *settings), words) for _ in range(STARTS)])
            starts.append((executable, *np.median(times, axis=0), times[:, 1].max()))
        yield "from its start to waiting for a law", float(starts[0][1]), "s"
        for executable, _, end, greatest in starts:
            yield f"{executable}, from SIGINT to its end", float(end), f"s, median (greatest {greatest:.2g})"
        os.environ.update(domain.environment())
        client = SwimClient(domain=domain.number)
        try:
            yield from _while_it_swims(client, start)
        finally:
            client.close()


def _start_and_end(start: Any, words: str) -> tuple[float, float]:
    """Seconds from the start to the first `words`, and from SIGINT to the end."""
    began = time.monotonic()
    node = start()
    node.wait_for_output(words)
    seconds, asked = time.monotonic() - began, time.monotonic()
    assert node.interrupt() == 0, node.output()
    return seconds, time.monotonic() - asked


def _while_it_swims(client: SwimClient, start: Any) -> Lines:
    published: list[tuple[int, int]] = []

    def receive(message: PoseStamped, about: dict) -> None:
        published.append((about["source_timestamp"], nanoseconds(message.header.stamp)))

    client.node.create_subscription(PoseStamped, "head_pose", receive, LOSSLESS)  # type: ignore[arg-type]
    swimming = start("dynamics", "rate:=100.0", "wait_for_subscribers:=1"), start("gait_generator", "gait:=falling")
    client.until_time(DISCOVERED)

    def spent() -> np.ndarray:
        return np.array([cpu_time(node.process.pid) for node in swimming])

    before, began, first = spent(), time.monotonic(), len(published)
    client.spin(SECONDS)
    shares = 100.0 * (spent() - before) / (time.monotonic() - began)
    for node, share in zip(swimming, shares, strict=True):
        yield f"{node.name}, CPU", float(share), "% of one core"
    off = np.diff(np.array(published[first:]), axis=1)[:, 0] / 1e6
    median, late = np.quantile(np.abs(off - np.median(off)), (0.5, 0.99))
    yield "samples off their time", float(late), f"ms, 99th percentile (median {median:.2g})"
    swimming[1].end()
    delays = [1e3 * _delay(client, k) for k in range(LAWS)]
    said = f"ms, median (greatest {max(delays):.3g})"
    yield "from a law to the first sample by it", statistics.median(delays), said


def _delay(client: SwimClient, k: int) -> float:
    """Seconds from publishing another bend to the arrival of the first sample that moves by it."""
    client.spin(0.2 + 0.003 * (k % 9))
    received = client.received["curvature"]
    before, seen, sent = received[-1].yaw[25], len(received), time.monotonic()
    bend = Term(axis="yaw", amplitude=(1.0 + k % 2,), phase=math.pi / 2)
    client.laws.publish(law_to_message(Law(bend, name=f"bend {k}", transition=0.05)))

    def moved() -> int | None:
        return next((j for j in range(seen, len(received)) if abs(received[j].yaw[25] - before) > 1e-9), None)

    client.until(lambda: moved() is not None, "change")
    return client.arrivals["curvature"][moved()] - sent
