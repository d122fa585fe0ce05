# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C handling for commands that keep no partial results."""

import signal


def end_on_interrupt():
    """Let Ctrl-C end the process at once, even in compiled code, for which Python's own handler would wait."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
