# SPDX-License-Identifier: Apache-2.0
"""Headers of messages: stamps as seconds of simulation time, and back; frame ids below a namespace; and what follows a
header, read before the message is deserialised, so that the length of a sequence is known.
"""

import math
import struct

from builtin_interfaces.msg import Time

END = 2**31 - 1  # s: the last second that a stamp holds
LATEST = END - 60  # s: a minute before, so that what answers it has a stamp too

ENCODING, STAMP = 4, 8  # bytes


def seconds_of(stamp: Time, name: str = "header.stamp") -> float:
    """The time [s] of a stamp. `ValueError` for one that is not valid, or so late that no answer can follow it.

    name: of the field, for the error.
    """
    if not 0 <= stamp.sec < LATEST or stamp.nanosec >= 1_000_000_000:
        rule = f">= 0 s and < {LATEST} s, with nanosec < 1e9"
        raise ValueError(f"{name} must be {rule}, got sec {stamp.sec}, nanosec {stamp.nanosec}")
    seconds: float = stamp.sec + 1e-9 * stamp.nanosec
    return seconds


def stamp_of(time: float) -> Time:
    """The stamp of a `time` [s], to the nearest nanosecond. `ValueError` for one that no stamp holds."""
    if not 0.0 <= time < END:
        raise ValueError(f"time of a sample must be >= 0 s and < {END} s, got {time:.9g} s")
    seconds, nanoseconds = divmod(math.floor(time * 1e9 + 0.5), 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


def frame_in(namespace: str, frame: str) -> str:
    """`frame` below the `namespace` of a node, such as eel1/odom; without a leading slash, which tf2 refuses.

    So two robots in two namespaces do not share a frame.
    """
    return f"{namespace}/{frame}".strip("/")


class Beginning:
    """The fields of the message `data` that follow the stamp of its header, one after the other, frame_id first.

    The layout is CDR (RTPS 2.5, 10.5): 4 bytes for the encoding, then the fields, each number aligned to its size.
    """

    def __init__(self, data: bytes) -> None:
        self._data, self._place = data, STAMP
        self._order = "<" if data[1:2] == b"\x01" else ">"

    def number(self) -> int:
        """The next field, a uint32 or the length of a sequence. `EOFError` if the message ends before."""
        self._place += -self._place % 4
        try:
            (number,) = struct.unpack_from(self._order + "I", self._data, ENCODING + self._place)
        except struct.error:
            raise EOFError("it ends before its fields") from None
        self._place += 4
        return int(number)

    def text(self) -> str:
        """The next field, a string. `EOFError` if the message ends before."""
        size = self.number()
        begin = ENCODING + self._place
        self._place += size
        return self._data[begin : begin + size].rstrip(b"\0").decode(errors="replace")
