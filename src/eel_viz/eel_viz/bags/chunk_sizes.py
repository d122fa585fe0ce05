# SPDX-License-Identifier: Apache-2.0
"""Bounds what the chunks of an MCAP file become when they are inflated. The libraries that read them have no bound."""

import os
import pathlib
import struct

import lz4.frame
import zstandard

MOST_BYTES = 64_000_000  # of an inflated chunk; writers take 1 to 4 MB, or one message
CHUNK, HEAD = 0x06, struct.Struct("<BQ")  # a record's code and length
ABOUT = struct.Struct("<16xQ4xI")  # of a chunk: its inflated size, and the length of its compression's name


def check_chunk(compression: str, size: int, data: bytes) -> None:
    """`ValueError` where a chunk of an inflated `size` has more than `MOST_BYTES`, or is not of that size."""
    if size > MOST_BYTES:
        raise ValueError(f"a chunk must have at most {MOST_BYTES} bytes when inflated, got {size}")
    try:
        told = _size_of_frame(compression, data)
    except (zstandard.ZstdError, RuntimeError):  # no frame at all: nothing is inflated
        return
    if told is None and compression == "zstd":
        told = len(zstandard.ZstdDecompressor().decompress(data, MOST_BYTES))
    elif told is None:
        told = len(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=MOST_BYTES + 1))
    if told != size:
        raise ValueError(f"a chunk must have {size} bytes when inflated, got {told}")


def _size_of_frame(compression: str, data: bytes) -> int | None:
    """The inflated size that the frame tells; None if it tells none."""
    if compression == "zstd":
        told = zstandard.frame_content_size(data)
        return told if told >= 0 else None
    if compression == "lz4":
        return lz4.frame.get_frame_info(data)["content_size"] or None
    return len(data)


def check_chunks(path: pathlib.Path) -> None:
    """As `check_chunk`, of all chunks in the file."""
    with path.open("rb") as file:
        size, place = os.fstat(file.fileno()).st_size, 8
        while place + HEAD.size <= size:
            file.seek(place)
            code, length = HEAD.unpack(file.read(HEAD.size))
            place += HEAD.size + length
            if code == CHUNK and place <= size:
                record = file.read(length)
                inflated, name = ABOUT.unpack_from(record)
                compression = record[ABOUT.size : ABOUT.size + name].decode()
                check_chunk(compression, inflated, record[ABOUT.size + name + 8 :])
