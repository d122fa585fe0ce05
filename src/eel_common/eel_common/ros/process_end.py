# SPDX-License-Identifier: Apache-2.0
"""The end of a process by SIGINT or SIGTERM."""

import os
import signal
import sys
import threading
import time
from typing import Any, NoReturn

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class ProcessEnd:
    """Handles signals. Create it first, and in the main thread.

    A signal may interrupt any line, so its handler only sets a flag.

    Attributes:
        signalled: whether SIGINT or SIGTERM has come.
        over: set by the main thread; the other threads end when they see it.
    """

    def __init__(self) -> None:
        self.over = self.signalled = self._stays = False
        for number in SIGNALS:
            signal.signal(number, self._take_signal)

    def _take_signal(self, number: int, frame: Any) -> None:
        self.signalled = True

    def ignore_signals(self) -> None:
        """Ignore signals from now on: one more during clean-up would change the exit status."""
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)

    def leave_when_stuck(self, seconds: float) -> None:
        """From now on, leave with status 0 if the main thread is not `over` within `seconds` after a signal, until
        `stay_when_stuck` is called.

        Python runs signal handlers only when the main thread returns from C code. So a thread waits for a wake-up byte.
        """
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        signal.set_wakeup_fd(writer, warn_on_full_buffer=False)

        def watch() -> None:
            os.read(reader, 1)
            time.sleep(seconds)
            if not self.over and not self._stays:
                exit_immediately(0)

        threading.Thread(target=watch, daemon=True).start()

    def stay_when_stuck(self) -> None:
        """Do not leave in this way any more: there are files to complete."""
        self._stays = True


def exit_immediately(status: int) -> NoReturn:
    """End the process with this exit status, without the interpreter's clean-up: a thread may still be running."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
