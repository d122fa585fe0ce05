# SPDX-License-Identifier: Apache-2.0
"""A ROS node in a process of its own, which ends with its owner, however the owner ends."""

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

PR_SET_PDEATHSIG = 1  # linux/prctl.h: the signal sent to the child when its parent dies
PROMPT = 4.0  # s: far above a good end (under 1 s), below any wait for the network (5 s or more)
PATIENCE = 30.0  # s: a busy machine is slow, and a killed node may leave locks in shared memory
MIDDLEWARE = "RTPS_TRANSPORT_SHM"  # in Fast DDS's message on shared memory held by a stopped process


def found_executable(name: str) -> str:
    """Path of one of our executables, found as by `ros2 run`, or of a program on the PATH; else `name`."""
    prefixes = [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(":") if prefix]
    ours = (str(path) for prefix in prefixes for path in prefix.glob(f"lib/eel_*/{name}"))
    return next(ours, None) or shutil.which(name) or name


class NodeProcess:
    """One executable, with its output in a log file."""

    def __init__(self, executable: str, *arguments: str, environment: dict[str, str], log: Path) -> None:
        """Start it: `arguments` as after `ros2 run package executable`, `log` takes both output streams."""
        self.name = executable
        self.log = log
        log.parent.mkdir(parents=True, exist_ok=True)
        libc = ctypes.CDLL(None)

        def prepare() -> None:
            libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # children of a background job ignore it by default

        with log.open("w") as output:
            self.process = subprocess.Popen(
                [found_executable(executable), *arguments],
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=prepare,
            )

    @property
    def status(self) -> int | None:
        """Exit status, or None while it runs."""
        return self.process.poll()

    def output(self) -> str:
        """All its output so far, without the middleware's lines about stopped processes on the machine."""
        said = self.log.read_text(errors="replace").splitlines(keepends=True)
        return "".join(line for line in said if MIDDLEWARE not in line)

    def wait(self, timeout: float) -> int:
        """Wait for the exit status and return it. `subprocess.TimeoutExpired` after `timeout` [s]."""
        return self.process.wait(timeout)

    def wait_for_output(self, text: str, timeout: float = 90.0) -> None:
        """Wait until `text` is in its output. AssertionError if it ends first, or after `timeout` [s]."""
        deadline = time.monotonic() + timeout
        while text not in self.output():
            assert self.status is None, f"{self.name} ended with {self.status} before {text!r}:\n{self.output()}"
            assert time.monotonic() < deadline, f"{self.name} did not say {text!r} in {timeout} s:\n{self.output()}"
            time.sleep(0.02)

    def interrupt(self, sent: signal.Signals = signal.SIGINT, timeout: float = 60.0) -> int:
        """Send a signal and return the exit status; `subprocess.TimeoutExpired` after `timeout` [s]."""
        if self.status is None:
            self.process.send_signal(sent)
        return self.process.wait(timeout)

    def time_to_end(self, sent: signal.Signals = signal.SIGINT, timeout: float = 60.0) -> float:
        """Time [s] from a signal to the end, less the time its threads waited for a processor: so it estimates the
        time on a free machine. AssertionError after `timeout` [s]."""
        before = self._waited()
        waited, began = dict(before), time.monotonic()
        self.process.send_signal(sent)
        ended = os.WEXITED | os.WNOWAIT | os.WNOHANG  # without reaping it, so that it can still be queried
        while os.waitid(os.P_PID, self.process.pid, ended) is None:
            assert time.monotonic() - began < timeout, f"{self.name} has not ended {timeout} s after {sent.name}"
            waited |= self._waited()
            time.sleep(0.005)
        took = time.monotonic() - began
        waited |= self._waited()
        self.process.wait()
        return max(0.0, took - sum(delay - before.get(thread, 0.0) for thread, delay in waited.items()))

    def _waited(self) -> dict[str, float]:
        """For each thread, the time [s] that it was ready to run but had no processor (Linux's `schedstat`)."""
        found = {}
        for path in Path(f"/proc/{self.process.pid}/task").glob("*/schedstat"):
            with contextlib.suppress(OSError):  # it has just ended
                found[path.parent.name] = int(path.read_text().split()[1]) * 1e-9
        return found

    def end(self, *, descendants: bool = True, patience: float = PATIENCE) -> None:
        """Make sure that it is gone: ask first, and kill it after `patience` [s]. descendants: include processes that
        it has started."""
        try:
            self.interrupt(timeout=patience)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        if descendants:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
