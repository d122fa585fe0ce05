# SPDX-License-Identifier: Apache-2.0
"""The end of a process with threads: their work done, an error, a signal; a thread that hangs does not keep it."""

import signal
import subprocess
import sys

import pytest

LIMIT = 60.0  # s
BEGIN = """
import os, signal, sys, threading, time
from eel_ros.process_end import ProcessEnd, leave_at_once
end = ProcessEnd()
"""


def run(code):
    return subprocess.run([sys.executable, "-c", BEGIN + code], capture_output=True, text=True, timeout=LIMIT)


def test_work_that_is_done_ends_the_wait():
    assert run("end.start(lambda: None); print(end.wait(), end.signalled)").stdout == "(True, None) False\n"


def test_an_error_in_a_thread_is_handed_over():
    done = run("end.start(lambda: 1 / 0); done, error = end.wait(); print(done, repr(error))")
    assert done.stdout == "False ZeroDivisionError('division by zero')\n" and done.stderr == ""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_wait(number):
    done = run(f"os.kill(os.getpid(), {int(number)}); print(end.wait(), end.signalled)")
    assert done.stdout == "(False, None) True\n" and done.returncode == 0


def test_signals_that_are_ignored_do_not_change_the_status():
    send = "os.kill(os.getpid(), signal.SIGTERM); os.kill(os.getpid(), signal.SIGINT)"
    done = run(f"end.ignore_signals(); {send}; sys.exit(7)")
    assert done.returncode == 7 and done.stderr == ""


def test_a_thread_that_hangs_does_not_keep_the_process():
    done = run("end.start(threading.Event().wait); print(end.join(0.05)); leave_at_once(3)")
    assert (done.returncode, done.stdout) == (3, "False\n")


def test_threads_that_end_are_waited_for():
    done = run("go = threading.Event(); end.start(go.wait); go.set(); print(end.join(60.0))")
    assert done.stdout == "True\n"
