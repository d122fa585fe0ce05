# SPDX-License-Identifier: Apache-2.0
"""A viewer that does not read costs a bounded amount of memory, however much passes."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from eel_viz.recording.reading import read
from eel_viz.viewer import free_port, native_viewer

from eel_viz import entities

CHILD = str(Path(__file__).with_name("stuck_viewer.py"))
ALLOWED = 20.0  # MB of memory, while more than that goes into the file


@pytest.fixture
def mute():
    """The port of a server that accepts, and never reads nor answers."""
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen(64)
        yield server.getsockname()[1]


@pytest.fixture
def show(tmp_path):
    """show(sink, port) -> the process, when it waits for its viewer to get stuck; ended with the test."""
    started = []

    def begin(sink, port, wanted):
        words = [sys.executable, CHILD, str(tmp_path / "run.rrd"), sink, str(port), str(wanted)]
        places = [str(Path(CHILD).parent), *filter(None, [os.environ.get("PYTHONPATH")])]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(places)}
        started.append(
            subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)
        )
        assert started[-1].stdout.readline() == "ready\n"
        return started[-1]

    yield begin
    for process in started:
        process.kill()
        process.wait()


def growth(process, full: float) -> tuple[float, list[str]]:
    """[MB] by which the memory grew from when the file has `full` MB, and all buffers are as full as they get; what was
    said.

    What waits for the disk comes and goes with the load of the machine: so the least memory in the last third of the
    data is compared with the least in the first third.
    """
    process.stdin.write("go\n")
    process.stdin.flush()
    rows = []
    for line in process.stdout:
        if line == "done\n":
            break
        rows.append(json.loads(line))
    assert process.wait(90) == 0
    third = (rows[-1][1] - full) / 3.0
    assert 2.0 * third > 1.2 * ALLOWED, rows  # what is kept in memory would be seen
    first = [row[2] for row in rows if full <= row[1] <= full + third]
    last = [row[2] for row in rows if row[1] >= full + 2.0 * third]
    return min(last) - min(first), rows[-1][3]


@pytest.mark.fault(
    "subscribers", "a viewer's port that accepts and never answers", "said; nobody waits, memory stays bounded"
)
@pytest.mark.soak
def test_a_server_that_never_reads(mute, show, tmp_path):
    grown, said = growth(show("connect", mute, 55.0), 10.0)
    assert grown < ALLOWED
    assert any("does not answer" in line or "has not read" in line for line in said), said
    stamps = read(tmp_path / "run.rrd", entities.POSITION).stamps
    assert len(stamps) > 1000 and len(set(stamps[1:] - stamps[:-1])) == 1  # the file has everything


@pytest.mark.fault(
    "subscribers",
    "a viewer of served data stopped by SIGSTOP",
    "disconnected, and said, 2 s after its buffers, some 60 MB, are full; memory is bounded, the file complete",
)
@pytest.mark.soak
def test_a_viewer_of_served_data_that_is_stopped(show, tmp_path):
    port = free_port()
    process = show("serve", port, 130.0)
    words = ["--port", str(free_port()), "--bind", "127.0.0.1", "--save", str(tmp_path / "seen.rrd")]
    viewer = subprocess.Popen(
        [native_viewer(), *words, f"rerun+http://127.0.0.1:{port}/proxy"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        seen = tmp_path / "seen.rrd"
        for _ in range(900):
            if (seen.exists() and seen.stat().st_size > 1000) or viewer.poll() is not None:
                break
            time.sleep(0.1)
        assert viewer.poll() is None and seen.stat().st_size > 1000, "it does not look on"
        os.kill(viewer.pid, signal.SIGSTOP)
        grown, said = growth(process, 90.0)
    finally:
        viewer.kill()
        viewer.wait()
    assert grown < ALLOWED
    assert any("does not keep up" in line for line in said), said
    stamps = read(tmp_path / "run.rrd", entities.POSITION).stamps
    assert len(stamps) > 1000 and len(set(stamps[1:] - stamps[:-1])) == 1
