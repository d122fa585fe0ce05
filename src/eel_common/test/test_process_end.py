# SPDX-License-Identifier: Apache-2.0
"""The end of a process by a signal; a thread that hangs does not keep it."""

import signal
import subprocess
import sys

import pytest

LIMIT = 60.0  # s
BEGIN = """
import os, signal, sys, threading, time
from eel_common.ros.process_end import ProcessEnd, exit_immediately
end = ProcessEnd()
"""


def run(code):
    return subprocess.run([sys.executable, "-c", BEGIN + code], capture_output=True, text=True, timeout=LIMIT)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_noted(number):
    done = run(f"print(end.signalled); os.kill(os.getpid(), {int(number)}); print(end.signalled)")
    assert done.stdout == "False\nTrue\n" and done.returncode == 0


def test_signals_that_are_ignored_do_not_change_the_status():
    send = "os.kill(os.getpid(), signal.SIGTERM); os.kill(os.getpid(), signal.SIGINT)"
    done = run(f"end.ignore_signals(); {send}; sys.exit(7)")
    assert done.returncode == 7 and done.stderr == ""


def test_a_thread_that_hangs_does_not_keep_the_process():
    done = run("threading.Thread(target=threading.Event().wait).start(); print(1); exit_immediately(3)")
    assert (done.returncode, done.stdout) == (3, "1\n")
