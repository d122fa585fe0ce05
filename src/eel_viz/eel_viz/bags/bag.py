# SPDX-License-Identifier: Apache-2.0
"""Reads a rosbag2 folder, or one of its files, without ROS: MCAP or sqlite3, split or not, compressed or not.

A damaged, unfinished or packed bag is refused, with the name of the tool that repairs it. A folder without
metadata.yaml is read if it has a single file. Types are those that the bag defines; a bag without definitions (sqlite3
before Iron) needs the message packages installed. The inflated size of metadata.yaml and chunks is bounded.
"""

import contextlib
import os
import pathlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Self

import zstandard
from eel_common.files.input_file import InputFile, reading
from eel_common.wording import one_line, shown
from rosbags.interfaces import Connection, MessageDefinitionFormat
from rosbags.rosbag2 import Reader
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, TypesysError, get_types_from_idl, get_types_from_msg, get_typestore

from eel_viz.bags.bounds import METADATA, check_mcap, check_metadata, inflated

SUFFIXES = (".mcap", ".db3")
JOURNALS = ".db3-wal", ".db3-journal"  # of sqlite: data that a killed recorder has not moved into its file
PACKED = {".zstd": "zstd -d", ".zst": "zstd -d", ".lz4": "lz4 -d", ".gz": "gzip -d", ".bz2": "bzip2 -d", ".xz": "xz -d"}
PADDED = "sensor_msgs/msg/JointState", "eel_msgs/msg/MotorStates"  # their last fields are sequences of doubles
PADDING = 8, 12, 16  # bytes that ROS may leave after one or several empty sequences of this kind


@dataclass(frozen=True, kw_only=True)
class Topic:
    """A topic of a bag: its `type`, the type's definition ("" if the bag has none), and the number of publishers."""

    type: str
    definition: str
    idl: bool = False
    publishers: int = 1


