# SPDX-License-Identifier: Apache-2.0
"""Where recordings go: base classes of the destinations, and of the streams that they open for each recording.

Rerun does not report whether logged data arrive: a disk may be full, a viewer may have stopped reading. After one
failed write a file silently drops everything later. Logging to a viewer that does not read blocks for ever after some
300 MB, and so does closing that stream. Both faults show when the stream is flushed: it fails, or it times out.
"""

import contextlib
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
import pyarrow as pa
import rerun as rr
import rerun.blueprint as rrb
from eel_common.version import software

from eel_viz.batched_stream import Rates
from eel_viz.messages import Body
from eel_viz.settings import Settings
from eel_viz.views.blueprint import arrangement
from eel_viz.views.views import Look

APPLICATION = "eel"  # Rerun's application id
SHORT = 5.0  # s: shorter recordings are not refitted: a second blueprint would take 0.4 MB of the file
CLOSE_TIMEOUT = 3.0  # s for the last flush of a stream
CHECK_PERIOD = 0.5  # s between two checks of a stream; a killed process loses no more of its file
STALL_TIMEOUT = 2.0  # s without progress: then a viewer is reported, or a file is given up

_detached: list[rr.RecordingStream | threading.Thread] = []

LogFunction = Callable[[str], None]


class Destination(ABC):
    """Opens and closes the streams of recordings.

    rates: how often numbers and drawings are logged. log_info, log_warning: write one line to the user.
    live: a viewer shows the data as they come.

    Attributes:
        incomplete: whether part of a recording is missing here.
        properties: of each recording: numbers and texts by group and name.
        body: the swimmer's, which decides the tabs; None: not known yet.
    """

    def __init__(
        self, settings: Settings, rates: Rates, log_info: LogFunction, log_warning: LogFunction, *, live: bool
    ) -> None:
        self.settings, self.rates, self.log_info, self.log_warning = settings, rates, log_info, log_warning
        self.live = live
        self.incomplete = False
        self.properties: dict[str, dict[str, Any]] = {}
        self.body: Body | None = None
        self.sensed = False  # whether some sensor is published
        self._blueprint_sent = False  # later recordings keep the user's changes in the viewer

    @abstractmethod
    def open(self, number: int, name: str) -> "Delivery | None":
        """The stream of recording `number` (1, 2, ...), called `name`; None if it cannot be opened at present."""

    def make_stream(
        self,
        sink: rr.FileSink | rr.GrpcSink,
        name: str,
        batches: rr.ChunkBatcherConfig | None = None,
        identifier: str | None = None,
    ) -> rr.RecordingStream:
        """A stream to `sink` for a recording called `name`. batches: how Rerun batches data before sending.

        identifier: of the recording; None: a new one.
        """
        batcher = batches or rr.ChunkBatcherConfig.DEFAULT()
        stream = rr.RecordingStream(APPLICATION, recording_id=identifier, batcher_config=batcher)
        stream.set_log_time_enabled(False)
        stream.set_sinks(sink, default_blueprint=self.blueprint())
        if self.live and not self._blueprint_sent:  # viewers ignore a default blueprint after the first data
            stream.send_blueprint(self.blueprint(), make_active=True, make_default=True)
            self._blueprint_sent = True
        self.describe(stream, name)
        return stream

    def describe(self, stream: rr.RecordingStream, name: str) -> None:
        """Send the recording's name and properties, and what wrote it."""
        stream.send_recording_name(name)
        send_properties(stream, "swim", {"version": software()})
        for group, values in self.properties.items():
            send_properties(stream, group, values)

    def blueprint(self, end: float = 0.0) -> rrb.Blueprint:
        """The arrangements of a recording that ends at `end` [s]; 0: still running."""
        chosen = self.settings
        parts = {name: bool(self.body and getattr(self.body, name)) for name in ("fins", "joints")}
        look = Look(frames=chosen.frames, wake=chosen.wake, end=end, sensors=self.sensed, **parts)
        return arrangement(chosen.blueprint, live=self.live, comparison=bool(chosen.compare), look=look)

    def adopt_body(self, stream: rr.RecordingStream | None, body: Body) -> None:
        """Take the body, which decides the tabs. A viewer of the open `stream` gets them at once, a file at its end."""
        before, self.body = self.body, body
        changed = (body.fins, body.joints) != ((before.fins, before.joints) if before else ((), ()))
        if self.live and stream is not None and changed:
            stream.send_blueprint(self.blueprint(), make_active=True, make_default=True)

    def adopt_sensors(self, stream: rr.RecordingStream | None) -> None:
        """Show the tab of sensors: to a viewer of the open `stream` at once, in a file from its end on."""
        self.sensed = True
        if self.live and stream is not None:
            stream.send_blueprint(self.blueprint(), make_active=True, make_default=True)

    def fit(self, stream: rr.RecordingStream, end: float) -> None:
        """Fit tabs, axes, and the repeated part to a recording that ends at `end` [s]; a short one is not changed."""
        has_parts = self.sensed or (self.body is not None and bool(self.body.fins or self.body.joints))
        if not self.live and (end >= SHORT or has_parts):
            stream.send_blueprint(self.blueprint(end), make_active=False, make_default=True)

    def disconnected(self) -> bool:
        """Whether the receiver of open streams has gone, so that they must be given up."""
        return False

    def close(self) -> None:
        """Close resources that outlive the recordings, such as a server."""
        return


