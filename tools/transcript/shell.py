# SPDX-License-Identifier: Apache-2.0
"""A shell whose commands and answers are kept as text, and whose nodes run beside it."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from eel_ros.testing.fixtures import OVER_UDP
from eel_ros.testing.ros_domain import reserve_domain

LIMIT = 120.0  # s, for any one command or node
WORDS = Path(__file__).with_name("ros2_words.py")
MASKS = (  # what differs from one run to the next
    (re.compile(r"^\[(\w+)\] \[\d+\.\d+\] "), r"[\1] "),
    (re.compile(r"host \S+, process \d+, started [^)]+"), "host H, process P, started S"),
    (re.compile(r"\[[\d.]+s\]"), "[S s]"),
    (re.compile(r"(t = )[\d.]+( s(?:$|:|'))"), r"\1T\2"),
    (re.compile(r"stamp=\S+Time\(sec=\d\d*, nanosec=\d+\)"), "stamp=T"),
    (re.compile(r"missed \d+"), "missed N"),
    (re.compile(r"average rate: (\d+\.\d+)"), lambda found: f"average rate: about {5 * round(float(found[1]) / 5)}"),
)


class Shell:
    """Runs commands in the folder `folder`, in a ROS domain of their own. What they answer is in `lines`."""

    def __init__(self, folder: Path) -> None:
        self.lines: list[str] = []
        self._folder, self._domain = folder, reserve_domain()
        self._nodes: dict[str, subprocess.Popen] = {}
        environment = self._domain.environment() | OVER_UDP
        environment |= {"ROS_LOG_DIR": str(folder / "log"), "PYTHONUNBUFFERED": "1"}
        (folder / "tools").symlink_to(WORDS.parent.parent)
        if not shutil.which("ros2"):
            words = folder / "bin" / "ros2"
            words.parent.mkdir()
            words.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{WORDS}" "$@"\n')
            words.chmod(0o755)
            environment["PATH"] = f"{words.parent}:{environment['PATH']}"
        self._environment = environment

    def say(self, text: str) -> None:
        """A comment for the reader."""
        self.lines.append(f"# {text}")

    def run(self, command: str, *, most: int = 40) -> str:
        """Run a command and keep its answer, at most so many lines of it; the answer."""
        self.lines.append(f"$ {command}")
        done = subprocess.run(
            ["bash", "-c", command], cwd=self._folder, env=self._environment, timeout=LIMIT, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        answer = [masked(line) for line in done.stdout.splitlines() if line.strip() not in ("", "---")]
        self.lines += answer[:most]
        if len(answer) > most:
            self.lines.append(f"... {len(answer) - most} lines more")
        return done.stdout

    def start(self, name: str, command: str) -> None:
        """Start a node in the background; its output is in the file `name`.log."""
        self.lines.append(f"$ {command} > {name}.log 2>&1 &")
        with self._log(name).open("w") as output:
            self._nodes[name] = subprocess.Popen(
                ["bash", "-c", f"exec {command}"], cwd=self._folder, env=self._environment,
                stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True,
                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
            )  # fmt: skip

    def wait_for(self, name: str, text: str) -> None:
        """Wait until the node `name` has logged the `text`."""
        self._wait_until(name, lambda log: text in log, text)

    def wait_for_lines(self, name: str, count: int) -> None:
        """Wait until the node `name` has logged so many lines."""
        self._wait_until(name, lambda log: log.count("\n") >= count, f"{count} lines")

    def _wait_until(self, name: str, condition: Callable[[str], bool], what: str) -> None:
        limit = time.monotonic() + LIMIT
        while not condition(self._log(name).read_text()):
            if time.monotonic() > limit:
                raise TimeoutError(f"{name} did not log {what}:\n{self._log(name).read_text()}")
            time.sleep(0.05)

    def end(self, *names: str) -> None:
        """Interrupt nodes, and wait for their ends."""
        self.lines.append("$ kill -INT " + " ".join(f"%?{name}.log" for name in names))
        for name in names:
            node = self._nodes.pop(name)
            node.send_signal(signal.SIGINT)
            node.wait(LIMIT)

    def wait_for_end(self, name: str) -> None:
        """Wait for a node that ends by itself, and keep its exit status."""
        self.lines += [f"$ wait %?{name}.log; echo status $?", f"status {self._nodes.pop(name).wait(LIMIT)}"]

    def close(self) -> None:
        """End what still runs."""
        for node in self._nodes.values():
            if node.poll() is None:
                os.killpg(node.pid, signal.SIGTERM)
            node.wait()
        self._domain.claim.close()

    def _log(self, name: str) -> Path:
        return self._folder / f"{name}.log"


def masked(line: str) -> str:
    """The line without what differs from one run to the next."""
    for pattern, put in MASKS:
        line = pattern.sub(put, line)
    return line
