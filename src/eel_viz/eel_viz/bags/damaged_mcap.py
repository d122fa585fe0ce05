# SPDX-License-Identifier: Apache-2.0
"""Reads an MCAP file whose end is missing: record by record, up to the damage.

The interface is that of rosbags' `Reader`; messages come in the order in which they were written.
"""

import pathlib
from collections.abc import Iterator

from mcap.records import Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinition, MessageDefinitionFormat

from eel_viz.bags.chunk_sizes import check_chunk
from eel_viz.bags.mcap_checksums import DAMAGE_ERRORS

FORMATS = {"ros2msg": MessageDefinitionFormat.MSG, "ros2idl": MessageDefinitionFormat.IDL}


class DamagedMcapReader:
    """Reads the file at `path` up to the damage; `connections` are set on entering the context."""

    def __init__(self, path: pathlib.Path) -> None:
        self._path = path
        self.connections: list[Connection] = []

    def __enter__(self) -> "DamagedMcapReader":
        schemas: dict[int, Schema] = {}
        found: dict[int, Connection] = {}
        for record in self._records():
            if isinstance(record, Schema):
                schemas.setdefault(record.id, record)  # the index has them again, and its checksum is not known here
            elif isinstance(record, Channel) and record.schema_id in schemas:
                found.setdefault(record.id, self._connection(record, schemas[record.schema_id]))
        self.connections = list(found.values())
        return self

    def __exit__(self, *_) -> None:
        self.connections = []

    def messages(self, connections: list[Connection]) -> Iterator[tuple[Connection, int, bytes]]:
        """Yield connection, time of reception [ns] and bytes of each message."""
        wanted = {connection.id: connection for connection in connections}
        for record in self._records():
            if isinstance(record, Message) and record.channel_id in wanted:
                yield wanted[record.channel_id], record.log_time, record.data

    def _connection(self, channel: Channel, schema: Schema) -> Connection:
        text = schema.data.decode(errors="replace")
        form = FORMATS.get(schema.encoding, MessageDefinitionFormat.NONE)
        about = ConnectionExtRosbag2(channel.message_encoding, [])
        return Connection(channel.id, channel.topic, schema.name, MessageDefinition(form, text), "", 0, about, self)

    def _records(self) -> Iterator[McapRecord]:
        with self._path.open("rb") as file:
            size = self._path.stat().st_size
            records = StreamReader(file, emit_chunks=True, validate_crcs=True, record_size_limit=size).records
            while True:
                try:
                    record = next(records)
                    inner = _records_of(record) if isinstance(record, Chunk) else [record]
                except (StopIteration, *DAMAGE_ERRORS):
                    return
                yield from inner


def _records_of(chunk: Chunk) -> list[McapRecord]:
    check_chunk(chunk.compression, chunk.uncompressed_size, chunk.data)
    return breakup_chunk(chunk, validate_crc=True)
