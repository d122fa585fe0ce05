# SPDX-License-Identifier: Apache-2.0
"""The framing of an .rrd file: finds the complete messages of a file that is cut off.

A file begins with 12 bytes. Each message has its kind and its length (two little-endian 64-bit numbers), then its
content. A complete file ends with a footer after the last message (Rerun 0.41, `re_log_encoding`).
"""

import contextlib
import os
import pathlib
import struct
import tempfile
from collections.abc import Iterator

from eel_common.files.input_file import InputFile

HEADER_SIZE, MESSAGE_HEADER = 12, struct.Struct("<QQ")  # bytes
BLOCK = 2**20  # bytes copied at once
FOOTER, FOOTER_PLACE = b"RRF2FOOT", 12  # and its distance from the file's end [bytes]


def is_complete(path: str | os.PathLike[str]) -> bool:
    """Whether the file ends with a footer."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - FOOTER_PLACE))
        return file.read(len(FOOTER)) == FOOTER


def end_of_whole_messages(path: str | os.PathLike[str]) -> int:
    """The end of the last complete message [bytes]."""
    size = os.path.getsize(path)
    if is_complete(path):
        return size
    with open(path, "rb") as file:
        end = min(HEADER_SIZE, size)
        while end + MESSAGE_HEADER.size <= size:
            file.seek(end)
            _, length = MESSAGE_HEADER.unpack(file.read(MESSAGE_HEADER.size))
            if not length or end + MESSAGE_HEADER.size + length > size:  # a machine that lost its power leaves zeros
                break
            end += MESSAGE_HEADER.size + length
    return end


def cut_to_whole_messages(path: str | os.PathLike[str]) -> int:
    """Truncate the file after its last complete message. Returns the new size [bytes]."""
    end = end_of_whole_messages(path)
    if end < os.path.getsize(path):
        os.truncate(path, end)
    return end


@contextlib.contextmanager
def complete_file(path: str | os.PathLike[str]) -> Iterator[pathlib.Path]:
    """The file if it is complete, otherwise a temporary copy of its complete messages.

    It is a copy because an incomplete file may still be growing. `ValueError` if there is no regular file.
    """
    path = pathlib.Path(path)
    InputFile(path).close()
    if is_complete(path):
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / path.name
        left = end_of_whole_messages(path)
        with path.open("rb") as source, copy.open("wb") as target:
            while block := source.read(min(left, BLOCK)):
                left -= target.write(block)
        yield copy
