# SPDX-License-Identifier: Apache-2.0
"""Reads numbers and names from HDF5 files with h5py, which executes nothing in them.

An HDF5 file may state a shape without data, refer to other files, and hold chunks that inflate far beyond their size.
So shapes, links and chunks are checked before any number is read. Pickled attributes of PyTables are read as text:
`names_in` finds the names in one without unpickling.
"""

import contextlib
import math
import os
import pickletools
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from eel_common.files.archive import MOST_NUMBERS
from eel_common.files.input_file import InputFile
from eel_common.wording import shown

MOST_NAMES, LONGEST_NAME = 10_000, 1_000
MOST_CHUNKS, MOST_CHUNK_BYTES = 100_000, 64_000_000
WIDEST = 8  # bytes of a number
DEFLATE, SHUFFLE, CHECKSUM = 1, 2, 3  # filters that HDF5 itself has
OPENED, ENDED = ("MARK",), ("LIST", "TUPLE")  # instructions in a pickle that holds only names, as PyTables writes it
NAMED, KEPT, AGAIN, ADDED = ("UNICODE", "BINUNICODE", "STRING"), ("PUT", "BINPUT"), ("GET", "BINGET"), ("APPEND",)


@contextlib.contextmanager
def opened_hdf5(path: str | os.PathLike[str], most: int | None = None) -> Iterator[Any]:
    """The `h5py.File` at `path`, of at most `most` bytes. `ValueError` without h5py. Call it within `reading`."""
    try:
        import h5py
    except ImportError:
        raise ValueError("HDF5 needs h5py (pip install h5py)") from None
    with InputFile(path, most):
        pass
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        raise ValueError(f"it cannot be read as HDF5: {error}") from None
    with file:
        yield file


def members(group: Any) -> dict[str, Any]:
    """The groups and data sets directly in a group, by name. External links are left out."""
    import h5py

    names = [name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink)]
    return {name: group[name] for name in names}


def numbers_of(data: Any, most: int = MOST_NUMBERS) -> np.ndarray:
    """The numbers of a data set, named fields too. `ValueError` for more than `most`, or for anything else."""
    kinds = [data.dtype[name].base for name in data.dtype.names] if data.dtype.names else [data.dtype.base]
    if any(kind.kind not in "biuf" or kind.itemsize > WIDEST for kind in kinds):
        raise ValueError(f"{shown(data.name)} must hold real numbers, got {shown(str(data.dtype))}")
    _check(data, WIDEST * most)
    return np.asarray(data[()])


def texts_of(data: Any) -> list[str]:
    """The texts of a one-dimensional data set. `ValueError` for anything else."""
    import h5py

    if data.ndim != 1 or (data.dtype.kind != "S" and h5py.check_string_dtype(data.dtype) is None):
        raise ValueError(f"{shown(data.name)} must be a row of texts, got {shown(str(data.dtype))}")
    if len(data) > MOST_NAMES or data.dtype.itemsize > LONGEST_NAME:
        raise ValueError(f"{shown(data.name)} must be at most {MOST_NAMES} texts of {LONGEST_NAME} bytes")
    _check(data, MOST_NAMES * LONGEST_NAME)
    return [bytes(each).decode("utf-8") for each in data[()]]


def _check(data: Any, most: int) -> None:
    """`ValueError` for a data set of more than `most` bytes, in another file, or with chunks that are too large."""
    plan = data.id.get_create_plist()
    if data.is_virtual or plan.get_external_count():
        raise ValueError(f"{shown(data.name)} lies in another file")
    if data.size * data.dtype.itemsize > most:
        raise ValueError(f"{shown(data.name)} must have at most {most} bytes, got the shape {shown(data.shape)}")
    filters = [plan.get_filter(place)[0] for place in range(plan.get_nfilters())]
    if not set(filters) <= {DEFLATE, SHUFFLE, CHECKSUM}:
        raise ValueError(f"{shown(data.name)} must be compressed by gzip, or not at all")
    if data.chunks is None:
        return
    size = math.prod(data.chunks) * data.dtype.itemsize
    if size > MOST_CHUNK_BYTES or data.id.get_num_chunks() > MOST_CHUNKS:
        rule = f"at most {MOST_CHUNKS} chunks of at most {MOST_CHUNK_BYTES} bytes"
        raise ValueError(f"{shown(data.name)} must have {rule}, got {size}")
    if DEFLATE in filters:
        _check_chunks(data, size)


def _check_chunks(data: Any, size: int) -> None:
    """`ValueError` where a chunk inflates to more than `size` [bytes] and its checksum."""
    places: list[tuple[int, ...]] = []
    data.id.chunk_iter(lambda chunk: places.append(chunk.chunk_offset))
    for place in places:
        _, content = data.id.read_direct_chunk(place)
        with contextlib.suppress(zlib.error):  # not deflated, or damaged: HDF5 reports it
            if len(zlib.decompressobj().decompress(content, size + 5)) > size + 4:
                raise ValueError(f"{shown(data.name)} has a chunk that inflates to more than its {size} bytes")


def attribute_text(holder: Any, name: str) -> bytes:
    """The text of an attribute; empty where it is missing or no text."""
    value = holder.attrs.get(name, b"")
    return value.encode() if isinstance(value, str) else bytes(value) if isinstance(value, bytes) else b""


def names_in(text: bytes) -> list[tuple[str, ...]]:
    """The tuples of names in a pickled list, found without unpickling. `ValueError` if it holds anything else."""
    stack: list[Any] = []
    kept: dict[Any, Any] = {}
    mark = object()
    try:
        for instruction, value, _ in pickletools.genops(text):
            if instruction.name in OPENED:
                stack.append(mark)
            elif instruction.name in ENDED:
                start = len(stack) - 1 - stack[::-1].index(mark)
                parts = stack[start + 1 :]
                stack[start:] = [tuple(parts) if instruction.name == "TUPLE" else parts]
            elif instruction.name in NAMED:
                stack.append(value)
            elif instruction.name in KEPT:
                kept[value] = stack[-1]
            elif instruction.name in AGAIN:
                stack.append(kept[value])
            elif instruction.name in ADDED:
                stack[-2].append(stack.pop())
            elif instruction.name != "STOP":
                raise ValueError(f"the instruction {instruction.name}")
        (rows,) = stack
        if not isinstance(rows, list) or len(rows) > MOST_NAMES:
            raise ValueError(f"no list of at most {MOST_NAMES} names")
        if not all(isinstance(row, tuple) and row and all(isinstance(name, str) for name in row) for row in rows):
            raise ValueError("more than names")
    except (ValueError, LookupError, AttributeError, UnicodeError) as error:
        raise ValueError(f"its pickled names hold more than names, and are not unpickled: {error}") from None
    return rows
