# SPDX-License-Identifier: Apache-2.0
"""Base class of the destinations of recordings: each opens one Rerun stream per recording and sends the blueprint."""

import contextlib
import pathlib
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import rerun as rr
import rerun.blueprint as rrb

from eel_viz.batched_stream import Rates
from eel_viz.messages import Body
from eel_viz.settings import Settings
from eel_viz.views.blueprint import arrangement
from eel_viz.views.views import Look

APPLICATION = "eel"  # Rerun's application id
SHORT = 5.0  # s: recordings that end before have not settled; a second blueprint would take 0.4 MB of the file
CLOSE_TIMEOUT = 3.0  # s for the last flush of a stream

LogFunction = Callable[[str], None]


class Destination(ABC):
    """Opens and closes the streams of recordings.

    rates: how often numbers and drawings are logged. log_info, log_warning: write one line to the user.
    live: a viewer shows the data as they come.

    Attributes:
        incomplete: part of a recording is missing here.
        properties: of each recording: numbers and texts by group and name.
        body: the swimmer's, of which tabs depend; None: not known yet.
    """

    def __init__(
        self, settings: Settings, rates: Rates, log_info: LogFunction, log_warning: LogFunction, *, live: bool
    ) -> None:
        self.settings, self.rates, self.log_info, self.log_warning = settings, rates, log_info, log_warning
        self.live = live
        self.incomplete = False
        self.properties: dict[str, dict[str, Any]] = {}
        self.body: Body | None = None
        self._blueprint_sent = False  # sent once: later recordings keep the user's changes in the viewer

    @abstractmethod
    def open(self, number: int, name: str) -> rr.RecordingStream | None:
        """The stream of recording `number` (1, 2, ...), called `name`; None if it cannot be opened now."""

    def file(self, number: int) -> pathlib.Path | None:
        """The file that recording `number` is written to; None if it is not a file."""
        return None

    def make_stream(
        self, sink: rr.FileSink | rr.GrpcSink, name: str, batches: rr.ChunkBatcherConfig | None = None
    ) -> rr.RecordingStream:
        """A stream to `sink` for a recording called `name`. batches: how Rerun collects data before it sends them."""
        stream = rr.RecordingStream(APPLICATION, batcher_config=batches or rr.ChunkBatcherConfig.DEFAULT())
        stream.set_log_time_enabled(False)
        stream.set_sinks(sink, default_blueprint=self.blueprint())
        if self.live and not self._blueprint_sent:  # viewers ignore a default blueprint that comes after the first data
            stream.send_blueprint(self.blueprint(), make_active=True, make_default=True)
            self._blueprint_sent = True
        self.describe(stream, name)
        return stream

    def describe(self, stream: rr.RecordingStream, name: str) -> None:
        """Send the recording's name and properties."""
        stream.send_recording_name(name)
        for group, values in self.properties.items():
            send_properties(stream, group, values)

    def blueprint(self, end: float = 0.0) -> rrb.Blueprint:
        """The arrangements of a recording that ends at `end` [s]; 0: it has not ended."""
        chosen = self.settings
        parts = {name: bool(self.body and getattr(self.body, name)) for name in ("fins", "joints")}
        look = Look(frames=chosen.frames, wake=chosen.wake, end=end, **parts)
        return arrangement(chosen.blueprint, live=self.live, comparison=bool(chosen.compare), look=look)

    def adopt_body(self, stream: rr.RecordingStream | None, body: Body) -> None:
        """Take the body, of which tabs depend: a viewer of the open `stream` gets them at once, a file at its end."""
        before, self.body = self.body, body
        changed = (body.fins, body.joints) != ((before.fins, before.joints) if before else ((), ()))
        if self.live and stream is not None and changed:
            stream.send_blueprint(self.blueprint(), make_active=True, make_default=True)

    def fit(self, stream: rr.RecordingStream, end: float) -> None:
        """Fit tabs, axes, and what is repeated of a recording that ends at `end` [s]; one that is short stays."""
        has_parts = self.body is not None and bool(self.body.fins or self.body.joints)
        if not self.live and (end >= SHORT or has_parts):
            stream.send_blueprint(self.blueprint(end), make_active=False, make_default=True)

    def close_recording(self, stream: rr.RecordingStream) -> None:
        """Close a recording's stream."""
        close_stream(stream)

    def abort(self, stream: rr.RecordingStream) -> None:
        """Handle a stream whose file can no longer be written."""
        return

    def discard(self) -> None:
        """After an error: discard the recordings that are not complete."""
        return

    def disconnected(self) -> bool:
        """Whether the receiver of open streams has gone, so that they must be given up."""
        return False

    def close(self) -> None:
        """Close what outlives the recordings, such as a server."""
        return


def send_properties(stream: rr.RecordingStream, group: str, values: dict[str, Any]) -> None:
    """Send properties of a recording: numbers, texts and truths, or rows of them, by name."""
    stream.send_property(
        group, [rr.DescribedComponentBatch(Value(each), rr.ComponentDescriptor(name)) for name, each in values.items()]
    )


class Value:
    """A component of a type of its own: in `rr.AnyValues`, a name has the same type all through a process."""

    def __init__(self, value: Any) -> None:
        row = [value] if isinstance(value, (str, bytes)) or not np.iterable(value) else list(value)
        self._row = [float(each) if type(each) is int else each for each in row]  # files of a sweep have equal types

    def as_arrow_array(self) -> pa.Array:
        """Its row."""
        return pa.array(self._row)


def close_stream(stream: rr.RecordingStream) -> None:
    """Flush and close the stream, which completes a file; each within `CLOSE_TIMEOUT`.

    Rerun may wait without end for the thread of a file that has ended with a write error. Such a stream is abandoned,
    and Rerun's flush of all streams at the end of the process, which would wait for it too, is left out.
    """
    with contextlib.suppress(RuntimeError):  # the viewer has gone; a file is complete all the same
        stream.flush(timeout_sec=CLOSE_TIMEOUT)
    closing = threading.Thread(target=stream.disconnect, name="close recording", daemon=True)
    closing.start()
    closing.join(CLOSE_TIMEOUT)
    if closing.is_alive():
        rr.unregister_shutdown()
