"""Draws pictures of a recording with Rerun's headless viewer: one viewer for all pictures.

The first picture is complete when two screenshots in a row are equal. After that, the first screenshot after setting
the time is complete, unless it equals the previous picture: then it is verified again.
"""

import contextlib
import os
import pathlib
import subprocess
import tempfile
import time
from collections.abc import Iterator

from eel_gaits.wording import shown

from eel_viz.entities import TIMELINE
from eel_viz.viewer import CannotRender, native_viewer, viewer

LOADING_LIMIT = 60.0  # s until the recording must be open
LOADED_CHECKS = 5  # checks in a row of a loaded recording, after which no more timelines are expected
PICTURE_LIMIT = 90.0  # s until two screenshots must be equal
SIZE = (1920, 1080)  # pixels
MAGIC = b"RRF"  # first bytes of a recording of any version
LEAST, MOST = 64, 8192  # pixels of a window's side


class Drawing:
    """A recording that a viewer shows; `start` and `end` [s] are its first and last simulation time."""

    def __init__(self, client, path: pathlib.Path) -> None:
        self._client, self._path = client, path
        self.start, self.end = self._load()
        self._last = b""

    def png(self, at: float) -> bytes:
        """The picture at simulation time `at` [s] as PNG. `ValueError` if it lies outside the recording."""
        if not self.start <= at <= self.end:
            raise ValueError(
                f"time must lie in the recording, {self.start:g} to {self.end:g} s ({self._path.name}), got {at:g}"
            )
        self._client.set_time(TIMELINE, duration=at, play_state="paused")
        picture = self._client.take_screenshot() if self._last else b""
        if picture == self._last:  # the first, or perhaps not up to date
            picture = self._stable_picture()
        self._last = picture
        return picture

    def arrange(self, name: str) -> None:
        """Bring the arrangement `name` of the recording to the front. `ValueError` if there is none."""
        blueprint = self._client.get_blueprint(of="recording").blueprint
        boxes = {
            path.strip("/"): part["ContainerBlueprint"]
            for path, part in blueprint.items()
            if "ContainerBlueprint" in part
        }
        root = boxes.get(f"container/{blueprint['/viewport']['ViewportBlueprint'].get('root_container')}", {})
        tabs = {boxes.get(path.strip("/"), {}).get("display_name"): path for path in root.get("contents", [])}
        tabs.pop(None, None)
        if name not in tabs:
            raise ValueError(
                f"blueprint must be one of {', '.join(tabs) or 'none'} ({self._path.name}), got {shown(name)}"
            )
        root["active_tab"] = tabs[name]
        self._client.set_blueprint(blueprint, of="recording")
        self._last = b""

    def _load(self) -> tuple[float, float]:
        self._client.open([str(self._path)])
        limit, loaded_checks = time.monotonic() + LOADING_LIMIT, 0
        while True:
            state = self._client.get_state()
            times = [line for one in state.recordings for line in one.timelines if line.name == TIMELINE]
            if times and not state.loading:
                return times[0].start / 1e9, times[0].end / 1e9
            loaded = (
                bool(state.recordings) and not state.loading
            )  # at first there is no recording, and nothing is loading
            loaded_checks = loaded_checks + 1 if loaded else 0
            if time.monotonic() > limit or loaded_checks == LOADED_CHECKS:
                raise ValueError(f"{self._path.name} is no recording of a swimmer, it has no timeline {TIMELINE}")
            time.sleep(0.1)

    def _stable_picture(self) -> bytes:
        limit = time.monotonic() + PICTURE_LIMIT
        before = b""
        while time.monotonic() < limit:
            time.sleep(0.2)
            png = self._client.take_screenshot()
            if png and png == before and not self._client.get_state().loading:
                return png
            before = png
        raise CannotRender(f"the viewer did not come to rest within {PICTURE_LIMIT:g} s")


@contextlib.contextmanager
def drawn(recording: str | os.PathLike[str], *, size: tuple[int, int] = SIZE, blueprint: str = "") -> Iterator[Drawing]:
    """Open a `Drawing` of the file `recording` in a window of `size` pixels; `blueprint`: the arrangement in front.

    `ValueError` if the file is not a recording; `CannotRender` if the viewer cannot draw.
    """
    if not all(LEAST <= side <= MOST for side in size):
        raise ValueError(f"size must be {LEAST} to {MOST} pixels each way, got {size[0]}x{size[1]}")
    with contextlib.ExitStack() as stack:
        path = _readable(pathlib.Path(recording).resolve(), stack)
        drawing = Drawing(stack.enter_context(viewer(size)), path)
        if blueprint:
            drawing.arrange(blueprint)
        yield drawing


def _readable(path: pathlib.Path, stack: contextlib.ExitStack) -> pathlib.Path:
    """`path`, or a repaired copy if the recording is incomplete. `ValueError` if it cannot be read."""
    if not path.is_file():
        raise ValueError(f"recording must be a file, got {shown(str(path))}")
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{shown(str(path))} is no Rerun recording")
    if _verified(path):
        return path
    repaired = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory())) / path.name
    subprocess.run([native_viewer(), "rrd", "optimize", str(path), "-o", str(repaired)], capture_output=True)
    if not repaired.is_file() or not _verified(repaired):
        raise ValueError(f"{shown(str(path))} is damaged beyond reading")
    return repaired


def _verified(path: pathlib.Path) -> bool:
    """Whether the viewer can read all of `path`."""
    return subprocess.run([native_viewer(), "rrd", "verify", str(path)], capture_output=True).returncode == 0
