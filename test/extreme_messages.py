# SPDX-License-Identifier: Apache-2.0
"""Messages with extremes in their fields: of any type, one field at a time, and in all fields together."""

import array
import copy
import importlib
import itertools
import math
import re
import sys

from rclpy.serialization import serialize_message

FLOATS = 0.0, -0.0, 1.0, -1.0, math.nan, math.inf, -math.inf, sys.float_info.max, -sys.float_info.max, 5e-324
TEXTS = "", "x" * 50_000, "two\nlines\r\x1b[31m", "%s%n{0}", "\U0001f41f"
LENGTHS = 1, 3, 1000
HUGE = 20_000, 40_000  # elements: one that is read where they are numbers, and one that is not
STAMPS = (  # s, ns; each goes back or ahead from the one before
    *((5, 0), (6, 0), (3605, 0), (2, 0), (1_800_000_000, 0), (3, 0), (2**31 - 1, 0), (4, 0), (2**31 - 1, 10**9 - 1)),
    *((0, 2**32 - 1), (2**31 - 1, 2**32 - 1), (-1, 0), (-(2**31), 2**32 - 1), (7, 0)),
)
MANY = 12  # elements of all sequences, where all fields are extreme together: three, or four, numbers to a point
INTEGER = re.compile(r"(u?)int(\d+)")


def get_message(name: str) -> type:
    """The type of a name such as std_msgs/msg/Header, or std_msgs/Header."""
    package, *_, kind = name.split("/")
    return getattr(importlib.import_module(f"{package}.msg"), kind)


def get_service(name: str) -> type:
    """The type of a service from a name such as std_srvs/srv/Trigger."""
    package, *_, kind = name.split("/")
    return getattr(importlib.import_module(f"{package}.srv"), kind)


def values_of(kind: str) -> list:
    """The extremes of a field that is no sequence and no message."""
    if kind in ("double", "float"):
        return list(FLOATS)
    if kind == "boolean":
        return [False, True]
    if kind == "octet":
        return [b"\0", b"\xff"]
    if kind.startswith(("string", "wstring")):
        return list(TEXTS)
    unsigned, bits = INTEGER.fullmatch(kind).groups()
    return [0, 1, 2 ** int(bits) - 1] if unsigned else [0, 1, -1, 2 ** (int(bits) - 1) - 1, -(2 ** (int(bits) - 1))]


def element_of(kind: str) -> tuple[str, int | None]:
    """The type of the elements of a field, and how many there are: 0, as many as one likes; None, it is no sequence."""
    if found := re.fullmatch(r"sequence<(.+?)(?:, \d+)?>", kind):
        return found[1], 0
    if found := re.fullmatch(r"(.+)\[(\d+)\]", kind):
        return found[1], int(found[2])
    return kind, None


def fields_of(message, path=()):
    """Path and type of each field that is no message, also of the first element of sequences of messages."""
    for name, kind in message.get_fields_and_field_types().items():
        element, count = element_of(kind)
        if "/" not in element:
            yield (*path, name), kind
        elif count is None:
            yield from fields_of(getattr(message, name), (*path, name))
        else:
            yield (*path, name), kind
            for inner, inner_kind in fields_of(get_message(element)()):
                yield (*path, name, 0, *inner), inner_kind


def put(message, path, value):
    """Set the field at `path`, making the elements that it lies in."""
    *way, last = path
    for place, name in enumerate(way):
        if name == 0:
            continue
        inner = getattr(message, name)
        if place + 1 < len(way) and way[place + 1] == 0:
            if not inner:
                element, _ = element_of(message.get_fields_and_field_types()[name])
                setattr(message, name, [get_message(element)()])
            inner = getattr(message, name)[0]
        message = inner
    setattr(message, last, value)


def choices_of(kind: str, lengths=LENGTHS) -> list:
    """What a field of the type may hold at its worst."""
    element, count = element_of(kind)
    if "/" in element:
        return [[get_message(element)() for _ in range(length)] for length in lengths]
    if count is None:
        return values_of(element)
    numbers = element in ("double", "float") or INTEGER.fullmatch(element)
    rows = [[value] * length for value in values_of(element) for length in ([count] if count else lengths)]
    code = {"double": "d", "float": "f"}.get(element)
    return [array.array(code, row) if code and numbers and not count else row for row in rows]


def extremes(kind: type):
    """Messages of the type: each field's extremes with all others as they are, then all fields' together."""
    yield kind()
    for path, field in fields_of(kind()):
        for value in choices_of(field):
            message = kind()
            put(message, path, value)
            yield message
    for pick in range(len(FLOATS)):
        message = kind()
        for path, field in fields_of(kind()):
            if "/" not in element_of(field)[0]:
                choices = choices_of(field, (MANY,))
                put(message, path, choices[pick % len(choices)])
        yield message


def stamped(message):
    """The `message` with stamps ahead, back, of wall time and at both ends of what a stamp holds."""
    for seconds, nanoseconds in STAMPS:
        other = copy.deepcopy(message)
        stamp = other.clock if hasattr(other, "clock") else other.header.stamp
        stamp.sec, stamp.nanosec = seconds, nanoseconds
        yield other


def for_names(kind: type, known: tuple[str, ...]):
    """Messages of the type for names that a node knows, with each extreme, and each length that does not fit.

    kind: of a message with `name` and sequences of numbers, as JointState.
    """
    fields = [name for name, field in kind.get_fields_and_field_types().items() if element_of(field) == ("double", 0)]
    for names in ((known[0],), known, (*known, "nobody"), (known[0], known[0]), ("nobody",)):
        for count in sorted({0, 1, len(names), len(names) + 1, 1000}):
            yield kind(name=names, **{fields[0]: [0.1] * count})
            yield kind(name=names, **{field: [0.1] * count for field in fields})
    for field, value in itertools.product(fields, FLOATS):
        yield kind(name=known, **{field: [value] * len(known)})
        yield kind(name=known[:1], **{field: [value]})
    yield from stamped(kind(name=known, **{fields[0]: [0.1] * len(known)}))


def huge(kind: type):
    """Messages of the type with very many elements in all of their sequences."""
    sequences = [
        (name, element_of(field)[0])
        for name, field in kind.get_fields_and_field_types().items()
        if element_of(field)[1] == 0
    ]
    for length in HUGE if sequences else ():
        message = kind()
        for name, element in sequences:
            one = "name" if element == "string" else get_message(element)() if "/" in element else values_of(element)[1]
            setattr(message, name, array.array("d", [one]) * length if element == "double" else [one] * length)
        yield message


def broken(kind: type):
    """What arrives as bytes and is no message: cut short, and with text that is no UTF-8."""
    whole = serialize_message(next(iter(extremes(kind))))
    yield from (whole[:length] for length in range(4, len(whole), 5))
    named = kind()
    texts = [path for path, field in fields_of(named) if field == "string"]
    if texts:
        put(named, texts[0], "NOTUTF8")
        yield serialize_message(named).replace(b"NOTUTF8", b"\xff\xfe\xc3\x28\x80\x81\xf5")
