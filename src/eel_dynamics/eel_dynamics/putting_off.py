"""Signals whose handlers raise (Ctrl-C, the timeout of a test), put off where what they raise would be lost.

While loops are compiled, LLVM calls back into Python to hand over the machine code, after seconds in which no signal is
heard. What a handler raises there goes nowhere, and the code is lost with it: "no compiled object yet for <Library
...>". So such a signal is delivered as soon as the function has been compiled.
"""

import signal
import threading
from contextlib import contextmanager

from numba.core.codegen import ll

RAISING = signal.SIGINT, signal.SIGTERM, signal.SIGALRM
ENGINE = ll.executionengine.ExecutionEngine
CALLBACKS = {ENGINE._raw_object_cache_notify.__code__, ENGINE._raw_object_cache_getbuffer.__code__}

_waiting: list[int] = []  # signals that have come in a callback
_before: dict = {}  # handlers by signal, while any function is compiled


@contextmanager
def put_off():
    """While a function is compiled, in the main thread: the only one that hears signals."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    outermost = not _before
    if outermost:
        _before.update((number, signal.getsignal(number)) for number in RAISING)
        for number, handler in _before.items():
            if callable(handler):
                signal.signal(number, _hear)
    try:
        yield
    finally:
        if outermost:
            for number, handler in _before.items():
                if callable(handler):
                    signal.signal(number, handler)
            _before.clear()
        if _waiting:
            number = _waiting.pop()
            _waiting.clear()
            signal.raise_signal(number)


def _hear(number, frame):
    at = frame
    while at is not None:
        if at.f_code in CALLBACKS:
            _waiting.append(number)
            return
        at = at.f_back
    _before[number](number, frame)
