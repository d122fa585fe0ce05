# SPDX-License-Identifier: Apache-2.0
"""Reads the beginning of a serialised message, so that the length of a sequence is known before it is deserialised.

The layout is CDR (RTPS 2.5, 10.5): 4 bytes for the encoding, then the fields, each number aligned to its size.
"""

import struct

ENCODING, STAMP = 4, 8  # bytes


class Beginning:
    """The fields of the message `data` that follow the stamp of its header, one after the other, frame_id first."""

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
