"""Where a recording goes: a file, a viewer that runs already, or served data that any viewer can come to, now or later.

What is served lives in a server of this process, to which the streams of the runs are clients: nothing blocks when no
viewer is there, memory is bounded, and an open viewer moves on to the new run. A stream straight to an absent viewer
would block for ever in the end; so the viewer's port is probed first.
"""

import ipaddress
import socket
import threading
from urllib.parse import urlsplit

import rerun as rr
from eel_gaits.wording import shown

from eel_viz.recording.delivery import abandon
from eel_viz.recording.destination import APPLICATION, Destination, Say, close_stream
from eel_viz.recording.loggers import Rates
from eel_viz.recording.recording_file import File
from eel_viz.settings import Settings
from eel_viz.viewer import display, end_process, free_port, listening, open_window, serve_to_browsers

LIVE_TICK = 0.16  # s: a viewer shall move smoothly
ANSWER_LIMIT = 1.0  # s, until a viewer that listens answers


class Served(Destination):
    """Data served on a port of this machine, for viewers that come and go."""

    def __init__(self, settings: Settings, say: Say, warn: Say) -> None:
        super().__init__(
            settings, Rates(numbers=settings.rate, drawings=settings.rate, tick=LIVE_TICK), say, warn, live=True
        )
        port, self._web_viewer = settings.port, None
        address = ipaddress.IPv4Address(settings.address)
        self._here = "127.0.0.1" if address.is_unspecified else settings.address
        self._name = socket.gethostname() if address.is_unspecified else settings.address
        if listening(port):  # the server would only log it
            port = free_port()
            warn(f"port {settings.port} is in use, taking {port}")
        # The page of the web viewer may ask for the data: on this machine the server allows that by itself.
        pages = None if address.is_loopback else [f"http://*:{settings.web_port}"]
        server = rr.GrpcServerSink(
            bind_ip=settings.address,
            port=port,
            server_memory_limit=settings.memory_limit,
            cors_allow_origin=pages,
        )
        self.uri = f"rerun+http://{self._here}:{port}/proxy"
        self._host = rr.RecordingStream(APPLICATION, send_properties=False)
        self._host.set_sinks(server)
        self._host.send_recording_name("(server)")  # a viewer lists it beside the runs
        self._shown_uri = f"rerun+http://{self._name}:{port}/proxy"
        say(f"serving on {address}; to look at it, now or later: rerun {self._shown_uri}")
        if not address.is_loopback:
            warn(f"anybody who reaches {self._name} can read what is served, and add to it (address is {address})")

    def _sink(self, run: int) -> rr.GrpcSink:
        return rr.GrpcSink(self.uri)

    def close(self) -> None:
        """End the servers, after the runs' streams."""
        close_stream(self._host)
        if self._web_viewer is not None:
            end_process(self._web_viewer)

    def show_in_window(self) -> None:
        """Open a viewer on this machine's display; it stays when this process ends."""
        if not display():
            self.warn("there is no display: no viewer is opened")
            return
        open_window(self.uri)

    def show_in_browser(self) -> None:
        """Serve the web viewer too, and say where."""
        port = self.settings.web_port
        if listening(port):
            port = free_port()
            self.warn(f"port {self.settings.web_port} is in use, taking {port}")
        self._web_viewer = serve_to_browsers(self.settings.address, self._here, port, self.uri)
        self.say(f"look at it in a browser: http://{self._name}:{port}/?url={self._shown_uri}")


class Connected(Destination):
    """A viewer that somebody else has started; while it is absent, or closed again, nothing is sent."""

    def __init__(self, settings: Settings, say: Say, warn: Say) -> None:
        super().__init__(
            settings, Rates(numbers=settings.rate, drawings=settings.rate, tick=LIVE_TICK), say, warn, live=True
        )
        address = urlsplit(settings.viewer)
        if address.hostname is None or address.port is None:
            raise ValueError(f"viewer must look like rerun+http://127.0.0.1:9876/proxy, got {shown(settings.viewer)}")
        self._address = (address.hostname, address.port)
        self._missed = False
        self._attempts: list[threading.Thread] = []  # that have had no answer

    def _sink(self, run: int) -> rr.GrpcSink | None:
        host, port = self._address
        self._attempts = [attempt for attempt in self._attempts if attempt.is_alive()]
        if self._attempts:
            return None
        if listening(port, host):
            return rr.GrpcSink(self.settings.viewer)
        self._miss(f"no viewer listens at {self.settings.viewer}: start one with `rerun`")
        return None

    def lost(self) -> bool:
        """Whether the viewer has been closed: a stream does not come back to one that is opened again."""
        host, port = self._address
        if self._missed or listening(port, host):
            return False
        self._arranged = False
        self._miss(f"the viewer at {self.settings.viewer} has gone")
        return True

    def _connected(self, sink: rr.GrpcSink, name: str) -> rr.RecordingStream | None:
        """In a thread, as it would wait for ever for a viewer that listens and does nothing else."""
        made: list[rr.RecordingStream] = []
        connect = super()._connected
        attempt = threading.Thread(target=lambda: made.append(connect(sink, name)), daemon=True)
        attempt.start()
        attempt.join(ANSWER_LIMIT)
        if not made:
            abandon(attempt)
            self._attempts.append(attempt)
            self._miss(f"the viewer at {self.settings.viewer} does not answer")
            return None
        self.say(f"connected to the viewer at {self.settings.viewer}")
        self._missed = False
        return made[0]

    def _miss(self, text: str) -> None:
        """Say what is missing, once until it is found."""
        if not self._missed:
            self._missed = True
            self.warn(f"{text}: it is tried again while running")


def destinations(settings: Settings, say: Say, warn: Say, *, live: bool = False) -> list[Destination]:
    """What `settings.sink` asks for. ValueError: the only one is a file that cannot be written.

    `live`: messages do not wait; what cannot be written later, or beside other sinks, is then tried again and again.
    """
    names = set(settings.sink)
    if "auto" in names:
        names = (names - {"auto"}) | {"spawn" if display() else "save"}
    found: list[Destination] = []
    if "save" in names:
        patient_from = None if not live else 1 if len(names) > 1 else 2
        found.append(File(settings, say, warn, patient_from=patient_from))
    if names & {"spawn", "serve"}:
        served = Served(settings, say, warn)
        found.append(served)
        if "spawn" in names:
            served.show_in_window()
        if "serve" in names:
            served.show_in_browser()
    if "connect" in names:
        found.append(Connected(settings, say, warn))
    return found
