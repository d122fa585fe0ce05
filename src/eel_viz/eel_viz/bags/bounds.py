# SPDX-License-Identifier: Apache-2.0
"""Files of bags that nobody vouches for: their checksums (CRC-32), the bounds on what they hold, their readable part.

rosbags reads an MCAP file by the index at its end, without a bound on what a chunk inflates to. So `damage_of` goes
through each file before, record by record. What it finds damaged is read by `RecordReader`, as far as it goes. Nor has
rosbags' parser of metadata.yaml bounds.
"""

import os
import pathlib
import struct
from collections.abc import Iterator
from typing import Any, BinaryIO, Self
from zlib import crc32

import lz4.frame
import zstandard
from eel_base.files.input_file import InputFile, reading
from eel_base.files.yaml_tree import MOST_BYTES, from_yaml, read_yaml
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, DataEnd, Footer, McapRecord, Message, Schema
from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk, get_chunk_data_stream
from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinition, MessageDefinitionFormat

MOST_CHUNK_BYTES = 64_000_000  # of an inflated chunk; writers take 1 to 4 MB, or one message
METADATA = "metadata.yaml"
MOST_VALUES = 10_000  # of it; a publisher takes 20, a file 10
AFTER_CHECKSUM = 12  # bytes of a file behind the checksum of its index: the checksum itself, and the last magic bytes
# What mcap's reader raises on damaged files; lz4 raises RuntimeError.
DAMAGE_ERRORS = (McapError, struct.error, zstandard.ZstdError, ValueError, RuntimeError, OSError)
FORMATS = {"ros2msg": MessageDefinitionFormat.MSG, "ros2idl": MessageDefinitionFormat.IDL}


def damage_of(path: pathlib.Path) -> str:
    """The first damage in the data of the file, and its place. Empty if there is none.

    `ValueError` where a record cannot be read, a chunk is too large, or the index does not fit its checksum: rosbags
    must not read such a file.
    """
    place, damage = 0, ""
    with path.open("rb") as file:
        try:
            for record in _records(file):
                if isinstance(record, Chunk):
                    damage = damage or _damage_of_chunk(record, place)
                elif isinstance(record, Footer):
                    _check_index(file, record)
                place = file.tell()
        except DAMAGE_ERRORS as error:
            if not isinstance(getattr(error, "record", None), DataEnd):
                reason = str(error) or "it is incomplete"
                raise ValueError(f"{path.name}, from byte {place} on: {reason}") from error
            damage = damage or "the data, between the chunks, do not fit their checksum"
            for record in StreamReader(file, skip_magic=True).records:  # goes on behind the data
                if isinstance(record, Footer):
                    _check_index(file, record)
    return damage and f"{path.name}: {damage}"


def _damage_of_chunk(chunk: Chunk, place: int) -> str:
    try:
        get_chunk_data_stream(chunk, validate_crc=True)
    except (CRCValidationError, zstandard.ZstdError, RuntimeError) as error:
        return f"the data, from byte {place} on, do not fit: {error}"
    return ""


def _check_index(file: BinaryIO, footer: Footer) -> None:
    back = file.tell()
    file.seek(footer.summary_start)
    if footer.summary_crc and crc32(file.read()[:-AFTER_CHECKSUM]) != footer.summary_crc:
        raise ValueError(f"the index, from byte {footer.summary_start} on, does not fit its checksum")
    file.seek(back)


def check_chunk(chunk: Chunk) -> None:
    """`ValueError` where a chunk inflates to more than `MOST_CHUNK_BYTES`, or not to the size that it states."""
    size = chunk.uncompressed_size
    if size > MOST_CHUNK_BYTES:
        raise ValueError(f"a chunk must have at most {MOST_CHUNK_BYTES} bytes when inflated, got {size}")
    if chunk.compression == "zstd":
        try:
            found = zstandard.frame_content_size(chunk.data)
        except zstandard.ZstdError:  # no frame at all: nothing is inflated
            return
        if found < 0:  # the frame does not state it
            found = len(zstandard.ZstdDecompressor().decompress(chunk.data, MOST_CHUNK_BYTES))
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


class RecordReader:
    """Reads the file at `path` up to its damage, in the order in which it was written, as rosbags' `Reader` does.

    `connections` are set on entering the context.
    """

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        self.connections: list[Connection] = []

    def __enter__(self) -> Self:
        schemas: dict[int, Schema] = {}
        found: dict[int, Connection] = {}
        for record in self._readable():
            if isinstance(record, Schema):
                schemas.setdefault(record.id, record)  # the index has them again, and its checksum is not known here
            elif isinstance(record, Channel) and record.schema_id in schemas:
                found.setdefault(record.id, self._connection(record, schemas[record.schema_id]))
        self.connections = list(found.values())
        return self

    def __exit__(self, *_: object) -> None:
        self.connections = []

    def messages(self, connections: list[Connection]) -> Iterator[tuple[Connection, int, bytes]]:
        """Yield connection, time of reception [ns] and bytes of each message."""
        wanted = {connection.id: connection for connection in connections}
        for record in self._readable():
            if isinstance(record, Message) and record.channel_id in wanted:
                yield wanted[record.channel_id], record.log_time, record.data

    def _connection(self, channel: Channel, schema: Schema) -> Connection:
        text = schema.data.decode(errors="replace")
        form = FORMATS.get(schema.encoding, MessageDefinitionFormat.NONE)
        about = ConnectionExtRosbag2(channel.message_encoding, [])
        return Connection(channel.id, channel.topic, schema.name, MessageDefinition(form, text), "", 0, about, self)

    def _readable(self) -> Iterator[McapRecord]:
        """The records before the damage, with those in chunks."""
        with self._path.open("rb") as file:
            records = _records(file)
            while True:
                try:
                    record = next(records)
                    inner = breakup_chunk(record, validate_crc=True) if isinstance(record, Chunk) else [record]
                except (StopIteration, *DAMAGE_ERRORS):
                    return
                yield from inner


def _records(file: BinaryIO) -> Iterator[McapRecord]:
    """All records of the file. An error of `DAMAGE_ERRORS` at the first that does not fit, or a chunk that does not."""
    size = os.fstat(file.fileno()).st_size
    for record in StreamReader(file, emit_chunks=True, validate_crcs=True, record_size_limit=size).records:
        if isinstance(record, Chunk):
            check_chunk(record)
        yield record


def check_metadata(folder: pathlib.Path) -> None:
    """`ValueError` where metadata.yaml has too much, or names what is no regular file in the folder."""
    with reading(METADATA):
        tree = read_yaml(folder / METADATA)
        about = tree["rosbag2_bagfile_information"]
        profiles = [topic["topic_metadata"].get("offered_qos_profiles") for topic in about["topics_with_message_count"]]
        texts = [each for each in profiles if isinstance(each, str)]  # of YAML, before ROS 2 Jazzy
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
            InputFile(folder / name).close()


def _count(tree: Any) -> int:
    """The number of values in a tree of mappings and lists."""
    inner = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    return 1 + sum(map(_count, inner))
