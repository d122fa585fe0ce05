"""A recording drawn by Rerun's viewer, without a display: one viewer for as many pictures as are wanted.

A picture is taken when everything is loaded, that is when two in a row are equal; from then on the first one after
setting the time is the right one, and only if it equals the one before it is looked at again.
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

LOADING_LIMIT = 60.0  # s, until the recording is open
LOOKS = 5  # in a row at a loaded recording: then it has no more timelines to come
PICTURE_LIMIT = 90.0  # s, until two pictures are equal
SIZE = (1920, 1080)  # pixels
MAGIC = b"RRF"  # what recordings begin with, whatever their version
LEAST, MOST = 64, 8192  # pixels of a window's side


class Drawing:
    """A recording that a viewer shows; `start` and `end` are its times [s]."""

    def __init__(self, client, path: pathlib.Path) -> None:
        self._client, self._path = client, path
        self.start, self.end = self._load()
        self._last = b""

    def png(self, at: float) -> bytes:
        """The picture at simulation time `at` [s]."""
        if not self.start <= at <= self.end:
            raise ValueError(
                f"time must lie in the recording, {self.start:g} to {self.end:g} s ({self._path.name}), got {at:g}"
            )
        self._client.set_time(TIMELINE, duration=at, play_state="paused")
        picture = self._client.take_screenshot() if self._last else b""
        if picture == self._last:  # the first, or nothing has moved: is it up to date?
            picture = self._settled()
        self._last = picture
        return picture

    def arrange(self, name: str) -> None:
        """Bring the arrangement `name` to the front, one of those that the recording carries."""
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
        limit, in_vain = time.monotonic() + LOADING_LIMIT, 0
        while True:
            state = self._client.get_state()
            times = [line for one in state.recordings for line in one.timelines if line.name == TIMELINE]
            if times and not state.loading:
                return times[0].start / 1e9, times[0].end / 1e9
            loaded = bool(state.recordings) and not state.loading  # at first it has neither, and loads nothing yet
            in_vain = in_vain + 1 if loaded else 0
            if time.monotonic() > limit or in_vain == LOOKS:
                raise ValueError(f"{self._path.name} is no recording of a swimmer, it has no timeline {TIMELINE}")
            time.sleep(0.1)

    def _settled(self) -> bytes:
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
    """A `Drawing` of the file `recording` in a window of `size` pixels; `blueprint`: the arrangement in front.

    `ValueError` if it is no recording, `CannotRender` where the viewer cannot draw.
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
    """`path`, or where a recording that was cut short lies repaired."""
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
