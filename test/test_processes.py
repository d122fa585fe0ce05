# SPDX-License-Identifier: Apache-2.0
"""What the tests and the demo stand on: domains of their own, and processes that never outlive their owner."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import psutil
import pytest
from eel_common.ros.testing.node_process import NodeProcess
from eel_common.ros.testing.ros_domain import reserve_domain


def await_death(pid: int) -> None:
    """Until the process is gone or waits only for its parent to be told; AssertionError after 60 s."""
    deadline = time.monotonic() + 60.0
    while psutil.pid_exists(pid):
        try:
            if psutil.Process(pid).status() == psutil.STATUS_ZOMBIE:
                return
        except psutil.NoSuchProcess:
            return
        assert time.monotonic() < deadline, f"process {pid} lives on"
        time.sleep(0.02)


def test_two_reservations_differ():
    first, second = reserve_domain(), reserve_domain()
    assert first.number != second.number
    assert first.environment()["ROS_DOMAIN_ID"] == str(first.number)
    first.claim.close()
    second.claim.close()


def test_stubborn_process_is_ended_with_its_children(tmp_path):
    script = "trap '' INT TERM; sleep 1000 & echo $!; echo ready; wait; sleep 1000"
    node = NodeProcess("bash", "-c", script, environment=dict(os.environ), log=tmp_path / "log.txt")
    node.wait_for_output("ready")
    child = int(node.output().split()[0])
    node.end(patience=1.0)
    assert node.status == -signal.SIGKILL
    await_death(child)


def test_process_does_not_outlive_a_killed_owner(tmp_path):
    owner = textwrap.dedent(f"""
        import os, time
        from pathlib import Path
        from eel_common.ros.testing.node_process import NodeProcess
        node = NodeProcess("sleep", "1000", environment=dict(os.environ), log=Path({str(tmp_path)!r}) / "log.txt")
        print(node.process.pid, flush=True)
        time.sleep(1000)
    """)
    process = subprocess.Popen([sys.executable, "-c", owner], stdout=subprocess.PIPE, text=True)
    child = int(process.stdout.readline())
    process.kill()
    process.wait()
    await_death(child)


def test_what_the_middleware_says_is_not_the_nodes_own(tmp_path):
    script = "echo '[RTPS_TRANSPORT_SHM Error] Failed init_port fastrtps_port7003'; echo one; echo two"
    node = NodeProcess("bash", "-c", script, environment=dict(os.environ), log=tmp_path / "log.txt")
    assert node.wait(60.0) == 0
    assert node.output() == "one\ntwo\n"


def test_waiting_for_output_of_a_dead_process_fails_at_once(tmp_path):
    node = NodeProcess("bash", "-c", "echo no; exit 3", environment=dict(os.environ), log=tmp_path / "log.txt")
    with pytest.raises(AssertionError, match="ended with 3"):
        node.wait_for_output("yes")
