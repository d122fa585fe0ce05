# SPDX-License-Identifier: Apache-2.0
"""Messages that are serialised once. After that their numbers are changed in place.

Serialising a message field by field costs more than computing its numbers. The layout of the serialised form depends
only on texts and lengths, so the numbers keep their offsets.
"""

import array
from collections.abc import Iterator
from copy import deepcopy
from itertools import count, islice
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message

ENCAPSULATION = 4  # bytes before the content; numbers are aligned to the content's start
MARK = -1.2345678901234567e-200  # and its multiples: unique numbers, to find the offsets
MARKED_TIME = 0x1A2B3C4D, 0x2B3C4D5E  # s, ns


class SerialisedMessage:
    """A `message` in serialised form. Its texts and the lengths of its sequences are fixed.

    Attributes:
        numbers: views of its float64 numbers, by the path of a sequence or array ("torque_1"), or of a message with
            float fields ("pose.position", "transforms[0].transform.rotation", "" for the message itself).
        stamps: views (2,) of the seconds and nanoseconds of its times.
    """

    def __init__(self, message: Any) -> None:
        self.kind, data, marked = type(message), serialize_message(message), deepcopy(message)
        times = count(MARKED_TIME[0])
        blocks = dict(_marked(marked, (MARK * k for k in count(1)), times))
        where = serialize_message(marked)
        space = np.empty(len(data) + 8, dtype=np.uint8)
        begin = -(space.__array_interface__["data"][0] + ENCAPSULATION) % 8
        self._data = space[begin : begin + len(data)]
        self._data[:] = np.frombuffer(data, dtype=np.uint8)
        self.numbers = {path: self._view(where, np.array(values)) for path, values in blocks.items()}
        seconds = range(MARKED_TIME[0], next(times))
        self.stamps = [self._view(where, np.array((second, MARKED_TIME[1]), dtype=np.int32)) for second in seconds]

    def _view(self, where: bytes, marks: np.ndarray) -> np.ndarray:
        place = where.find(marks.tobytes())
        if place < 0 or where.find(marks.tobytes(), place + 1) >= 0:
            raise RuntimeError(f"{self.kind.__name__} is not serialised as it was expected")
        return self._data[place : place + marks.nbytes].view(marks.dtype)

    def data(self) -> bytes:
        """The serialised message with the present numbers."""
        return self._data.tobytes()


def _marked(
    message: Any, marks: Iterator[float], times: Iterator[int], path: str = ""
) -> Iterator[tuple[str, list[float]]]:
    """Put `marks` into the numbers and `times` [s] into the times; yields path and marks of each contiguous block."""
    if isinstance(message, Time):
        message.sec, message.nanosec = next(times), MARKED_TIME[1]

    fields = message.get_fields_and_field_types()
    numbers = [name for name, kind in fields.items() if kind == "double"]
    if numbers:
        values = list(islice(marks, len(numbers)))
        for name, value in zip(numbers, values, strict=True):
            setattr(message, name, value)
        yield path, values
    for name, kind in fields.items():
        value, below = getattr(message, name), f"{path}.{name}" if path else name
        if kind.startswith(("sequence<double>", "double[")) and len(value):
            values = list(islice(marks, len(value)))
            setattr(message, name, np.array(values) if kind.startswith("double[") else array.array("d", values))
            yield below, values
        several = isinstance(value, list)
        for k, each in enumerate(value if several else [value]):
            if hasattr(each, "get_fields_and_field_types"):
                yield from _marked(each, marks, times, f"{below}[{k}]" if several else below)
