"""The frames of an .rrd file: one that was cut off in the middle of a message is whole up to the message before.

A file begins with 12 bytes; each message is its kind and its length (two little-endian 64-bit numbers) and so many
bytes; a file that was completed ends with a footer beyond the last one (Rerun 0.41, `re_log_encoding`).
"""

import contextlib
import os
import pathlib
import shutil
import struct
import tempfile
from collections.abc import Iterator

HEAD, FRAME = 12, struct.Struct("<QQ")  # bytes
FOOTER, FOOTER_PLACE = b"RRF2FOOT", 12  # and how many bytes before the end it begins


def is_complete(path: str | os.PathLike[str]) -> bool:
    """Whether the file ends with a footer: nothing comes after it."""
    with open(path, "rb") as file:
        file.seek(max(0, os.path.getsize(path) - FOOTER_PLACE))
        return file.read(len(FOOTER)) == FOOTER


def end_of_whole_messages(path: str | os.PathLike[str]) -> int:
    """Where the last message that is there completely ends [bytes]."""
    size = os.path.getsize(path)
    if is_complete(path):
        return size
    with open(path, "rb") as file:
        end = min(HEAD, size)
        while end + FRAME.size <= size:
            file.seek(end)
            _, length = FRAME.unpack(file.read(FRAME.size))
            if end + FRAME.size + length > size:
                break
            end += FRAME.size + length
    return end


def cut_to_whole_messages(path: str | os.PathLike[str]) -> int:
    """Take a message that was written in part off the file's end; returns the size that is left [bytes]."""
    end = end_of_whole_messages(path)
    if end < os.path.getsize(path):
        os.truncate(path, end)
    return end


@contextlib.contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[pathlib.Path]:
    """The file if it was completed, else a copy of its whole messages, for as long as the context lasts.

    What was not completed may still be growing: its last message, whole a moment ago, has one behind it that is not.
    """
    path = pathlib.Path(path)
    if is_complete(path):
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / path.name
        shutil.copy(path, copy)
        cut_to_whole_messages(copy)
        yield copy
