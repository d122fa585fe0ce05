# SPDX-License-Identifier: Apache-2.0
"""Checks of a bag's files before rosbags reads them: checksums (CRC-32), and bounds on inflated sizes.

rosbags reads an MCAP file by the index at its end, without a bound on the inflated size of a chunk. Its parser of
metadata.yaml has no bounds either.
"""

import pathlib
import struct
from typing import Any
from zlib import crc32

import lz4.frame
import zstandard
from eel_common.files.input_file import reading
from eel_common.files.yaml_tree import MOST_BYTES, from_yaml, read_yaml
from eel_common.quantity import checked_instance
from eel_common.wording import shown
from mcap.exceptions import McapError
from mcap.records import Chunk, Footer
from mcap.stream_reader import StreamReader, get_chunk_data_stream

MAGIC = b"\x89MCAP0\r\n"  # first bytes of an MCAP file
MOST_CHUNK_BYTES = 64_000_000  # of an inflated chunk; writers take 1 to 4 MB, or one message
METADATA, ABOUT = "metadata.yaml", "rosbag2_bagfile_information"
NEEDED = "topics_with_message_count", "relative_file_paths"
MOST_VALUES = 10_000  # in metadata.yaml; a publisher takes 20, a file 10
AFTER_CHECKSUM = 12  # bytes at a file's end from the checksum of its index on: the checksum, and the last magic bytes
# Exceptions of mcap's reader for damaged files; lz4 raises RuntimeError.
DAMAGE_ERRORS = (McapError, struct.error, zstandard.ZstdError, ValueError, RuntimeError, OSError)


def check_mcap(path: pathlib.Path) -> None:
    """`ValueError` with the place if the file is damaged or unfinished, or a chunk too large."""
    place, size = 0, path.stat().st_size
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{path.name} is {'no MCAP file' if size else 'empty'}")
        file.seek(0)
        try:
            for record in StreamReader(file, emit_chunks=True, validate_crcs=True, record_size_limit=size).records:
                if isinstance(record, Chunk):
                    check_chunk(record)
                    get_chunk_data_stream(record, validate_crc=True)
                elif isinstance(record, Footer):
                    back = file.tell()
                    file.seek(record.summary_start)
                    if (
                        record.summary_start
                        and record.summary_crc
                        and crc32(file.read()[:-AFTER_CHECKSUM]) != record.summary_crc
                    ):
                        raise ValueError("the index does not fit its checksum")
                    file.seek(back)
                place = file.tell()
        except DAMAGE_ERRORS as error:
            reason = str(error) or "it is incomplete"
            raise ValueError(f"{path.name}, from byte {place} on: {reason} (`mcap recover` repairs it)") from error


def inflated(frame: bytes) -> bytes:
    """The content of a zstd frame. `ValueError` for more than `MOST_CHUNK_BYTES`."""
    if (size := zstandard.frame_content_size(frame)) > MOST_CHUNK_BYTES:
        raise ValueError(f"a message must have at most {MOST_CHUNK_BYTES} bytes when inflated, got {size}")
    return zstandard.ZstdDecompressor().decompress(frame, MOST_CHUNK_BYTES)  # bounded even if the frame states no size


def check_chunk(chunk: Chunk) -> None:
    """`ValueError` if a chunk inflates to more than `MOST_CHUNK_BYTES`, or not to its stated size."""
    size = chunk.uncompressed_size
    if size > MOST_CHUNK_BYTES:
        raise ValueError(f"a chunk must have at most {MOST_CHUNK_BYTES} bytes when inflated, got {size}")
    if chunk.compression == "zstd":
        try:
            found = zstandard.frame_content_size(chunk.data)
        except zstandard.ZstdError:  # no frame at all: nothing is inflated
            return
        if found < 0:  # the frame states no size
            found = len(inflated(chunk.data))
    elif chunk.compression == "lz4":
        try:
            found = lz4.frame.get_frame_info(chunk.data)["content_size"]
        except RuntimeError:  # as above
            return
        if not found:
            unpacked = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=MOST_CHUNK_BYTES + 1)
            found = len(unpacked)
    else:
        found = len(chunk.data)
    if found != size:
        raise ValueError(f"a chunk must have {size} bytes when inflated, got {found}")


def check_metadata(folder: pathlib.Path) -> None:
    """`ValueError` if metadata.yaml is too large, or names anything but a regular file in the folder."""
    with reading(f"{METADATA} (`ros2 bag reindex` makes it anew)"):
        tree = checked_instance("its content", read_yaml(folder / METADATA), dict)
        about = checked_instance(ABOUT, tree.get(ABOUT), dict)
        if missing := [key for key in NEEDED if key not in about]:
            raise ValueError(f"it must have {missing[0]}")
        profiles = [topic["topic_metadata"].get("offered_qos_profiles") for topic in about["topics_with_message_count"]]
        texts = [each for each in profiles if isinstance(each, str)]  # YAML texts, before ROS 2 Jazzy
        if (size := sum(map(len, texts))) > MOST_BYTES:
            raise ValueError(f"its profiles must have at most {MOST_BYTES} characters, got {size}")
        left = MOST_VALUES - _count(tree)
        for text in texts:
            left -= _count(from_yaml(text, left))
        if left < 0:
            raise ValueError(f"it must have at most {MOST_VALUES} values")
        names = [pathlib.PurePath(name).name for name in about["relative_file_paths"]]
        if len(set(names)) < len(names) or not isinstance(about.get("files", []), list):
            raise ValueError("it must list files, each with a name of its own")
        for name in names:
            if not (folder / name).is_file():
                raise ValueError(f"it names {shown(name)}, which is no file beside it")


def _count(tree: Any) -> int:
    """The number of values in a tree of mappings and lists."""
    inner = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    return 1 + sum(map(_count, inner))
