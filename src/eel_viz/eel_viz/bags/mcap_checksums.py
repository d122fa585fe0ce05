# SPDX-License-Identifier: Apache-2.0
"""The checksums of an MCAP file (CRC-32): of each chunk, of the data, and of the index behind them.

A checksum of 0 means that there is none. Rosbags writes none, and reads those of chunks alone.
"""

import os
import pathlib
import struct
from zlib import crc32

import zstandard
from mcap.exceptions import McapError
from mcap.records import Chunk
from mcap.stream_reader import StreamReader, get_chunk_data_stream

DAMAGE_ERRORS = (
    McapError,
    struct.error,
    zstandard.ZstdError,
    ValueError,
    RuntimeError,
    OSError,
)  # lz4 raises RuntimeError
CHUNK_CHECKSUM = 9 + 24  # bytes from the beginning of a chunk's record to its checksum
FOOTER = 37  # bytes: code, length 8, start of the index 8, of its offsets 8, checksum 4, magic 8
DATA_END = 13  # bytes: code, length 8, checksum 4; the record before the index
BLOCK = 2**20  # bytes read at once


def with_checksums(end: bytes, place: int, before: int) -> bytes:
    """The `end` of a file, all from byte `place` on, with checksums of data and index. before: that of the rest."""
    (start,) = struct.unpack_from("<Q", end, len(end) - 28)
    index, made = start - place, bytearray(end)
    struct.pack_into("<I", made, index - 4, crc32(end[: index - DATA_END], before))
    struct.pack_into("<I", made, len(end) - 12, crc32(end[index:-12]))
    return bytes(made)


def check_index(path: pathlib.Path) -> None:
    """`ValueError` where the index of the file does not fit its checksum."""
    with path.open("rb") as file:
        start, expected = _footer(file)
        file.seek(start)
        if expected and crc32(file.read()[:-12]) != expected:
            raise ValueError(f"{path.name}: the index, from byte {start} on, does not fit its checksum")


def damage_of_data(path: pathlib.Path) -> str:
    """What does not fit the checksums of the data, and where; empty if all does, or if there are none."""
    with path.open("rb") as file:
        end = _footer(file)[0] - DATA_END
        file.seek(max(end, 0))
        code, length, expected = struct.unpack("<BQI", file.read(DATA_END))
        if (code, length) != (0x0F, 4):
            return f"{path.name}: the end of the data is not at byte {end}"
        file.seek(0)
        found, left = 0, end
        while expected and left:
            block = file.read(min(left, BLOCK))
            found, left = crc32(block, found), left - len(block)
        if found == expected:
            return ""
        file.seek(0)
        return f"{path.name}: the data, {_place(file)}, do not fit their checksum"


def _footer(file) -> tuple[int, int]:
    """The place of the index, and its checksum."""
    file.seek(-FOOTER, os.SEEK_END)
    return struct.unpack_from("<Q8xI", file.read(FOOTER), 9)


def _place(file) -> str:
    """Where the first record stands that cannot be read, or the first chunk that does not fit its checksum."""
    place = 0
    try:
        for record in StreamReader(file, emit_chunks=True, record_size_limit=os.fstat(file.fileno()).st_size).records:
            if isinstance(record, Chunk):
                get_chunk_data_stream(record, validate_crc=True)
            place = file.tell()
    except DAMAGE_ERRORS:
        return f"from byte {place} on"
    return "between the chunks"
