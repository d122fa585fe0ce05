# SPDX-License-Identifier: Apache-2.0
"""What showing a run costs: `python benchmarks/run.py visualiser`. A real run of the falling gait at the clock's rate,
three processes, and the CPU time of the visualiser alone while the swimmer swims."""

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tools"))
from eel_ros.testing.node_process import NodeProcess
from eel_ros.testing.ros_domain import reserve_domain

DURATION, RATE = 10.0, 50.0  # s, Hz
START = 3.0  # s after the start of the dynamics node, when all have found each other
SINKS = {"save": "saving to", "serve": "look at it", "save, serve": "look at it"}  # and what is said when it is ready
RUNS = 3


def visualiser():
    """10 s of the falling gait at 50 Hz, 51 stations: CPU time of the visualiser by wall time, and size of the
    recording."""
    for sink, ready in SINKS.items():
        shares, sizes = zip(*(_run(sink, ready) for _ in range(RUNS)), strict=True)
        yield f"sink {sink}, CPU", 100.0 * statistics.median(shares), "% of one core"
        if "save" in sink:
            yield f"sink {sink}, recording", statistics.median(sizes) / 1e6, "MB"


def _run(sink: str, ready: str) -> tuple[float, int]:
    """CPU time of the visualiser by wall time, and bytes of the recording."""
    domain, nodes = reserve_domain(), []
    with tempfile.TemporaryDirectory() as folder:

        def start(executable: str, *settings: str) -> NodeProcess:
            words = [word for setting in settings for word in ("-p", setting)]
            log = Path(folder) / f"{executable}.txt"
            nodes.append(NodeProcess(executable, "--ros-args", *words, environment=domain.environment(), log=log))
            return nodes[-1]

        recording = Path(folder) / "run.rrd"
        try:
            shown = start("visualiser", f"sink:=[{sink}]", f"recording:={recording}", "stop_with_publisher:=true")
            shown.wait_for_output(ready, 60.0)
            start("gait_generator", "gait:=falling")
            swum = start("dynamics", f"duration:={DURATION}", f"rate:={RATE}", "wait_for_subscribers:=1")
            time.sleep(START)
            first = last = (cpu_time(shown.process.pid), time.monotonic())
            while swum.status is None:
                last = (cpu_time(shown.process.pid), time.monotonic())
                time.sleep(0.1)
            shown.wait(30.0)
            return (last[0] - first[0]) / (last[1] - first[1]), recording.stat().st_size if recording.exists() else 0
        finally:
            for node in reversed(nodes):
                node.end()


def cpu_time(pid: int) -> float:
    """CPU time [s] that all threads of a process have used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
