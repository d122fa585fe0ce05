# SPDX-License-Identifier: Apache-2.0
"""Swim the paper's eel for 10 s through the three nodes, as three processes, into Rerun; then say what happened.

A fourth process records every message, from which the figures come. With a display the viewer opens and the run keeps
pace with the clock; without one it goes as fast as possible, and a picture is drawn where the machine can draw one.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
import timeit
from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.ros.testing.node_process import NodeProcess
from eel_common.ros.testing.ros_domain import reserve_domain
from eel_dynamics.runs.exchange.eel_viz_functions import function_of_eel_viz
from eel_dynamics.runs.exchange.recorded_run import fields_of_messages
from plain_picture import draw_plain

from eel_dynamics import Run, simulate
from eel_gaits import falling

OUT = Path("out")
RECORDING = OUT / "falling.rrd"
PICTURE = OUT / "falling.png"
DURATION, RATE = 10.0, 100.0  # s, Hz
LISTENERS = 2  # the visualiser and the recorder
RESIDUAL_LIMIT = 1e-3  # of the energy ledger, by the actuators' work
LONGEST = 300.0  # s of wall time that a node takes to end; seconds, but on a machine that is busy with other work
PICTURED = 0.7  # of the swim: from here on
CLOSURE_LIMIT = 1e-10  # of the internal force and torque at the nose, by their greatest values


class DemoError(Exception):
    """Why the demo failed, in one line."""


def main() -> int:
    """Exit status 1, with one line of reason, where a node or a figure fails."""
    began = time.monotonic()
    try:
        messages = swim()
        run, shown = Run(**fields_of_messages(messages, None, None)), count_recorded(RECORDING)
        print(run.summary())
        figures = diagnostics(messages)
        counts = int(figures["samples_published"][-1]), len(run.time), shown
        print("samples             {} published, {} received here, {} in {}".format(*counts, RECORDING))
        if set(counts) != {round(DURATION * RATE) + 1}:
            raise DemoError(f"of {DURATION * RATE + 1:g} samples not all were published, came here, and were recorded")
        if found := failures(run, figures):
            raise DemoError("; ".join(found))
        say(f"the library alone runs it {library_speed():,.0f} times faster than real time")
        draw(run)
    except (DemoError, ValueError) as error:
        print(f"[demo] failed: {error}", file=sys.stderr)
        return 1
    say(f"done in {time.monotonic() - began:.1f} s; to look at it: source setup.bash; rerun {RECORDING}")
    return 0


def swim() -> list[tuple[str, Any]]:
    """Run the three nodes to the end of the gait; topic and message of all that came."""
    display = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    domain = reserve_domain()
    for stale in (RECORDING, PICTURE):
        stale.unlink(missing_ok=True)
    pace = "at real time, in the viewer" if display else "as fast as possible (no display)"
    say(f"three nodes on ROS domain {domain.number}, {pace}")
    nodes: list[NodeProcess] = []

    def start(executable: str, *words: str) -> NodeProcess:
        log = OUT / f"log/{executable}.txt"
        nodes.append(NodeProcess(executable, *words, environment=domain.environment(), log=log))
        return nodes[-1]

    def start_node(executable: str, **parameters: object) -> NodeProcess:
        words = (word for name, value in parameters.items() for word in ("-p", f"{name}:={value}"))
        return start(executable, "--ros-args", *words)

    sink = "[spawn, save]" if display else "[save]"
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        try:
            recorder = start("record", "--out", str(bag), "--stop-with-publisher")
            visualiser = start_node("visualiser", sink=sink, recording=RECORDING, stop_with_publisher="true")
            start_node("gait_generator", gait="falling")
            settings = {"duration": DURATION, "rate": RATE, "wait_for_subscribers": LISTENERS}
            dynamics = start_node("dynamics", real_time_factor=1.0 if display else 0.0, **settings)
            await_end(dynamics, nodes)
            await_end(visualiser, nodes, finished=(dynamics, recorder))
            await_end(recorder, nodes, finished=(dynamics, visualiser))
            return list(function_of_eel_viz("messages")(bag, None))
        finally:
            for node in reversed(nodes):
                node.end(descendants=not display)  # a viewer that was opened stays


def await_end(awaited: NodeProcess, nodes: list[NodeProcess], *, finished: tuple[NodeProcess, ...] = ()) -> None:
    """Until `awaited` has left with status 0; DemoError if another, not `finished`, ends, or it takes too long."""
    deadline = time.monotonic() + LONGEST
    while awaited.status is None:
        if time.monotonic() > deadline:
            raise DemoError(f"{awaited.name} did not end within {LONGEST:g} s (see {awaited.log})")
        if any(node.status is not None for node in nodes if node not in finished):
            break
        time.sleep(0.02)
    for node in nodes:
        if node.status is not None and node not in finished and (node.status or node is not awaited):
            said = [line for line in node.output().splitlines() if line.strip()]
            last = said[-1] if said else "it said nothing"
            raise DemoError(f"{node.name} ended too early, with status {node.status}: {last} (all of it: {node.log})")


def diagnostics(messages: list[tuple[str, Any]]) -> dict[str, list[float]]:
    """The numbers of the dynamics node's diagnostics, in order; `DemoError` where it has sent none."""
    figures: dict[str, list[float]] = {}
    for _, message in (each for each in messages if each[0] == "diagnostics"):
        for pair in (pair for status in message.status for pair in status.values):
            if pair.key in ("samples_published", "closure_force", "closure_torque"):
                figures.setdefault(pair.key, []).append(float(pair.value))
    if len(figures) < 3:
        raise DemoError("no diagnostics of the dynamics node came")
    return figures


