"""Ctrl-C and SIGTERM end each node within a second, with status 0 and without a traceback."""

import signal
import time

import pytest

NODES = {
    "gait_generator": ("--ros-args",),
    "dynamics": ("--ros-args",),
    "visualiser": ("--ros-args", "-p", "sink:=[save]"),
}


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("executable", NODES)
def test_signal_ends_a_node(start, tmp_path, monkeypatch, executable, sent):
    monkeypatch.chdir(tmp_path)
    node = start(executable, *NODES[executable])
    node.wait_for_output("[INFO]")
    began = time.monotonic()
    status = node.interrupt(sent)
    assert status == 0, node.output()
    assert time.monotonic() - began < 1.0
    assert "Traceback" not in node.output()


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_a_swim(start, fresh_domain, sent):
    start("gait_generator")
    node = start("dynamics")
    time.sleep(2.0)  # in mid-run, or waiting for the law: both must end well
    began = time.monotonic()
    assert node.interrupt(sent) == 0, node.output()
    assert time.monotonic() - began < 1.0
    assert "Traceback" not in node.output()


def test_unknown_gait_is_one_clear_error(start):
    node = start("gait_generator", "--ros-args", "-p", "gait:=moonwalk")
    assert node.wait(20.0) == 2
    said = [line for line in node.output().splitlines() if line.strip()]
    assert len(said) == 1 and "gait" in said[0] and "moonwalk" in said[0], node.output()
