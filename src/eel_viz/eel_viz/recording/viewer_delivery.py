# SPDX-License-Identifier: Apache-2.0
"""Streams to viewers that may stop reading: to a viewer of another process, and to this process's server.

Logging to a viewer that does not read finally blocks. So a viewer of another process misses data until it reads again,
and a viewer that holds up the server is disconnected.
"""

import rerun as rr

from eel_viz.recording.destination import STALL_TIMEOUT, Delivery, Destination, close_stream, detach_blocked
from eel_viz.viewer_connections import ViewerConnections

VIEWER_FLUSH_TIMEOUT = 0.1  # s for one flush to a viewer


class ViewerDelivery(Delivery):
    """A stream to a viewer. It sends nothing while the viewer does not read."""

    RECOVERED = "the viewer reads again"

    def __init__(self, destination: Destination, stream: rr.RecordingStream) -> None:
        super().__init__(destination, stream)
        self._stalled_since: float | None = None  # s: start of the viewer's stall
        self._stall_reported = False

    @property
    def accepts_data(self) -> bool:
        """Whether the viewer exists and reads."""
        return super().accepts_data and not self.stalled

    @property
    def stalled(self) -> bool:
        """Whether the last flush did not arrive. Further data would fill this process's memory."""
        return self._stalled_since is not None

    def find_faults(self, now: float) -> None:
        """Check whether the viewer reads, and report a change."""
        if self._arrived():
            if self._stall_reported:
                self.destination.log_info(self.RECOVERED)
            self._stalled_since, self._stall_reported = None, False
            return
        self._stalled_since = now if self._stalled_since is None else self._stalled_since
        if now - self._stalled_since > STALL_TIMEOUT and not self._stall_reported:
            self._report_stall()

    def _report_stall(self) -> None:
        self._stall_reported = True
        self.destination.log_warning(
            f"the viewer has not read for {STALL_TIMEOUT:g} s: it misses what comes until it does"
        )

    def close(self, end: float = 0.0) -> None:
        """Flush and close the stream. A blocked stream is detached instead."""
        if self.disconnected or self._arrived() or self.disconnected:
            close_stream(self.stream)
        else:
            detach_blocked(self.stream)

    def _arrived(self) -> bool:
        try:
            return self.flushed(VIEWER_FLUSH_TIMEOUT)
        except RuntimeError:
            self.disconnected = True
            return False


class ServerDelivery(ViewerDelivery):
    """A stream to the own server. A viewer that holds it up is disconnected, so that the others miss no data."""

    RECOVERED = "the server goes on"

    def __init__(self, destination: Destination, stream: rr.RecordingStream, viewers: ViewerConnections) -> None:
        super().__init__(destination, stream)
        self._viewers = viewers

    @property
    def stalled(self) -> bool:
        """Whether the server itself stands still. While a viewer may be the cause, data are kept for the others."""
        return self._stall_reported

    def find_faults(self, now: float) -> None:
        self._viewers.look()
        super().find_faults(now)

    def _report_stall(self) -> None:
        if self._viewers.in_grace(STALL_TIMEOUT):
            self._stalled_since = None
            return
        viewer = self._viewers.disconnect_last()
        if viewer:
            self._stalled_since = None
            self.destination.log_warning(
                f"the viewer at {viewer} does not keep up, and has held up the others for {STALL_TIMEOUT:g} s: it is "
                "disconnected; opened again, it gets what memory_limit has kept"
            )
            return
        self._stall_reported = True
        self.destination.log_warning(
            f"the server has stood still for {STALL_TIMEOUT:g} s: viewers miss what comes until it goes on"
        )