def failures(run: Run, figures: dict[str, list[float]]) -> list[str]:
    """What breaks the limits; empty for a sound run."""
    assert run.energy is not None
    residual = np.abs(run.energy.residual).max() / abs(run.energy.actuator_work[-1])
    sizes = {"energy residual by the work": (residual, RESIDUAL_LIMIT)}
    for name in ("force", "torque"):
        greatest = np.linalg.norm(getattr(run, name), axis=2).max()
        sizes[f"closure of the {name}, by its greatest"] = max(figures[f"closure_{name}"]) / greatest, CLOSURE_LIMIT
    return [f"{what} is {size:.3g}, of {limit:g}" for what, (size, limit) in sizes.items() if not size <= limit]


def count_recorded(path: Path) -> int:
    """Samples in a recording: those of the topic of which it has the fewest."""
    from rerun.chunk import RrdReader

    from eel_viz import entities

    names = ("POSITION", "SPEED", "POWER", "BACKBONE", "WRENCH_NUMBERS", "CURVATURE_NUMBERS", "LOAD_NUMBERS")
    rows: Counter[str] = Counter()
    for chunk in RrdReader(str(path)).stream():
        if not chunk.is_static:
            rows[chunk.entity_path] += chunk.num_rows
    return min(rows[getattr(entities, name)] for name in (*names, "ODOMETRY_NUMBERS"))


def library_speed() -> float:
    """Simulated seconds per second of the library without ROS, on one core: the median of five runs."""
    times = timeit.repeat(partial(simulate, falling(), DURATION), number=1, repeat=6)
    return DURATION / statistics.median(times[1:])


def draw(run: Run) -> None:
    """The picture, of a strong bend: by the viewer, where it can draw without a display, else a plain one."""
    late = run.time > PICTURED * DURATION
    assert run.torque is not None
    moment = run.time[late][np.abs(run.torque[late, :, 2]).max(axis=1).argmax()]
    command = ["eel", "render", str(RECORDING), str(PICTURE), "--at", f"{moment:.2f}"]
    try:
        drawn = subprocess.run(command, capture_output=True, text=True, timeout=60)
        reason = (drawn.stderr or drawn.stdout).strip().splitlines()[-1:] if drawn.returncode else []
    except subprocess.TimeoutExpired:
        drawn, reason = None, ["no picture: the viewer took more than 60 s"]
    if drawn is not None and drawn.returncode == 0 and PICTURE.exists():
        say(f"picture: {PICTURE}")
    else:
        draw_plain(RECORDING, PICTURE)
        why = reason[0].removeprefix("eel render: ") if reason else "the viewer gave none"
        say(f"plain picture by matplotlib: {PICTURE}; {why.replace('no picture', 'no better one')}")


def say(text: str) -> None:
    print(f"[demo] {text}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
