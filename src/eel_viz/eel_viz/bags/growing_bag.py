# SPDX-License-Identifier: Apache-2.0
"""Writes a rosbag2 folder in MCAP storage that can be opened at all times, not only once it is closed.

The index, the end of the file and metadata.yaml are usually written when a bag is closed; until then the bag cannot be
opened. Here `save` writes them at any time: the new messages and a new end overwrite the old end in one write. So a
recorder that is killed leaves a complete bag of all saved messages. If the disk is full, the old end is restored. (A
process killed during that write leaves a file without its end; `mcap recover` repairs it.) Chunks, data and index have
checksums.
"""

import copy
import os
import pathlib
from typing import IO, Any, Literal, cast

import mcap.writer
from eel_common.files.output_file import beside
from eel_common.version import software
from eel_common.wording import shown
from rosbags.interfaces import Connection
from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
from rosbags.rosbag2.enums import CompressionMode

VERSION: Literal[9] = 9  # of metadata.yaml, as ROS 2 Jazzy writes it


class PendingBytes:
    """The bytes after the first `start` bytes of a file, with the file interface that mcap's writer needs."""

    def __init__(self) -> None:
        self.start = 0
        self.data = bytearray()

    def tell(self) -> int:
        return self.start + len(self.data)

    def write(self, data: bytes) -> int:
        self.data += data
        return len(data)

    def flush(self) -> None:
        """Do nothing: `GrowingFile` writes."""


class GrowingFile:
    """rosbags' storage of one MCAP file. Each call of `close` completes the file, and more may follow."""

    def __init__(self, path: pathlib.Path, compression: CompressionMode) -> None:
        self.path = beside(path / f"{path.name}.mcap", "")
        self._file = self.path.open("xb", buffering=0)
        self._pending = PendingBytes()
        self._end = b""  # the file's end, after the bytes that are final
        self._schemas: dict[str, int] = {}
        self._channels: dict[int, int] = {}
        self._writer = mcap.writer.Writer(
            cast(IO[bytes], self._pending),
            compression=mcap.writer.CompressionType.NONE,
            use_summary_offsets=False,  # its list would grow with each end
            enable_data_crcs=True,
        )
        self._writer.start("ros2")

    def add_msgtype(self, connection: Connection) -> None:
        text = connection.msgdef.data.encode()
        self._schemas[connection.msgtype] = self._writer.register_schema(connection.msgtype, "ros2msg", text)

    def add_connection(self, connection: Connection, offered_qos_profiles: str) -> None:
        about = {"offered_qos_profiles": offered_qos_profiles, "topic_type_hash": connection.digest}
        schema = self._schemas[connection.msgtype]
        self._channels[connection.id] = self._writer.register_channel(connection.topic, "cdr", schema, about)

    def write(self, connection: Connection, timestamp: int, data: bytes | memoryview) -> None:
        """Add a message, received at `timestamp` [ns]."""
        self._writer.add_message(self._channels[connection.id], timestamp, bytes(data), timestamp)

    def close(self, version: int, metadata: str) -> None:
        """Complete the file. `OSError` if the disk is full; the file is then as after the last call."""
        self._writer.flush()
        done = len(self._pending.data)
        copy.copy(self._writer).finish()  # only the copy's data checksum includes the end
        try:
            self._write(self._pending.data)
        except OSError:
            self._write(self._end)
            os.ftruncate(self._file.fileno(), self._pending.start + len(self._end))
            raise
        self._end = bytes(self._pending.data[done:])
        self._pending.start += done
        self._pending.data.clear()

    def abort(self) -> None:
        """Close the file descriptor. The file stays as it is."""
        self._file.close()

    def _write(self, data: bytes | bytearray) -> None:
        place, view = self._pending.start, memoryview(bytes(data))
        while view:
            done = os.pwrite(self._file.fileno(), view, place)
            place, view = place + done, view[done:]


class GrowingBag(Writer):
    """`rosbags.rosbag2.Writer` with `save`; `ValueError` if the folder exists or cannot be made."""

    STORAGE_PLUGINS: Any = {StoragePlugin.MCAP: GrowingFile}  # noqa: RUF012  as rosbags' own

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        try:
            super().__init__(pathlib.Path(folder), version=VERSION, storage_plugin=StoragePlugin.MCAP)
            self.set_custom_data("software", software())
            self.open()
            self.save()
        except (WriterError, OSError) as error:
            reason = error.strerror if isinstance(error, OSError) and error.strerror else error
            raise ValueError(f"bag {shown(str(folder))} cannot be made: {reason}") from error

    def save(self) -> None:
        """Complete the bag with all messages so far. `OSError` if the disk is full; the bag is then unchanged."""
        storage = self.storage
        try:
            super().close()
        except OSError:
            self.metapath.with_suffix(".yaml.tmp").unlink(missing_ok=True)
            raise
        finally:
            self.storage = storage

    def close(self) -> None:
        """Save the bag and close its file."""
        try:
            self.save()
        finally:
            self.abort()
