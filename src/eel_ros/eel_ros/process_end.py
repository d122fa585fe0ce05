# SPDX-License-Identifier: Apache-2.0
"""Waits for the end of the process: SIGINT or SIGTERM, or a thread that returns or raises, whichever comes first."""

import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import NoReturn

POLL = 0.1  # s: a signal just before a wait does not interrupt that wait
SIGNALS = (signal.SIGINT, signal.SIGTERM)


class ProcessEnd:
    """Handles signals and the ends of threads. Create it first, in the main thread.

    A signal may interrupt any line, so its handler only sets a flag and puts into a queue.

    Attributes:
        signalled: whether SIGINT or SIGTERM has come.
        over: set by the main thread; the other threads end when they see it.
    """

    def __init__(self) -> None:
        self._reasons: queue.SimpleQueue[tuple[bool, Exception | None]] = queue.SimpleQueue()
        self.over = self.signalled = self._stays = False
        for number in SIGNALS:
            signal.signal(number, self._take_signal)

    def _take_signal(self, number, frame) -> None:
        self.signalled = True
        self._reasons.put((False, None))

    def ignore_signals(self) -> None:
        """Ignore signals from now on: one more during clean-up would change the exit status."""
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)

    def leave_when_stuck(self, seconds: float) -> None:
        """From now on leave, with status 0, where the main thread is not `over` so many `seconds` after a signal,
        until `stay_when_stuck` is called.

        Python's handlers wait until the main thread is back from a long computation; the byte does not.
        """
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        signal.set_wakeup_fd(writer, warn_on_full_buffer=False)

        def watch() -> None:
            os.read(reader, 1)
            time.sleep(seconds)
            if not self.over and not self._stays:
                leave_at_once(0)

        threading.Thread(target=watch, daemon=True).start()

    def stay_when_stuck(self) -> None:
        """From now on do not leave so: there are files to complete."""
        self._stays = True

    def start(self, work: Callable[[], None]) -> None:
        """Run `work()` in a thread. When it returns or raises, `wait` returns."""

        def run() -> None:
            try:
                work()
            except Exception as error:
                self._reasons.put((False, error))
            else:
                self._reasons.put((True, None))

        threading.Thread(target=run, daemon=True).start()

    def wait(self) -> tuple[bool, Exception | None]:
        """Wait for a signal or a thread; returns (whether a thread returned, the error of one that raised)."""
        while True:
            try:
                return self._reasons.get(timeout=POLL)
            except queue.Empty:
                continue

    def join(self, seconds: float) -> bool:
        """Wait at most `seconds` for all threads; whether they have ended."""
        deadline = time.monotonic() + seconds
        others = [thread for thread in threading.enumerate() if thread is not threading.main_thread()]
        for thread in others:
            thread.join(max(0.0, deadline - time.monotonic()))
        return not any(thread.is_alive() for thread in others)


def leave_at_once(status: int) -> NoReturn:
    """End the process with this exit status, without the interpreter's clean-up: a thread may still be running."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