class Delivery:
    """An open `stream` of a `destination`. In this class the caller owns it: it is not watched, and stays open.

    Attributes:
        failed: whether the file can no longer be written.
        disconnected: whether the viewer has ended.
    """

    def __init__(self, destination: Destination, stream: rr.RecordingStream) -> None:
        self.destination, self.stream = destination, stream
        self.failed = self.disconnected = False
        self._last_check = time.monotonic()

    @property
    def accepts_data(self) -> bool:
        """Whether data may be logged to the stream now."""
        return not self.failed and not self.disconnected

    def check(self) -> None:
        """Look for faults, at most once per `CHECK_PERIOD`."""
        now = time.monotonic()
        if not self.failed and not self.disconnected and now - self._last_check >= CHECK_PERIOD:
            self.find_faults(now)
            self._last_check = time.monotonic()

    def find_faults(self, now: float) -> None:
        """Flush the stream at `now` [s, steady clock], and note its state."""
        return

    def close(self, end: float = 0.0) -> None:
        """Flush and close the stream of a run that ends at `end` [s]. This completes a file."""
        self.destination.fit(self.stream, end)
        self.stream.flush()

    def keep_older(self) -> None:
        """No data has come: leave an older file as it was."""
        return

    def discard(self) -> None:
        """After an error: discard incomplete output."""
        return

    def flushed(self, timeout: float) -> bool:
        """Whether all data arrive within a `timeout` [s]. `RuntimeError` if they never will."""
        try:
            self.stream.flush(timeout_sec=timeout)
        except RuntimeError as error:
            if "timed out" in str(error):
                return False
            raise
        return True


def send_properties(stream: rr.RecordingStream, group: str, values: dict[str, Any]) -> None:
    """Send properties of a recording: numbers, texts and booleans, or rows of them, by name."""
    stream.send_property(
        group, [rr.DescribedComponentBatch(Value(each), rr.ComponentDescriptor(name)) for name, each in values.items()]
    )


class Value:
    """A component with its own type: in `rr.AnyValues`, a name keeps one type throughout a process."""

    def __init__(self, value: Any) -> None:
        row = [value] if isinstance(value, (str, bytes)) or not np.iterable(value) else list(value)
        self._row = [float(each) if type(each) is int else each for each in row]  # equal types in a sweep's files

    def as_arrow_array(self) -> pa.Array:
        """Its row."""
        return pa.array(self._row)


def close_stream(stream: rr.RecordingStream) -> None:
    """Flush and close the stream, each within `CLOSE_TIMEOUT`. This completes a file.

    Rerun may wait without end for the thread of a file that ended with a write error. Such a stream is abandoned.
    Rerun's flush of all streams at the end of the process, which would wait for it too, is then skipped.
    """
    with contextlib.suppress(RuntimeError):  # the viewer has gone; a file is complete anyway
        stream.flush(timeout_sec=CLOSE_TIMEOUT)
    closing = threading.Thread(target=stream.disconnect, name="close recording", daemon=True)
    closing.start()
    closing.join(CLOSE_TIMEOUT)
    if closing.is_alive():
        rr.unregister_shutdown()


def detach_blocked(blocked: rr.RecordingStream | threading.Thread) -> None:
    """Keep a reference to a blocked stream or thread: its destructor would block this process."""
    _detached.append(blocked)
