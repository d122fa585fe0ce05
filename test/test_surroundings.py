# SPDX-License-Identifier: Apache-2.0
"""The three nodes and a sweep on machines that lack something that most have."""

import os
import subprocess

import pytest
from eel_viz.recording.reading import read

from eel_viz import entities

WITHOUT_SHARED_MEMORY = """
set -e
mount -t tmpfs tmpfs "$1"
for name in null zero full random urandom tty; do touch "$1/$name"; mount --bind "/dev/$name" "$1/$name"; done
ln -s /proc/self/fd "$1/fd"
mount --rbind "$1" /dev
shift
exec "$@"
"""
NODES = """
import subprocess, sys, time
recording, seconds = sys.argv[1], 120
def begin(*words):
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
def end(process):
    process.send_signal(2)
    said, _ = process.communicate(timeout=seconds)
    return process.returncode, said
kept = ("sink:=[save]", f"recording:={recording}", "stop_with_publisher:=true")
visualiser = begin("visualiser", "--ros-args", *(word for each in kept for word in ("-p", each)))
gait = begin("gait_generator")
swim = ("duration:=1.0", "real_time_factor:=0.0", "wait_for_subscribers:=1")
dynamics = begin("dynamics", "--ros-args", *(word for each in swim for word in ("-p", each)))
dynamics.wait(seconds)
visualiser.wait(seconds)  # a signal would end it before it has taken all messages
for process in (dynamics, visualiser, gait):
    status, said = end(process) if process.poll() is None else (process.returncode, process.stdout.read())
    print(status, said)
    assert status == 0 and "Traceback" not in said, said
"""


@pytest.fixture
def without_shared_memory(tmp_path):
    """The words before a command that has no /dev/shm."""
    device = tmp_path / "dev"
    device.mkdir()
    words = ["unshare", "--mount", "bash", "-c", WITHOUT_SHARED_MEMORY, "-", str(device)]
    tried = subprocess.run([*words, "test", "!", "-e", "/dev/shm"], capture_output=True, text=True)
    if tried.returncode:
        pytest.skip(f"no file systems can be mounted here: {tried.stderr.strip()}")
    return words


def swims(recording, *before, **environment):
    """Whether the three nodes swim for a second, each ending with status 0, and all of it is in the recording."""
    words = [*before, "python", "-c", NODES, str(recording)]
    done = subprocess.run(words, env={**os.environ, **environment}, capture_output=True, text=True, timeout=220)
    assert done.returncode == 0, done.stdout + done.stderr
    assert read(recording, entities.POSITION).time.size == 101


@pytest.mark.fault("names", "a machine without /dev/shm", "the middleware says so; the three nodes swim and end")
@pytest.mark.soak
def test_the_nodes_swim_without_shared_memory(without_shared_memory, fresh_domain, tmp_path):
    swims(tmp_path / "run.rrd", *without_shared_memory)


@pytest.mark.fault("names", "Python without asserts and docstrings (`-OO`)", "the three nodes swim and end")
@pytest.mark.soak
def test_the_nodes_swim_without_asserts_and_docstrings(fresh_domain, tmp_path):
    swims(tmp_path / "run.rrd", PYTHONOPTIMIZE="2")


@pytest.mark.fault(
    "names", "`eel sweep` without /dev/shm", "threads sweep; processes: one line with what to do, status 2"
)
@pytest.mark.parametrize(("more", "status"), [((), 0), (("--scheduler", "processes"), 2)])
@pytest.mark.soak
def test_a_sweep_without_shared_memory_says_what_to_do(without_shared_memory, tmp_path, more, status):
    words = f"eel sweep straight --vary period=0.9,1.0 --duration 0.1 --out {tmp_path / 's.nc'}".split()
    done = subprocess.run([*without_shared_memory, *words, *more], capture_output=True, text=True, timeout=120)
    assert done.returncode == status, done.stderr
    if status:
        *before, last = done.stderr.splitlines()
        assert last.startswith("eel sweep: the processes of a sweep need semaphores in /dev/shm")
        assert all(line.startswith("eel sweep: 0 of 2 points") for line in before)  # of a slow machine
