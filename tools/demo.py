# SPDX-License-Identifier: Apache-2.0
"""Swim the paper's eel for 10 s through the three nodes, as three processes, into Rerun; then say what happened.

With a display the viewer opens and the run keeps pace with the clock; without one it goes as fast as possible, and a
picture is drawn where the machine can draw one.
"""

import os
import statistics
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

from eel_ros.testing.node_process import NodeProcess
from eel_ros.testing.ros_domain import reserve_domain
from reception import Reception
from run_summary import describe, summarise

OUT = Path("out")
RECORDING = OUT / "falling.rrd"
PICTURE = OUT / "falling.png"
DURATION, RATE = 10.0, 100.0  # s, Hz
LISTENERS = 2  # the visualiser and this program


class DemoError(Exception):
    """Why the demo failed, in one line."""


def main() -> int:
    began = time.monotonic()
    try:
        messages = swim()
        summary = summarise(messages)
        expected = round(DURATION * RATE) + 1
        shown = count_recorded(RECORDING)
        print(describe(summary))
        counts = (summary.published, summary.received, shown)
        print("  samples            {} published, {} received here, {} in {}".format(*counts, RECORDING))
        if set(counts) != {expected}:
            raise DemoError(
                "of {} samples, {} were published, {} came here and {} reached the recording".format(expected, *counts)
            )
        if summary.failures:
            raise DemoError("; ".join(summary.failures))
        say(f"the library alone runs it {library_speed():,.0f} times faster than real time")
        draw()
    except (DemoError, ValueError) as error:
        print(f"[demo] failed: {error}", file=sys.stderr)
        return 1
    say(f"done in {time.monotonic() - began:.1f} s; to look at it: source setup.bash; rerun {RECORDING}")
    return 0


def swim() -> dict[str, list]:
    """Run the three nodes to the end of the gait; all messages that came."""
    display = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    domain = reserve_domain()
    environment = domain.environment()
    os.environ.update(environment)  # for this program's own subscriber
    for stale in (RECORDING, PICTURE):
        stale.unlink(missing_ok=True)
    sink = "[spawn, save]" if display else "[save]"
    say(
        f"three nodes on ROS domain {domain.number}, "
        + ("at real time, in the viewer" if display else "as fast as possible (no display)")
    )
    reception = Reception(domain.number)
    nodes: list[NodeProcess] = []

    def start(executable: str, *settings: str) -> NodeProcess:
        arguments = [word for setting in settings for word in ("-p", setting)]
        node = NodeProcess(
            executable, "--ros-args", *arguments, environment=environment, log=OUT / f"log/{executable}.txt"
        )
        nodes.append(node)
        return node

    try:
        visualiser = start("visualiser", f"sink:={sink}", f"recording:={RECORDING}", "stop_with_publisher:=true")
        start("gait_generator", "gait:=falling")
        dynamics = start(
            "dynamics",
            f"duration:={DURATION}",
            f"rate:={RATE}",
            f"real_time_factor:={1.0 if display else 0.0}",
            f"wait_for_subscribers:={LISTENERS}",
        )
        await_end(dynamics, nodes, limit=60.0)
        await_end(visualiser, nodes, limit=30.0, finished=(dynamics,))
        time.sleep(0.2)  # what this program's own thread has received and not yet read
        return reception.messages
    finally:
        for node in reversed(nodes):
            node.end(descendants=not display)  # a viewer that was opened stays
        reception.close()


def await_end(
    awaited: NodeProcess, nodes: list[NodeProcess], *, limit: float, finished: tuple[NodeProcess, ...] = ()
) -> None:
    """Until `awaited` has left with status 0; DemoError if another, not `finished`, ends, or `limit` [s] passes."""
    deadline = time.monotonic() + limit
    while awaited.status is None:
        if time.monotonic() > deadline:
            raise DemoError(f"{awaited.name} did not end within {limit:g} s (see {awaited.log})")
        if any(node.status is not None for node in nodes if node not in finished):
            break
        time.sleep(0.02)
    for node in nodes:
        if node.status is not None and node not in finished and (node.status or node is not awaited):
            said = [line for line in node.output().splitlines() if line.strip()]
            last = said[-1] if said else "it said nothing"
            raise DemoError(f"{node.name} ended too early, with status {node.status}: {last} (all of it: {node.log})")


def count_recorded(path: Path) -> int:
    """Samples in a recording: those of the topic of which it has the fewest."""
    from rerun.chunk import RrdReader

    from eel_viz import entities

    topics = (
        entities.POSITION,
        entities.SPEED,
        entities.POWER,
        entities.BACKBONE,
        entities.WRENCH_NUMBERS,
        entities.CURVATURE_NUMBERS,
        entities.LOAD_NUMBERS,
        entities.ODOMETRY_NUMBERS,
    )
    rows = Counter()
    for chunk in RrdReader(str(path)).stream():
        if not chunk.is_static:
            rows[chunk.entity_path] += chunk.num_rows
    return min(rows[topic] for topic in topics)


def library_speed() -> float:
    """Simulated seconds per second of the library without ROS, on one core: the median of five runs."""
    from eel_dynamics import simulate
    from eel_gaits import falling

    speeds = []
    for _ in range(6):
        start = time.perf_counter()
        simulate(falling(), duration=DURATION)
        speeds.append(DURATION / (time.perf_counter() - start))
    return statistics.median(speeds[1:])


def draw() -> None:
    """The picture, where the viewer can draw without a display."""
    command = ["eel", "render", str(RECORDING), str(PICTURE)]
    try:
        drawn = subprocess.run(command, capture_output=True, text=True, timeout=60)
        reason = (drawn.stderr or drawn.stdout).strip().splitlines()[-1:] if drawn.returncode else []
    except subprocess.TimeoutExpired:
        drawn, reason = None, ["no picture: the viewer took more than 60 s"]
    if drawn is not None and drawn.returncode == 0 and PICTURE.exists():
        say(f"picture: {PICTURE}")
    else:
        say(reason[0].removeprefix("eel render: ") if reason else "no picture: the viewer gave none")


def say(text: str) -> None:
    print(f"[demo] {text}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
