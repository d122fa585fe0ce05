# SPDX-License-Identifier: Apache-2.0
"""How contenders are compared: in turn, so that whatever else the machine does meets all alike, and by the CPU
time of this process, to which the time that others take does not count. For contenders that use one thread."""

import statistics
import time

REPEATS = 9


def times_in_turn(contenders: dict, repeats: int = REPEATS) -> dict[str, list[float]]:
    """CPU times [s] of the contenders, taken in turn after one call each that does not count. A contender is a function
    to be timed, or a pair: one that prepares, and does not count, and the one to be timed."""
    times = {name: [] for name in contenders}
    for repeat in range(repeats + 1):
        for name, contender in contenders.items():
            prepare, action = contender if isinstance(contender, tuple) else (None, contender)
            if prepare:
                prepare()
            start = time.process_time()
            action()
            if repeat:
                times[name].append(time.process_time() - start)
    return times


def median_ratio(slow: list[float], fast: list[float]) -> float:
    """Median over the turns of how many times longer `slow` took than `fast`."""
    return statistics.median(a / b for a, b in zip(slow, fast, strict=True))
