"""The compiled loops, made before they are needed.

A compilation holds its process up and cannot be interrupted, so where something is not in the cache yet, it is done in
a process apart, which can be ended at any time.
"""

import subprocess
import sys

from numba.core import event

from .simulation import Simulation

WARM_UP = "from eel_dynamics import Simulation; Simulation().warm_up()"
POLL = 0.05  # s


class _CompilationNeeded(Exception):
    pass


class _Refusal(event.Listener):
    """Lets loops come from the cache, and nothing be compiled."""

    def on_start(self, event):
        raise _CompilationNeeded

    def on_end(self, event):
        pass


def ensure(say, interrupted) -> bool:
    """Has all loops compiled; False where `interrupted(seconds)`, which waits so long, became true in the meantime."""
    if load():
        return True
    say("compiling the physics, which takes a minute or so and is kept for the next start")
    return compile_apart(interrupted)


def load() -> bool:
    """Loads all loops from the cache; False where some would have to be compiled."""
    refusal = _Refusal()
    event.register("numba:compile", refusal)
    try:
        Simulation().warm_up()
    except _CompilationNeeded:
        return False
    finally:
        event.unregister("numba:compile", refusal)
    return True


def compile_apart(interrupted) -> bool:
    """Fills the cache from a process apart; False once `interrupted(seconds)`, which waits so long, is true."""
    compiler = subprocess.Popen(
        [sys.executable, "-c", WARM_UP],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    while compiler.poll() is None:
        if interrupted(POLL):
            compiler.kill()
            compiler.wait()
            return False
    return True
