# SPDX-License-Identifier: Apache-2.0
"""Headers of messages: stamps from and to seconds of simulation time, and frame ids in a namespace.

`FieldReader` reads single fields of a serialised message.
"""

from struct import Struct, error, unpack_from
from typing import NamedTuple

import numpy as np
from builtin_interfaces.msg import Time

END = 2**31 - 1  # s: the last second that a stamp holds
LATEST = END - 60  # s: a minute earlier, so that an answer has a valid stamp too

ENCODING, HEADER = 4, 12  # bytes: of the encoding, and with the stamp
ORDERS = {b"\0\0": ">", b"\0\1": "<"}  # of the bytes of a number, by the encoding
READERS = {code: (Struct(order + "I").unpack_from, np.dtype(order + "f8")) for code, order in ORDERS.items()}


class Stamp(NamedTuple):
    """The time of a header, as `Time`."""

    sec: int
    nanosec: int


def seconds_of(stamp: Time | Stamp, name: str = "header.stamp") -> float:
    """The time [s] of a stamp. `ValueError` if it is invalid, or too late for an answer to have a stamp.

    name: of the field, for the error.
    """
    if not 0 <= stamp.sec < LATEST or stamp.nanosec >= 1_000_000_000:
        rule = f">= 0 s and < {LATEST} s, with nanosec < 1e9"
        raise ValueError(f"{name} must be {rule}, got sec {stamp.sec}, nanosec {stamp.nanosec}")
    seconds: float = stamp.sec + 1e-9 * stamp.nanosec
    return seconds


def stamp_of(time: float) -> Time:
    """The stamp of a `time` [s], to the nearest nanosecond. `ValueError` if it does not fit into a stamp."""
    if not 0.0 <= time < END:
        raise ValueError(f"time of a sample must be >= 0 s and < {END} s, got {time:.9g} s")
    seconds, nanoseconds = divmod(round(time * 1e9), 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


def frame_in(namespace: str, frame: str) -> str:
    """`frame` below the `namespace` of a node, such as eel1/odom, so that robots in two namespaces share no frame.

    It has no leading slash, which tf2 refuses.
    """
    return f"{namespace}/{frame}".strip("/")


class FieldReader:
    """Reads the fields after the header from the serialised message `data`, one after the other.

    The layout is CDR (RTPS 2.5, 10.5): 4 bytes for the encoding, then the fields, each number aligned to its size.
    `ValueError` for another encoding; `EOFError` if the message ends before a field.
    """

    def __init__(self, data: bytes) -> None:
        if data[:2] not in ORDERS:
            raise ValueError(f"it must be encoded in CDR, got encoding {data[:2].hex() or 'none'}")
        self._data, self._place = data, HEADER
        self._number, self._float = READERS[data[:2]]
        self.text()  # frame_id

    @property
    def stamp(self) -> Stamp:
        """The stamp of the header."""
        return Stamp(*unpack_from(ORDERS[self._data[:2]] + "iI", self._data, ENCODING))

    def number(self) -> int:
        """The next field, a uint32 or the length of a sequence."""
        begin = self._place + -self._place % 4
        self._place = begin + 4
        try:
            number: int = self._number(self._data, begin)[0]
        except error:
            raise EOFError("it ends before its fields") from None
        return number

    def numbers(self) -> np.ndarray:
        """The next field, a sequence of float64, as a view (n,)."""
        count = self.number()
        begin = self._place + (ENCODING - self._place) % 8 if count else self._place
        self._place = begin + 8 * count
        if self._place > len(self._data):
            raise EOFError("it ends before its fields")
        return np.ndarray(count, self._float, self._data, begin)

    def text(self) -> str:
        """The next field, a string."""
        size = self.number()
        begin, self._place = self._place, self._place + size
        return self._data[begin : begin + size].rstrip(b"\0").decode(errors="replace")
