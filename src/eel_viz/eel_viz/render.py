"""A recording to a picture, without a display: `render RUN.rrd -o PICTURE.png --at 7.0`.

It starts Rerun's native viewer without a window, sets the time, and takes the picture once two in a row are equal, for
only then everything is loaded. That needs a Vulkan driver; Mesa's software driver (package mesa-vulkan-drivers) does.
"""

import argparse
import contextlib
import importlib.util
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from typing import IO

from eel_viz.entities import TIMELINE

START_LIMIT = 60.0  # s, until the viewer listens
PICTURE_LIMIT = 90.0  # s, until two pictures are equal


class CannotRender(RuntimeError):
    """The viewer cannot draw on this machine; the text says why and what to do."""


def render(
    recording: str | os.PathLike[str],
    picture: str | os.PathLike[str],
    *,
    at: float,
    size: tuple[int, int] = (1920, 1080),
) -> None:
    """Write the PNG `picture` of `recording` at simulation time `at` [s], `size` in pixels."""
    path = pathlib.Path(recording).resolve()
    if not path.is_file():
        raise ValueError(f"recording must be a file, got {str(recording)!r}")
    with viewer(size) as client:
        client.open([str(path)])
        client.set_time(TIMELINE, duration=at, play_state="paused")
        png = _settled(client)
    pathlib.Path(picture).write_bytes(png)


@contextlib.contextmanager
def viewer(size: tuple[int, int] = (1920, 1080)) -> Iterator:
    """A `rerun.experimental.ViewerClient` of a viewer without window, which ends with the block."""
    from rerun.experimental import ViewerClient

    port = free_port()
    command = [native_viewer(), "--headless", "--window-size", f"{size[0]}x{size[1]}", "--port", str(port)]
    command += ["--bind", "127.0.0.1", "--hide-welcome-screen"]
    # with more than errors in the log, notices of the start would be in the picture
    environment = {**os.environ, "RUST_LOG": "error", "RERUN_APP_ONLY": "true"}
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=said)
        try:
            _await_listening(process, port, said)
            yield ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
        finally:
            process.terminate()
            try:
                process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def native_viewer() -> str:
    """The viewer's own executable: the `rerun` command is a wrapper that would leave it behind when it ends."""
    package = importlib.util.find_spec("rerun_cli")
    if package is None:
        raise CannotRender("rerun-sdk is not installed: its viewer is needed")
    return str(pathlib.Path(package.origin).parent / "rerun")


def free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def listening(port: int, host: str = "127.0.0.1") -> bool:
    """Whether somebody listens on `port` of `host`."""
    with socket.socket() as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((host, port)) == 0


def _await_listening(process: subprocess.Popen, port: int, said: IO[bytes]) -> None:
    limit = time.monotonic() + START_LIMIT
    while not listening(port):
        if process.poll() is not None:
            said.seek(0)
            lines = said.read().decode(errors="replace").splitlines()
            reason = next((line for line in lines if "graphics" in line or "render" in line.lower()), "")
            raise CannotRender(
                f"the viewer ended with status {process.returncode} ({reason.strip() or 'no reason given'}); it needs "
                "a Vulkan driver: apt-get install --no-install-recommends mesa-vulkan-drivers"
            )
        if time.monotonic() > limit:
            raise CannotRender(f"the viewer did not start within {START_LIMIT:g} s")
        time.sleep(0.05)


def _settled(client) -> bytes:
    limit = time.monotonic() + PICTURE_LIMIT
    before = b""
    while time.monotonic() < limit:
        time.sleep(0.3)
        png = client.take_screenshot()
        if png and png == before and not client.get_state().loading:
            return png
        before = png
    raise CannotRender(f"the viewer did not come to rest within {PICTURE_LIMIT:g} s")


def main(arguments: list[str] | None = None) -> int:
    """Command line; status 0, 2 for wrong arguments, 3 where the viewer cannot draw."""
    parser = argparse.ArgumentParser(prog="render", description="Draw a Rerun recording to a PNG, without a display.")
    parser.add_argument("recording", help="file .rrd")
    parser.add_argument("picture", nargs="?", help="PNG to write (or -o)")
    parser.add_argument("-o", "--output", metavar="PNG", help="PNG to write")
    parser.add_argument("--at", type=float, default=0.0, metavar="SECONDS", help="simulation time (default 0)")
    parser.add_argument("--size", default="1920x1080", metavar="WxH", help="in pixels (default 1920x1080)")
    chosen = parser.parse_args(arguments)
    output = chosen.output or chosen.picture
    if output is None:
        parser.error("the PNG to write is missing: -o PICTURE.png")
    try:
        width, height = (int(number) for number in chosen.size.split("x"))
    except ValueError:
        parser.error(f"--size must look like 1920x1080, got {chosen.size!r}")
    try:
        render(chosen.recording, output, at=chosen.at, size=(width, height))
    except (CannotRender, ConnectionError) as reason:
        print(f"render: no picture: {reason}", file=sys.stderr)
        return 3
    except (ValueError, OSError) as reason:
        print(f"render: {reason}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
