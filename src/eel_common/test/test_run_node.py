# SPDX-License-Identifier: Apache-2.0
"""How a node's process ends: by itself, by a signal, with a failure, or because it cannot start."""

import signal
import sys

import pytest

LIMIT = 90.0  # s
PROCESS = """
import sys, time
from eel_common.ros.run_node import STUCK, run_node
from rclpy.node import Node

class Tank(Node):
    def __init__(self, what):
        if what == "refuse":
            raise ValueError("depth must be > 0 m, got -1")
        super().__init__("tank")
        self.failure, self.what, self.begun = "", what, False
    def listen(self):
        if self.what == "begin":
            print("listening", flush=True)
            time.sleep(3.0 * STUCK)  # stands for a busy machine
    def poll(self):
        if not self.begun:
            self.begun = True
            print("attended", flush=True)
        if self.what == "fail":
            self.failure = "it leaks"
        if self.what == "raise":
            self.what = "wait"
            raise KeyError("no such pump")
        while self.what == "compute":
            pass
        return self.what in ("wait", "raise", "flood")
    def drop_messages(self, before):
        return 7, "all" in sys.argv
    def close(self):
        print("closed", flush=True)

what = sys.argv[1]
work = (lambda node, before: what == "flood") if "work" in sys.argv else None  # flood: there is always one more
sys.exit(run_node("tank", ["tank"], lambda: Tank(what), Tank.poll, work, complete=what != "compute"))
"""


@pytest.mark.parametrize(
    ("what", "status", "said"),
    [
        ("end", 0, "attended\nclosed\n"),
        ("fail", 1, "attended\nclosed\ntank: it leaks\n"),
        ("refuse", 2, "tank: depth must be > 0 m, got -1\n"),
    ],
)
def test_status_and_words_at_its_own_end(start, what, status, said):
    node = start(sys.executable, "-c", PROCESS, what)
    assert node.wait(LIMIT) == status
    assert node.output() == said


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("words", [(), ("work",)])
def test_a_signal_ends_it_well(start, number, words):
    node = start(sys.executable, "-c", PROCESS, "wait", *words)
    node.wait_for_output("attended")
    assert node.interrupt(number, LIMIT) == 0
    assert node.output() == "attended\nclosed\n"


def test_a_node_that_keeps_files_completes_them_from_when_it_listens_on(start):
    node = start(sys.executable, "-c", PROCESS, "begin", "work")
    node.wait_for_output("listening")
    assert node.interrupt(signal.SIGINT, LIMIT) == 0
    assert node.output() == "listening\nclosed\n"


@pytest.mark.fault(
    "ending",
    "SIGINT or SIGTERM, once or twice, to `visualiser` or `record` that is behind by more than it can take",
    "it takes what it can for 1.5 s, says how many are left out, and completes its file; status 0",
)
@pytest.mark.parametrize(("words", "count"), [(("all",), "7 messages"), ((), "at least 7 messages")])
@pytest.mark.parametrize("numbers", [(signal.SIGINT,), (signal.SIGTERM,), (signal.SIGINT, signal.SIGTERM)])
def test_what_is_left_after_a_signal_is_said_and_the_files_are_completed(start, numbers, words, count):
    node = start(sys.executable, "-c", PROCESS, "flood", "work", *words)
    node.wait_for_output("attended")
    for number in numbers:
        node.process.send_signal(number)
    assert node.wait(LIMIT) == 0
    output = node.output()
    assert output.startswith("attended\n") and output.endswith("closed\n"), output
    assert f"left out: {count} that had come before the signal" in output


def test_a_poll_that_raises_is_logged_and_the_node_goes_on(start):
    node = start(sys.executable, "-c", PROCESS, "raise")
    node.wait_for_output("what was due is left out: KeyError: 'no such pump'")
    assert node.interrupt(signal.SIGINT, LIMIT) == 0
    assert node.output().endswith("closed\n") and "Traceback" not in node.output()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_node_in_the_middle_of_a_computation_without_end(start, number):
    node = start(sys.executable, "-c", PROCESS, "compute")
    node.wait_for_output("attended")
    assert node.interrupt(number, LIMIT) == 0
    assert node.output() == "attended\n"
