# SPDX-License-Identifier: Apache-2.0
"""The destinations of a recording: a file, a running viewer, or a server that any viewer can connect to.

The server runs in this process, and the streams of the recordings are its clients. So nothing blocks without a viewer,
memory is bounded, and an open viewer switches to a new recording. A viewer that holds up the server is disconnected. A
stream sent directly to an absent viewer would finally block for ever, so the viewer's port is probed first.
"""

import ipaddress
import socket
import subprocess
import threading
import uuid
from functools import partial
from urllib.parse import urlsplit

import rerun as rr
from eel_common.wording import shown

from eel_viz.batched_stream import Rates
from eel_viz.recording.destination import (
    APPLICATION,
    Delivery,
    Destination,
    LogFunction,
    close_stream,
    detach_blocked,
)
from eel_viz.recording.recording_file import FileDestination
from eel_viz.recording.viewer_delivery import ServerDelivery, ViewerDelivery
from eel_viz.settings import Settings
from eel_viz.viewer import display, free_port, listening, open_window, serve_to_browsers
from eel_viz.viewer_connections import ViewerConnections

LIVE_TICK = 0.16  # s: short enough for smooth motion in a viewer
ANSWER_LIMIT = 1.0  # s until a listening viewer must answer


class ServerDestination(Destination):
    """A gRPC server on a port of this machine, for viewers that come and go."""

    def __init__(self, settings: Settings, log_info: LogFunction, log_warning: LogFunction) -> None:
        super().__init__(settings, live_rates(settings), log_info, log_warning, live=True)
        port = self._free(settings.port)  # the server would only log that a port is in use
        self._web_viewer: subprocess.Popen[bytes] | None = None
        address = ipaddress.IPv4Address(settings.address)
        self._here = "127.0.0.1" if address.is_unspecified else settings.address
        self._name = socket.gethostname() if address.is_unspecified else settings.address
        # The web viewer's page requests the data. By default the server allows this on this machine.
        pages = None if address.is_loopback else [f"http://*:{settings.web_port}"]
        server = rr.GrpcServerSink(
            bind_ip=settings.address,
            port=port,
            server_memory_limit=settings.memory_limit,
            cors_allow_origin=pages,
        )
        self.uri = f"rerun+http://{self._here}:{port}/proxy"
        # viewers list the server's own recording with the runs: the first run carries it on
        self._identifier: str | None = str(uuid.uuid4())
        self._host = rr.RecordingStream(APPLICATION, recording_id=self._identifier, send_properties=False)
        self._host.set_sinks(server)
        self._viewers = ViewerConnections(port)
        self._shown_uri = f"rerun+http://{self._name}:{port}/proxy"
        log_info(f"serving on {address}; to look at it, now or later: rerun {self._shown_uri}")
        if not address.is_loopback:
            log_warning(
                f"anybody who reaches {self._name} can read what is served, and add to it (address is {address})"
            )

    def open(self, number: int, name: str) -> Delivery:
        stream = self.make_stream(rr.GrpcSink(self.uri), name, identifier=self._identifier)
        self._identifier = None
        return ServerDelivery(self, stream, self._viewers)

    def close(self) -> None:
        """Close the servers, after the streams of the recordings."""
        close_stream(self._host)
        if self._web_viewer is not None:  # it holds no data, and may have been stopped
            self._web_viewer.kill()
            self._web_viewer.wait()

    def show_in_window(self) -> None:
        """Open a viewer on this machine's display; it stays open when this process ends."""
        if not display():
            self.log_warning("there is no display: no viewer is opened")
            return
        open_window(self.uri)

    def show_in_browser(self) -> None:
        """Serve the web viewer too, and log its address."""
        port = self._free(self.settings.web_port)
        self._web_viewer = serve_to_browsers(self.settings.address, self._here, port, self.uri)
        self.log_info(f"look at it in a browser: http://{self._name}:{port}/?url={self._shown_uri}")

    def _free(self, port: int) -> int:
        """`port`, or another one if it is in use."""
        if not listening(port):
            return port
        other = free_port()
        self.log_warning(f"port {port} is in use, taking {other}")
        return other


class ViewerDestination(Destination):
    """A viewer started by another process. While it is absent or closed, nothing is sent."""

    def __init__(self, settings: Settings, log_info: LogFunction, log_warning: LogFunction) -> None:
        super().__init__(settings, live_rates(settings), log_info, log_warning, live=True)
        address = urlsplit(settings.viewer)
        if address.hostname is None or address.port is None:
            raise ValueError(f"viewer must look like rerun+http://127.0.0.1:9876/proxy, got {shown(settings.viewer)}")
        self._address = (address.hostname, address.port)
        self._missing_reported = False
        self._attempts: list[threading.Thread] = []  # pending attempts to connect

    def open(self, number: int, name: str) -> Delivery | None:
        """A stream to the viewer. It connects in a thread, as a viewer that does not answer would block for ever."""
        host, port = self._address
        self._attempts = [attempt for attempt in self._attempts if attempt.is_alive()]
        if self._attempts:
            return None
        if not listening(port, host):
            self._report_missing(f"no viewer listens at {self.settings.viewer}: start one with `rerun`")
            return None
        made: list[rr.RecordingStream] = []
        connect = partial(self.make_stream, rr.GrpcSink(self.settings.viewer), name)
        attempt = threading.Thread(target=lambda: made.append(connect()), daemon=True)
        attempt.start()
        attempt.join(ANSWER_LIMIT)
        if not made:
            detach_blocked(attempt)
            self._attempts.append(attempt)
            self._report_missing(f"the viewer at {self.settings.viewer} does not answer")
            return None
        self.log_info(f"connected to the viewer at {self.settings.viewer}")
        self._missing_reported = False
        return ViewerDelivery(self, made[0])

    def disconnected(self) -> bool:
        """Whether the viewer has been closed. A stream does not reconnect to a viewer that is opened again."""
        host, port = self._address
        if self._missing_reported or listening(port, host):
            return False
        self._blueprint_sent = False
        self._report_missing(f"the viewer at {self.settings.viewer} has gone")
        return True

    def _report_missing(self, text: str) -> None:
        """Log once that the viewer is missing."""
        if not self._missing_reported:
            self._missing_reported = True
            self.log_warning(f"{text}: it is tried again while running")


def live_rates(settings: Settings) -> Rates:
    """The rates of a live viewer."""
    return Rates(numbers=settings.rate, drawings=settings.rate, tick=LIVE_TICK)


def destinations(
    settings: Settings, log_info: LogFunction, log_warning: LogFunction, *, live: bool = False
) -> list[Destination]:
    """The destinations in `settings.sink`. `ValueError` if the only one is a file that cannot be written.

    live: messages come from the network and do not wait, so a file that fails later, or beside other sinks, is retried.
    """
    names = set(settings.sink)
    if "auto" in names:
        names = (names - {"auto"}) | {"spawn" if display() else "save"}
    found: list[Destination] = []
    if "save" in names:
        retry_from = None if not live else 1 if len(names) > 1 else 2
        found.append(FileDestination(settings, log_info, log_warning, retry_from=retry_from))
    if names & {"spawn", "serve"}:
        served = ServerDestination(settings, log_info, log_warning)
        found.append(served)
        if "spawn" in names:
            served.show_in_window()
        if "serve" in names:
            served.show_in_browser()
    if "connect" in names:
        found.append(ViewerDestination(settings, log_info, log_warning))
    return found
