# SPDX-License-Identifier: Apache-2.0
"""Reads the arrays of numbers in an .npz archive.

NumPy's own reader evaluates an array's header with Python's parser, and trusts the shape in it. Here the header must
have the form that NumPy writes, and the shape must fit the size in the archive's directory. The archive's checksums are
checked.
"""

import math
import os
import re
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import numpy as np

from eel_common.files.input_file import InputFile
from eel_common.wording import shown

MOST_ARRAYS = 1000
MOST_NUMBERS = 5_000_000  # in one file: 40 MB
SUFFIX = ".npy"
END, PLACE = 22, slice(10, 12)  # bytes of a directory's end, and the place of the number of members in it
LONGEST_HEAD = 1000  # bytes
HEADER = re.compile(r"\{'descr': '([^']*)', 'fortran_order': (True|False), 'shape': \(([0-9, ]*)\), \} *\n")
NUMBERS = re.compile(r"[<>|=]([biuf])([1248])")


def read_archive(path: str | os.PathLike[str]) -> dict[str, np.ndarray]:
    """The arrays of an .npz archive as floats, of any shape. Call it within `reading`: `zipfile` raises many kinds."""
    with InputFile(path) as file, ZipFile(file) as archive:
        members = archive.infolist()
        if not members or len(members) > MOST_ARRAYS:
            raise ValueError(f"it must hold 1 to {MOST_ARRAYS} arrays, got {len(members)}")
        file.seek(file.size - END - len(archive.comment))
        if int.from_bytes(file.read(END)[PLACE], "little") != len(members):  # a damaged length hides those behind it
            raise ValueError("its directory is damaged")
        names = [each.filename.removesuffix(SUFFIX) for each in members]
        if len(set(names)) < len(names):
            raise ValueError(f"each array must have a name of its own, got {shown(names)}")
        found, left = {}, MOST_NUMBERS
        for name, member in zip(names, members, strict=True):
            found[name] = _array(archive, name, member, left)
            left -= found[name].size
    return found


def _array(archive: ZipFile, name: str, member: ZipInfo, most: int) -> np.ndarray:
    if member.compress_type not in (ZIP_STORED, ZIP_DEFLATED) or member.flag_bits & 1:
        raise ValueError(f"{shown(name)} must be stored or deflated, and not encrypted")
    with archive.open(member) as file:
        start = file.read(8)
        width = {b"\x01\x00": 2, b"\x02\x00": 4}.get(start[6:], 0)
        length = int.from_bytes(file.read(width), "little")
        if start[:6] != b"\x93NUMPY" or not 0 < length <= LONGEST_HEAD:
            raise ValueError(f"{shown(name)} is no array")
        head = HEADER.fullmatch(file.read(length).decode("latin-1"))
        if head is None or NUMBERS.fullmatch(head[1]) is None:
            raise ValueError(f"{shown(name)} must be an array of real numbers, got {shown(head and head[1])}")
        shape = tuple(int(each) for each in head[3].split(",") if each.strip())
        dtype, count = np.dtype(head[1]), math.prod(shape)
        if count > most:
            raise ValueError(f"it must hold at most {MOST_NUMBERS} numbers, got {shown(name)} of shape {shown(shape)}")
        if member.file_size != len(start) + width + length + count * dtype.itemsize:
            raise ValueError(f"{shown(name)} of shape {shown(shape)} does not fit its {member.file_size} bytes")
        values = np.frombuffer(file.read(count * dtype.itemsize), dtype)
    return values.reshape(shape, order="F" if head[2] == "True" else "C").astype(float)
