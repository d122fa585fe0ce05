# SPDX-License-Identifier: Apache-2.0
"""What a run loop publishes to, and what it sleeps on, without ROS."""

import threading
from types import SimpleNamespace

from eel_dynamics.ros.loop.run_loop import RunLoop
from eel_dynamics.ros.parameters import DynamicsParameters


def fake_publishers(publish):
    """Publishers with one subscriber, `publish(snapshot, nanoseconds)`, who needs no costly part of a sample."""
    return SimpleNamespace(
        wanted_parts=lambda: {"wrench": False, "load": False},
        publish=publish,
        tick=lambda nanoseconds: None,
        audience=tuple,
        lossless=False,
    )


class FakeInbox:
    """An inbox to which no samples come; the loop's `wait` ends with `set`."""

    def __init__(self):
        self._event = threading.Event()
        self.set = self._event.set

    def take(self, now):
        return ()

    def wait(self, seconds):
        woken = self._event.wait(seconds)
        self._event.clear()
        return woken

    def wake_callers(self):
        pass


def run_loop(simulation, publishers, report, inbox=None, **parameters):
    """A run loop with these parameters."""
    present = SimpleNamespace(values=DynamicsParameters(**parameters))
    return RunLoop(simulation, present, publishers, inbox or FakeInbox(), report)
