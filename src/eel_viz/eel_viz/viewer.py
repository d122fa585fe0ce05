# SPDX-License-Identifier: Apache-2.0
"""Starts Rerun's native viewer as a separate process: with a window, or headless for pictures.

Headless drawing needs a Vulkan driver; Mesa's software driver (package mesa-vulkan-drivers) is enough.
"""

import contextlib
import importlib.util
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from typing import IO, TYPE_CHECKING

from eel_common.wording import WorkStopped

if TYPE_CHECKING:
    from rerun.experimental import ViewerClient

# Makes Linux end the process when the thread that started it ends, even by SIGKILL (PR_SET_PDEATHSIG, SIGTERM).
DIE_WITH_PARENT = "import ctypes, os, sys; ctypes.CDLL(None).prctl(1, 15); os.execv(sys.argv[1], sys.argv[1:])"
DRIVER = "it needs a Vulkan driver: apt-get install --no-install-recommends mesa-vulkan-drivers"
START_LIMIT = 60.0  # s limit for the viewer to listen
END_LIMIT = 5.0  # s limit for it to end


class CannotRender(WorkStopped):
    """The viewer cannot draw on this machine. The text gives the reason and the remedy."""


@contextlib.contextmanager
def viewer(size: tuple[int, int] = (1920, 1080)) -> Iterator["ViewerClient"]:
    """A `rerun.experimental.ViewerClient` of a headless viewer of `size` [pixels], which ends with the context.

    `CannotRender` if it does not start.
    """
    from rerun.experimental import ViewerClient

    port = free_port()
    command = [native_viewer(), "--headless", "--window-size", f"{size[0]}x{size[1]}", "--port", str(port)]
    command += ["--bind", "127.0.0.1", "--hide-welcome-screen"]
    # a more verbose log would show start-up notices in the picture
    environment = {**os.environ, "RUST_LOG": "error", "RERUN_APP_ONLY": "true"}
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=output)
        try:
            _await_listening(process, port, output)
            yield ViewerClient.connect(f"rerun+http://127.0.0.1:{port}/proxy")
        except ConnectionError as lost:  # without a driver the viewer listens briefly, then ends
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=END_LIMIT)
                raise _ended(process, output) from lost
            raise
        finally:
            end_process(process)


def open_window(what: str) -> None:
    """Open a viewer of `what` (a file or an address) on this machine's display. It outlives this process."""
    process = subprocess.Popen(
        [native_viewer(), "--port", str(free_port()), "--bind", "127.0.0.1", "--hide-welcome-screen", what],
        env={**os.environ, "RERUN_APP_ONLY": "true"},
        start_new_session=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    threading.Thread(target=process.wait, daemon=True).start()  # leaves no zombie


def serve_to_browsers(address: str, here: str, port: int, uri: str) -> subprocess.Popen[bytes]:
    """Serve the web viewer on `port` of `address`, for the data at `uri`. The process ends with this one.

    here: the address at which this machine reaches it. `rerun.serve_web_viewer` would listen on every network.
    """
    command = [native_viewer(), "--serve-web", "--bind", address, "--web-viewer-port", str(port)]
    command += ["--port", str(free_port()), uri]
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", DIE_WITH_PARENT, *command],
            env={**os.environ, "RERUN_APP_ONLY": "true"},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=output,
            start_new_session=True,  # Ctrl-C reaches only the parent, which ends it
        )
        _await_listening(process, port, output, host=here, remedy=f"it was to listen on port {port} of {address}")
    return process


def end_process(process: subprocess.Popen[bytes]) -> None:
    """End a viewer, and wait until it has ended."""
    process.terminate()
    try:
        process.wait(timeout=END_LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def display() -> bool:
    """Whether a window can be opened."""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def native_viewer() -> str:
    """The viewer's own executable. The `rerun` command is a wrapper: ending it would not end the viewer."""
    package = importlib.util.find_spec("rerun_cli")
    if package is None or package.origin is None:
        raise CannotRender("rerun-sdk is not installed: its viewer is needed")
    return str(pathlib.Path(package.origin).parent / "rerun")


def free_port() -> int:
    """A free port of this machine."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def listening(port: int, host: str = "127.0.0.1") -> bool:
    """Whether a process listens on `port` of `host`."""
    with socket.socket() as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((host, port)) == 0


def _await_listening(
    process: subprocess.Popen[bytes], port: int, output: IO[bytes], *, host: str = "127.0.0.1", remedy: str = DRIVER
) -> None:
    limit = time.monotonic() + START_LIMIT
    while not listening(port, host):
        if process.poll() is not None:
            raise _ended(process, output, remedy)
        if time.monotonic() > limit:
            raise CannotRender(f"the viewer did not start within {START_LIMIT:g} s")
        time.sleep(0.05)


def _ended(process: subprocess.Popen[bytes], output: IO[bytes], remedy: str = DRIVER) -> CannotRender:
    """The error for a viewer that ended by itself, with the remedy."""
    output.seek(0)
    lines = output.read().decode(errors="replace").splitlines()
    reason = next((line for line in lines if "graphics" in line or "render" in line.lower()), "".join(lines[-1:]))
    return CannotRender(
        f"the viewer ended with status {process.returncode} ({reason.strip() or 'no reason given'}); {remedy}"
    )
