"""How the process ends: by SIGINT or SIGTERM, or when its work is done or fails, whichever comes first."""

import os
import queue
import signal
import sys
import threading
import time

POLL = 0.1  # s: a signal in the very moment before a wait does not end that wait


class Ending:
    """Made in the main thread, before anything that lasts.

    A signal may interrupt any line, so its handler only puts into a queue.
    """

    def __init__(self):
        self._declared = queue.SimpleQueue()
        self.over = False  # for workers to look at
        self.signalled = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._hear)

    def _hear(self, number, frame):
        self.signalled = True
        self._declared.put((False, None))

    def start(self, work):
        """Runs `work()` in a thread; where it returns or raises, the process is to end."""

        def run():
            try:
                work()
            except Exception as error:
                self._declared.put((False, error))
            else:
                self._declared.put((True, None))

        threading.Thread(target=run, daemon=True).start()

    def wait(self) -> tuple[bool, Exception | None]:
        """Waits for the end: (whether a worker has done its work, the error of one that has failed)."""
        while True:
            try:
                return self._declared.get(timeout=POLL)
            except queue.Empty:
                continue

    def join(self, seconds: float) -> bool:
        """Waits for all threads, at most so long; whether they have ended."""
        deadline = time.monotonic() + seconds
        others = [thread for thread in threading.enumerate() if thread is not threading.main_thread()]
        for thread in others:
            thread.join(max(0.0, deadline - time.monotonic()))
        return not any(thread.is_alive() for thread in others)


def leave_at_once(status: int):
    """Ends the process without the interpreter's tidying up, although some thread may still be at work."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def leave_on_interrupt():
    """For tools that keep nothing of what is half done: Ctrl-C ends the process at once, also in compiled code, which
    Python's own handler waits for."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
