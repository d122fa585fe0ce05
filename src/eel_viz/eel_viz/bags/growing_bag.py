# SPDX-License-Identifier: Apache-2.0
"""Writes a rosbag2 folder in MCAP storage that can be opened at all times, not only once it is closed.

rosbags' writer writes the index, the end of the file and metadata.yaml when it is closed; before, there is no bag. Here
`save` writes them whenever it is called: the new messages and a new end overwrite the old end in one write. So a
recorder that is killed leaves a complete bag of all saved messages. If the disk is full, the old end is restored. (A
process killed within that write leaves a file without its end; `damaged_mcap` reads it.) Chunks, data and index have
their checksums.
"""

import os
import pathlib
import struct
from io import BytesIO
from typing import Any, Literal
from zlib import crc32

from eel_base.wording import shown
from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
from rosbags.rosbag2.enums import CompressionMode
from rosbags.rosbag2.storage_mcap import McapWriter

from eel_viz.bags.mcap_checksums import CHUNK_CHECKSUM, with_checksums

VERSION: Literal[9] = 9  # of metadata.yaml, as ROS 2 Jazzy writes it


class GrowingFile(McapWriter):
    """rosbags' writer of one MCAP file that writes to memory; each call of `close` writes the memory to the file."""

    def __init__(self, path: pathlib.Path, compression: CompressionMode) -> None:
        super().__init__(path, compression)
        self._file = self.bio
        self._kept = self._file.tell()  # bytes of the file that no `close` touches again
        self._end = b""  # the file's end, behind them
        self._file.flush()
        self._checksum = crc32(self.path.read_bytes())  # of the bytes that are kept
        self.bio: Any = _PendingData(self._kept)

    def close_chunk(self) -> None:
        """Complete the chunk, with its checksum."""
        place, checksum = self.bio.tell() + CHUNK_CHECKSUM, crc32(self.chunk.bio.getbuffer())
        super().close_chunk()
        self.bio.replace(place, struct.pack("<I", checksum))

    def close(self, version: int, metadata: str) -> None:
        """Complete the file. `OSError` if there is no room: the file then is as after the last call."""
        if self.chunk.bio.tell():
            self.close_chunk()
        kept = self.bio.tell()
        super().close(version, metadata)
        data = with_checksums(self.bio.getvalue(), self._kept, self._checksum)
        try:
            self._write(data)
        except OSError:
            self._write(self._end)
            os.ftruncate(self._file.fileno(), self._kept + len(self._end))
            raise
        done = kept - self._kept
        self._checksum, self._end = crc32(data[:done], self._checksum), data[done:]
        self._kept = kept
        self.bio = _PendingData(kept)

    def abort(self) -> None:
        """Close the file descriptor; the file stays as it is."""
        self._file.close()

    def _write(self, data: bytes) -> None:
        place, view = self._kept, memoryview(data)
        while view:
            done = os.pwrite(self._file.fileno(), view, place)
            place, view = place + done, view[done:]


class GrowingBag(Writer):
    """`rosbags.rosbag2.Writer` with `save`; `ValueError` if the folder exists or cannot be made."""

    STORAGE_PLUGINS: Any = {StoragePlugin.MCAP: GrowingFile}  # noqa: RUF012  as rosbags' own

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        try:
            super().__init__(pathlib.Path(folder), version=VERSION, storage_plugin=StoragePlugin.MCAP)
            self.open()
            self.save()
        except (WriterError, OSError) as error:
            reason = error.strerror if isinstance(error, OSError) and error.strerror else error
            raise ValueError(f"bag {shown(str(folder))} cannot be made: {reason}") from error

    def save(self) -> None:
        """Make the folder a complete bag of all messages so far. `OSError` if there is no room: it is unchanged."""
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


class _PendingData:
    """The data after the first `place` bytes of a file, in memory, with the interface of a file."""

    def __init__(self, place: int) -> None:
        self._place, self._data = place, BytesIO()

    def tell(self) -> int:
        return self._place + self._data.tell()

    def write(self, data: bytes) -> int:
        return self._data.write(data)

    def replace(self, place: int, data: bytes) -> None:
        """Put `data` to the byte `place` of the file."""
        start = place - self._place
        self._data.getbuffer()[start : start + len(data)] = data

    def getvalue(self) -> bytes:
        return self._data.getvalue()

    def close(self) -> None:
        """Do nothing: there is no file yet."""
