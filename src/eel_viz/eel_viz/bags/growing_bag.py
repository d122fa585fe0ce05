"""A rosbag2 folder in MCAP storage that is whole at all times, not only once it is closed.

rosbags' writer brings out the index, the end of the file and metadata.yaml when it closes; until then there is no bag.
Here `save` does so whenever it is called: what has come since is written over the end of the file, and with it a new
end, in one go. So a recorder that is killed leaves a bag with all that was saved, which opens everywhere; and if the
disk is full, the end that was there before is put back. (Killed within that one write, a moment in each second, the
file lacks its end; `remains` reads it.)
"""

import os
import pathlib
from io import BytesIO
from typing import ClassVar

from eel_gaits.wording import shown
from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
from rosbags.rosbag2.enums import CompressionMode
from rosbags.rosbag2.storage_mcap import McapWriter

VERSION = 9  # of metadata.yaml, as ROS 2 Jazzy writes it


class GrowingFile(McapWriter):
    """rosbags' writer of one MCAP file, writing to memory; `close` brings that out, as often as it is called."""

    def __init__(self, path: pathlib.Path, compression: CompressionMode) -> None:
        super().__init__(path, compression)
        self._file = self.bio
        self._kept = self._file.tell()  # bytes of the file that no `close` touches again
        self._end = b""  # the file's end, behind them
        self._file.flush()
        self.bio = _Waiting(self._kept)

    def close(self, version: int, metadata: str) -> None:
        """Complete the file. `OSError` if there is no room: the file is as after the last time, and stays so."""
        if self.chunk.bio.tell():
            self.close_chunk()
        kept = self.bio.tell()
        super().close(version, metadata)
        data = self.bio.getvalue()
        try:
            self._write(data)
        except OSError:
            self._write(self._end)
            os.ftruncate(self._file.fileno(), self._kept + len(self._end))
            raise
        self._end = data[kept - self._kept :]
        self._kept = kept
        self.bio = _Waiting(kept)

    def abort(self) -> None:
        """Let go of the file as it is."""
        self._file.close()

    def _write(self, data: bytes) -> None:
        place, view = self._kept, memoryview(data)
        while view:
            done = os.pwrite(self._file.fileno(), view, place)
            place, view = place + done, view[done:]


class GrowingBag(Writer):
    """`rosbags.rosbag2.Writer` with `save`; `ValueError` if the folder is there already or cannot be made."""

    STORAGE_PLUGINS: ClassVar = {StoragePlugin.MCAP: GrowingFile}

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        try:
            super().__init__(pathlib.Path(folder), version=VERSION, storage_plugin=StoragePlugin.MCAP)
            self.open()
            self.save()
        except (WriterError, OSError) as error:
            reason = error.strerror if isinstance(error, OSError) and error.strerror else error
            raise ValueError(f"bag {shown(str(folder))} cannot be made: {reason}") from error

    def save(self) -> None:
        """Make the folder a whole bag of all messages so far. `OSError` if there is no room: it is what it was."""
        storage = self.storage
        try:
            super().close()
        except OSError:
            self.metapath.with_suffix(".yaml.tmp").unlink(missing_ok=True)
            raise
        finally:
            self.storage = storage

    def close(self) -> None:
        """`save`, and let go of the file."""
        try:
            self.save()
        finally:
            self.abort()


class _Waiting:
    """What is to follow the first `place` bytes of a file; as a file from outside."""

    def __init__(self, place: int) -> None:
        self._place, self._data = place, BytesIO()

    def tell(self) -> int:
        return self._place + self._data.tell()

    def write(self, data: bytes) -> int:
        return self._data.write(data)

    def getvalue(self) -> bytes:
        return self._data.getvalue()

    def close(self) -> None:
        """Nothing: there is no file yet."""
