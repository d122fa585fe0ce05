"""Ctrl-C for commands that keep nothing of what is half done."""

import signal


def leave_on_interrupt():
    """Have Ctrl-C end the process at once, also in compiled code, which Python's own handler waits for."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
