# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and SIGTERM end each node promptly, with status 0 and without a traceback."""

import signal
import time

import psutil
import pytest
from eel_common.ros.testing.node_process import PROMPT

NODES = {  # the gait generator's end is in the tests of its package
    "dynamics": ("--ros-args",),
    "visualiser": ("--ros-args", "-p", "sink:=[save]"),
}


def ends_well(node, sent) -> bool:
    """Whether the signal ends the node promptly, and as it should."""
    took = node.time_to_end(sent)
    assert node.status == 0 and "Traceback" not in node.output(), node.output()
    return took < PROMPT


@pytest.mark.fault(
    "ending", "SIGINT or SIGTERM when a law has just been adopted", "prompt exit, status 0, no traceback"
)
def test_signal_ends_a_swim(start, fresh_domain):
    start("gait_generator")
    for sent in (signal.SIGINT, signal.SIGTERM):
        node = start("dynamics")
        node.wait_for_output("adopted")
        assert ends_well(node, sent), sent


def test_unknown_gait_is_one_clear_error(start):
    node = start("gait_generator", "--ros-args", "-p", "gait:=moonwalk")
    assert node.wait(90.0) == 2
    said = [line for line in node.output().splitlines() if line.strip()]
    assert len(said) == 1 and "gait" in said[0] and "moonwalk" in said[0], node.output()


@pytest.mark.fault(
    "ending",
    "SIGINT or SIGTERM at any moment from the first log line on",
    "prompt exit, status 0, no traceback; files have their names",
)
@pytest.mark.parametrize("executable", NODES)
def test_signal_at_any_moment(start, fresh_domain, tmp_path, monkeypatch, executable):
    monkeypatch.chdir(tmp_path)
    start("gait_generator")
    for delay, sent in ((0.0, signal.SIGTERM), (0.3, signal.SIGINT)):
        node = start(executable, *NODES[executable])
        node.wait_for_output("[INFO]")
        time.sleep(delay)  # the moment of the signal is what is tried here
        assert ends_well(node, sent), delay
        assert not list(tmp_path.glob("*.part*")), delay


@pytest.mark.fault("ending", "a second SIGINT while a node ends", "status 0, no traceback")
@pytest.mark.parametrize("executable", NODES)
def test_a_second_signal_spoils_nothing(start, tmp_path, monkeypatch, executable):
    monkeypatch.chdir(tmp_path)
    node = start(executable, *NODES[executable])
    node.wait_for_output("[INFO]")
    node.process.send_signal(signal.SIGINT)
    time.sleep(0.05)  # the moment of the second is what is tried here
    assert node.interrupt() == 0, node.output()
    assert "Traceback" not in node.output()


@pytest.mark.fault("ending", "Ctrl-C in `eel simulate` while it marches", "it ends at once, without a traceback")
def test_interrupted_simulate(start):
    tool = start("simulate", "straight", "--duration", "2000", "--accuracy", "reference")
    deadline = time.monotonic() + 90.0
    while psutil.Process(tool.process.pid).cpu_times().user < 1.5:  # imports take a third of that
        assert tool.status is None and time.monotonic() < deadline, tool.output()
        time.sleep(0.1)
    assert tool.interrupt() == -signal.SIGINT
    assert all(line.startswith("eel simulate: ") for line in tool.output().splitlines()), tool.output()