class Bag:
    """A bag, open for reading. `topics`: by name. `ValueError` in one line if it cannot be read."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._path = pathlib.Path(path)
        self._stack = contextlib.ExitStack()
        self._store = get_typestore(Stores.EMPTY)
        self.topics: dict[str, Topic] = {}
        with reading(f"bag {shown(str(path))}"):
            if not self._path.exists():
                raise ValueError(f"bag {shown(str(path))} does not exist")
            if not self._path.is_dir():
                InputFile(self._path).close()
        try:
            self._reader = self._opened()
            self.topics = self._topics()
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._stack.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def messages(
        self, *topics: str, unreadable: Callable[[str, str], None] = lambda topic, why: None
    ) -> Iterator[tuple[str, int, object]]:
        """Yield topic, time of reception [ns] and message of all messages of `topics`, in the order of reception.

        `unreadable(topic, why)` is called for each message whose bytes do not fit its type. `ValueError` for an unknown
        type, and for a damaged bag.
        """
        for name in topics:
            self._learn(self.topics[name])
        chosen = [connection for connection in self._reader.connections if connection.topic in topics]
        records = self._reader.messages(chosen) if chosen else iter(())
        while True:
            try:
                connection, stamp, raw = next(records)
            except StopIteration:
                return
            except Exception as error:
                raise ValueError(f"bag {shown(str(self._path))} is damaged: {_line(error)}") from error
            try:
                if bytes(raw[:4]) == zstandard.FRAME_HEADER:  # without metadata.yaml there is no other sign of it
                    raw = inflated(raw)
                message = self._deserialised(raw, connection.msgtype)
            except Exception as error:  # rosbags' own, struct.error, ValueError of numpy or of text
                unreadable(connection.topic, _line(error))
                continue
            yield connection.topic, stamp, message

    def has_field(self, topic: str, kind: str, field: str) -> bool:
        """Whether messages of type `kind`, of a `topic` or within its messages, have a `field` in this bag."""
        self._learn(self.topics[topic])
        return any(name == field for name, _ in self._store.fielddefs.get(kind, ((), ()))[1])

    def _deserialised(self, raw: Any, kind: str) -> object:
        """The message. Empty sequences of doubles at its end may be followed by some bytes."""
        try:
            return self._store.deserialize_cdr(raw, kind)
        except SerdeError:
            for behind in PADDING if kind in PADDED else ():
                with contextlib.suppress(SerdeError):
                    return self._store.deserialize_cdr(raw[:-behind], kind)
            raise

    def _opened(self) -> Reader:
        what = f"bag {shown(str(self._path))} cannot be read"
        path = _with_metadata(self._path)
        if path.is_file() and path.suffix not in SUFFIXES:
            tool = PACKED.get(path.suffix) if pathlib.Path(path.stem).suffix in SUFFIXES else None
            hint = f", or it lies in a folder with its {METADATA}: `{tool} < {path.name} > {path.stem}` unpacks it"
            rule = f"its name must end in {' or '.join(SUFFIXES)}{hint if tool else ''}"
            raise ValueError(f"{shown(str(path))} is no bag: {rule}")
        if path.is_dir() and not (path / METADATA).exists():
            raise ValueError(f"{what}: no {METADATA} (`ros2 bag reindex` makes it)")
        try:
            files = [each for each in (path.iterdir() if path.is_dir() else [path]) if each.is_file()]
            for each in sorted(files):
                if each.suffix == ".mcap":
                    check_mcap(each)
                elif each.name.endswith(JOURNALS) and each.stat().st_size:
                    raise ValueError(f"{each.name} is not yet in its file (`sqlite3 FILE .tables` brings it in)")
            return self._stack.enter_context(_checked_reader(path))
        except Exception as error:  # on damaged files rosbags raises struct.error, KeyError, sqlite's and others
            hint = " (`sqlite3 FILE .recover` saves what it still holds)" if "open database" in str(error) else ""
            raise ValueError(f"{what}: {_line(error)}{hint}") from error

    def _topics(self) -> dict[str, Topic]:
        found: dict[str, Topic] = {}
        for connection in self._reader.connections:
            offered: Any = connection.ext  # present in bags of ROS 2
            known = found.get(connection.topic)
            text = connection.msgdef.data or (known.definition if known else "")
            found[connection.topic] = Topic(
                type=connection.msgtype,
                definition=text,
                idl=connection.msgdef.format == MessageDefinitionFormat.IDL,
                publishers=max(1, len(offered.offered_qos_profiles)),
            )
        return found

    def _learn(self, topic: Topic) -> None:
        if topic.type in self._store.fielddefs:
            return
        text = topic.definition
        if not text:
            from eel_viz.bags.definitions import definition

            try:
                text = definition(topic.type)
            except ValueError as error:
                raise ValueError(f"bag {shown(str(self._path))} does not define its types, and {error}") from error
        try:
            if topic.idl:
                separator = "=" * 80 + "\n"
                found: dict[str, Any] = {}
                for part in text.split(f"{separator}IDL: "):
                    found.update(get_types_from_idl(part.split("\n", 1)[-1] if separator in text else part))
            else:
                found = get_types_from_msg(text, topic.type)
            self._store.register({name: value for name, value in found.items() if name not in self._store.fielddefs})
        except TypesysError as error:
            raise ValueError(
                f"bag {shown(str(self._path))} defines {topic.type} in a way not understood: {_line(error)}"
            ) from error


def _with_metadata(path: pathlib.Path) -> pathlib.Path:
    """The bag at a `path`; for a folder without metadata.yaml its only file, if there is one."""
    if path.is_file() or (path / METADATA).exists():
        return path
    files = [each for each in path.iterdir() if each.is_file()]
    return files[0] if len(files) == 1 else path


@contextlib.contextmanager
def _checked_reader(path: pathlib.Path) -> Iterator[Reader]:
    """A reader of a bag or one of its files. `ValueError` if the metadata exceed bounds or do not match the files."""
    if path.is_dir():
        check_metadata(path)
    with Reader(path) as reader:
        if path.is_dir():
            storage: Any = reader.storage  # for a folder, it has files
            files, known = storage.storages, {_identity(each) for each in reader.connections}
            strange = {_identity(each) for file in files for each in file.connections} - known
            if strange or sum(file.metadata.message_count for file in files) != reader.message_count:
                raise ValueError("metadata.yaml does not fit the files")
        yield reader


def _identity(connection: Connection) -> tuple[str, str, str]:
    """The properties that a topic in metadata.yaml must share with one in a file."""
    return connection.topic, connection.msgtype, str(connection.ext)


def _line(error: BaseException) -> str:
    return one_line(error) or type(error).__name__
