"""Where a recording goes: a file, a viewer that runs already, or served data that any viewer can come to, now or later.

A destination makes one Rerun stream for each run. What is served lives in a server of this process, to which the
streams are clients: nothing blocks when no viewer is there, memory is bounded, and an open viewer moves on to the new
run. A stream straight to an absent viewer would block for ever in the end; so the viewer's port is probed first.
"""

import contextlib
import datetime
import pathlib
import tempfile
import threading
from collections.abc import Callable
from urllib.parse import urlsplit

import rerun as rr
import rerun.blueprint as rrb

from eel_viz.blueprint import arrangement
from eel_viz.flow import abandon
from eel_viz.loggers import Rates
from eel_viz.settings import Settings
from eel_viz.viewer import display, free_port, listening, open_window

APPLICATION = "eel"
CLOSING_LIMIT = 3.0  # s for what is still on its way
LIVE_TICK = 0.16  # s: a viewer shall move smoothly
FILE_TICK = 0.6  # s: a process that is killed loses no more; each batch of an entity costs its file some 700 bytes
ANSWER_LIMIT = 1.0  # s, until a viewer that listens answers
HOST = "127.0.0.1"

Say = Callable[[str], None]


class Destination:
    """Makes the streams of runs. `rates`: how much of a run goes there; `say`, `warn`: one line to the user.
    `live`: a viewer looks on."""

    def __init__(self, settings: Settings, rates: Rates, say: Say, warn: Say, *, live: bool) -> None:
        self.settings, self.rates, self.say, self.warn = settings, rates, say, warn
        self.live = live

    def file(self, run: int) -> pathlib.Path | None:
        """The file that run number `run` is written to; None where it goes elsewhere."""
        return None

    def open(self, run: int, name: str) -> rr.RecordingStream | None:
        """The stream of run number `run` (1, 2, ...), called `name`; None: not now."""
        sink = self._sink(run)
        if sink is None:
            return None
        return self._connected(sink, name)

    def _connected(self, sink: rr.FileSink | rr.GrpcSink, name: str) -> rr.RecordingStream | None:
        stream = rr.RecordingStream(APPLICATION, batcher_config=self._batches())
        stream.set_log_time_enabled(False)
        stream.set_sinks(sink, default_blueprint=self._blueprint())
        stream.send_recording_name(name)
        return stream

    def end(self, stream: rr.RecordingStream) -> None:
        """End a run's stream."""
        close_stream(stream)

    def lost(self) -> bool:
        """Whether what was open has gone, and its stream is to be given up."""
        return False

    def close(self) -> None:
        """End what is not a run's: a server."""

    def _batches(self) -> rr.ChunkBatcherConfig:
        """How data are gathered before they are sent."""
        return rr.ChunkBatcherConfig.DEFAULT()

    def _blueprint(self) -> rrb.Blueprint:
        return arrangement(
            self.settings.blueprint, live=self.live, compare=bool(self.settings.compare), frames=self.settings.frames
        )

    def _sink(self, run: int) -> rr.FileSink | rr.GrpcSink | None:
        raise NotImplementedError


class File(Destination):
    """A .rrd file; the second run and later ones get a number before the suffix.

    `elsewhere`: where it cannot be written it goes to the folder for temporary files, so that no run is lost.
    """

    def __init__(self, settings: Settings, say: Say, warn: Say, *, elsewhere: bool = False) -> None:
        super().__init__(
            settings, Rates(numbers=0.0, drawings=settings.skin_rate, tick=FILE_TICK), say, warn, live=False
        )
        path = settings.recording or f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S}.rrd"
        self._first, self._elsewhere = pathlib.Path(path), elsewhere
        self._files: dict[int, pathlib.Path] = {}

    def path(self, run: int) -> pathlib.Path:
        """The file of run number `run`."""
        first = self._first
        return first if run == 1 else first.with_name(f"{first.stem}-{run}{first.suffix}")

    def file(self, run: int) -> pathlib.Path | None:
        """The file that run number `run` is written to."""
        return self._files.get(run)

    def _batches(self) -> rr.ChunkBatcherConfig:
        return rr.ChunkBatcherConfig(flush_tick=FILE_TICK)

    def _sink(self, run: int) -> rr.FileSink:
        path = self.path(run)
        existed = path.exists()
        problem = obstacle(path)
        if problem:
            refusal = f"recording {str(path)!r} cannot be written: {problem}"
            path, existed = (
                pathlib.Path(tempfile.gettempdir()) / f"eel-{datetime.datetime.now():%Y%m%d-%H%M%S-%f}.rrd",
                False,
            )
            if not self._elsewhere or obstacle(path):
                raise ValueError(refusal)
            self.warn(f"{refusal}: it goes to {path}")
        if existed:
            self.warn(f"{path} is there already and is replaced")
        self.say(f"saving to {path}")
        self._files[run] = path
        return rr.FileSink(str(path))


def obstacle(path: pathlib.Path) -> str:
    """Why `path` cannot be written; empty if it can. A FileSink does not say it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab"):
            return ""
    except OSError as error:
        return error.strerror or str(error)


class Served(Destination):
    """Data served on a port of this machine, for viewers that come and go."""

    def __init__(self, settings: Settings, say: Say, warn: Say) -> None:
        super().__init__(
            settings, Rates(numbers=settings.rate, drawings=settings.rate, tick=LIVE_TICK), say, warn, live=True
        )
        port = settings.port
        if listening(port):  # the server would only log it
            port = free_port()
            warn(f"port {settings.port} is in use, taking {port}")
        server = rr.GrpcServerSink(bind_ip=HOST, port=port, server_memory_limit=settings.memory_limit)
        self.uri = server.uri
        self._host = rr.RecordingStream(APPLICATION, send_properties=False)
        self._host.set_sinks(server)
        say(f"serving at {self.uri}; to look at it, now or later: rerun {self.uri}")

    def _sink(self, run: int) -> rr.GrpcSink:
        return rr.GrpcSink(self.uri)

    def close(self) -> None:
        """End the server, after the runs' streams."""
        close_stream(self._host)

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
        rr.serve_web_viewer(web_port=port, open_browser=False, connect_to=self.uri)
        self.say(f"look at it in a browser: http://{HOST}:{port}/?url={self.uri}")


class Connected(Destination):
    """A viewer that somebody else has started; while it is absent, or closed again, nothing is sent."""

    def __init__(self, settings: Settings, say: Say, warn: Say) -> None:
        super().__init__(
            settings, Rates(numbers=settings.rate, drawings=settings.rate, tick=LIVE_TICK), say, warn, live=True
        )
        address = urlsplit(settings.viewer)
        if address.hostname is None or address.port is None:
            raise ValueError(f"viewer must look like rerun+http://127.0.0.1:9876/proxy, got {settings.viewer!r}")
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


def destinations(settings: Settings, say: Say, warn: Say, *, elsewhere: bool = False) -> list[Destination]:
    """What `settings.sink` asks for; `elsewhere`: see `File`."""
    names = set(settings.sink)
    if "auto" in names:
        names = (names - {"auto"}) | {"spawn" if display() else "save"}
    found: list[Destination] = []
    if "save" in names:
        found.append(File(settings, say, warn, elsewhere=elsewhere))
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


def close_stream(stream: rr.RecordingStream) -> None:
    """Bring out what is on its way, within `CLOSING_LIMIT`, and end the stream: a file is then complete."""
    with contextlib.suppress(RuntimeError):  # the viewer has gone; a file is complete all the same
        stream.flush(timeout_sec=CLOSING_LIMIT)
    stream.disconnect()
