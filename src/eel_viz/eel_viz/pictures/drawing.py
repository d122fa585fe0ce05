# SPDX-License-Identifier: Apache-2.0
"""Draws pictures of a recording with Rerun's headless viewer: one viewer for all pictures.

The first picture is complete when two successive screenshots are equal. After that, the first screenshot after setting
the time is complete, unless it equals the previous picture: then it is checked again.
"""

import contextlib
import io
import math
import os
import pathlib
import subprocess
import tempfile
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from eel_common.wording import shown
from PIL import Image

from eel_viz.entities import TIMELINE
from eel_viz.viewer import CannotRender, native_viewer, viewer

if TYPE_CHECKING:
    from rerun.experimental import ViewerClient

LOADING_LIMIT = 60.0  # s limit for opening the recording
LOADED_CHECKS = 5  # successive checks of a loaded recording, after which no further timelines are expected
NOTICE = 2.5  # s after its start, during which a viewer shows a notice in the corner
PICTURE_LIMIT = 90.0  # s limit for two screenshots to become equal
SIZE = (1920, 1080)  # pixels
# Most pixels of a window around a single view: edges, tabs, title, time panel. Small windows have fewer.
WINDOW_EDGES = (8, 132)
MAGIC = b"RRF"  # first bytes of a recording of any version
ALONE = "swimmer"  # the arrangement of a bare picture
LEAST_SIDE, MOST_SIDE = 64, 8192  # pixels of a window's side


class Drawing:
    """A recording shown by a viewer; `start` and `end` [s] are its first and last simulation time.

    size: of bare pictures [pixels].
    """

    def __init__(self, client: "ViewerClient", path: pathlib.Path, size: tuple[int, int]) -> None:
        self._client, self._path, self._size = client, path, size
        self._started = time.monotonic()
        self.start, self.end = self._load()
        self._last = b""
        self._shown: list[str] = []  # views of the arrangement in front
        self._view: str | None = None  # the view in the pictures; None: the whole window

    def png(self, at: float) -> bytes:
        """The picture at simulation time `at` [s] as PNG. `ValueError` if it lies outside the recording."""
        if not self.start <= at <= self.end:
            raise ValueError(
                f"time must lie in the recording, {self.start:g} to {self.end:g} s ({self._path.name}), got {at:g}"
            )
        self._client.set_time(TIMELINE, duration=at, play_state="paused")
        picture = self.screenshot(self._view) if self._last else b""
        if picture in (b"", self._last):  # the first, or late, or possibly outdated
            picture = self._stable_picture()
        self._last = picture
        return picture if self._view is None else _fitted(picture, self._size)

    def arrange(self, name: str, *, bare: bool = False) -> None:
        """Bring the arrangement `name` of the recording to the front. `ValueError` if there is none.

        bare: from now on, pictures show only its first view, without the viewer's frame.
        """
        blueprint = self._client.get_blueprint(of="recording").blueprint
        found = ((path.strip("/"), part.get("ContainerBlueprint")) for path, part in blueprint.items())
        boxes = {path: box for path, box in found if box is not None}
        root = boxes.get(f"container/{blueprint['/viewport']['ViewportBlueprint'].get('root_container')}", {})
        tabs = {boxes.get(path.strip("/"), {}).get("display_name"): path for path in root.get("contents", [])}
        tabs.pop(None, None)
        if name not in tabs:
            raise ValueError(
                f"blueprint must be one of {', '.join(tabs) or 'none'} ({self._path.name}), got {shown(name)}"
            )
        root["active_tab"] = tabs[name]
        self._shown = _views_in(boxes, tabs[name])
        self._view = self._shown[0] if bare else None
        if bare:
            blueprint["/viewport"]["ViewportBlueprint"]["maximized"] = self._view
        self._client.set_blueprint(blueprint, of="recording")
        self._last = b""

    def views(self) -> list[Any]:
        """The viewer's views of the arrangement in front, after a picture of it, three-dimensional ones first."""
        found = [view for view in self._client.get_state().views if view.view_id in self._shown]
        return sorted(found, key=lambda view: view.view_class != "3D")

    def screenshot(self, view: str | None) -> bytes:
        """The present display as PNG: the `view` with this id, or the whole window; empty if the viewer is late."""
        try:
            png: bytes = self._client.take_screenshot(view)
        except TimeoutError:  # a busy machine: the caller waits for a stable picture
            return b""
        return png

    def _load(self) -> tuple[float, float]:
        self._client.open([str(self._path)])
        limit, loaded_checks = time.monotonic() + LOADING_LIMIT, 0
        while True:
            state = self._client.get_state()
            times = [line for one in state.recordings for line in one.timelines if line.name == TIMELINE]
            if times and not state.loading:
                start, end = times[0].start, times[0].end
                if start is not None and end is not None:
                    return start / 1e9, end / 1e9
            # at first there is no recording, and nothing is loading
            loaded_checks = loaded_checks + 1 if state.recordings and not state.loading else 0
            if time.monotonic() > limit or loaded_checks == LOADED_CHECKS:
                raise ValueError(f"{self._path.name} is no recording of a swimmer, it has no timeline {TIMELINE}")
            time.sleep(0.1)

    def _stable_picture(self) -> bytes:
        limit = time.monotonic() + PICTURE_LIMIT
        before = b""
        while time.monotonic() < limit:
            time.sleep(0.2)
            png = self.screenshot(self._view)
            noticed = time.monotonic() - self._started < NOTICE
            if png and png == before and not noticed and not self._client.get_state().loading:
                return png
            before = png
        raise CannotRender(f"the viewer did not come to rest within {PICTURE_LIMIT:g} s")


def _window(size: tuple[int, int]) -> tuple[int, int]:
    """A window whose single view covers `size` [pixels] however high the viewer's frame is (`_fitted`)."""
    height = size[1] + WINDOW_EDGES[1]
    return math.ceil(size[0] * height / size[1]) + WINDOW_EDGES[0], height


def _fitted(png: bytes, size: tuple[int, int]) -> bytes:
    """The picture scaled to the height in `size` [pixels], its sides cut: the legend is at the lower edge."""
    with Image.open(io.BytesIO(png)) as image:
        if image.size == size:
            return png
        scale = max(size[0] / image.width, size[1] / image.height)
        left, top = ((whole - part / scale) / 2.0 for whole, part in zip(image.size, size, strict=True))
        box = left, top, left + size[0] / scale, top + size[1] / scale
        return _png(image.convert("RGB").resize(size, Image.Resampling.LANCZOS, box=box))


def _png(image: Image.Image) -> bytes:
    file = io.BytesIO()
    image.save(file, format="PNG")
    return file.getvalue()


def _views_in(boxes: dict[str, dict[str, Any]], path: str) -> list[str]:
    """The ids of the views in the container at `path`. Of tabs in it, only the first counts."""
    kind, _, identifier = path.strip("/").partition("/")
    if kind == "view":
        return [identifier]
    box = boxes[path.strip("/")]
    contents = [box["contents"]] if isinstance(box["contents"], str) else box["contents"]
    if box["container_kind"] == "Tabs":
        contents = contents[:1]
    return [view for each in contents for view in _views_in(boxes, each)]


class SideBySide:
    """Two drawings as one. `start` and `end` [s] bound their common simulation times.

    `ValueError` without common times.
    """

    def __init__(self, left: Drawing, right: Drawing) -> None:
        self._both = left, right
        self.start, self.end = max(left.start, right.start), min(left.end, right.end)
        if self.start > self.end:
            raise ValueError(
                "recordings beside one another must have times in common, got "
                f"{left.start:g} to {left.end:g} s and {right.start:g} to {right.end:g} s"
            )

    def png(self, at: float) -> bytes:
        """Both pictures at simulation time `at` [s] as one PNG, side by side."""
        left, right = (Image.open(io.BytesIO(each.png(at))).convert("RGB") for each in self._both)
        joined = Image.new("RGB", (left.width + right.width, left.height))
        joined.paste(left, (0, 0))
        joined.paste(right, (left.width, 0))
        return _png(joined)


@contextlib.contextmanager
def drawn(
    recording: str | os.PathLike[str], *, size: tuple[int, int] = SIZE, blueprint: str = "", bare: bool = False
) -> Iterator[Drawing]:
    """Open a `Drawing` of the file `recording` with pictures of `size` pixels; `blueprint`: the arrangement in front.

    bare: the pictures show only the arrangement's first view; without `blueprint`, that of the swimmer.
    `ValueError` if the file is not a recording; `CannotRender` if the viewer cannot draw.
    """
    if not all(LEAST_SIDE <= side <= MOST_SIDE for side in size):
        raise ValueError(f"size must be {LEAST_SIDE} to {MOST_SIDE} pixels each way, got {size[0]}x{size[1]}")
    with contextlib.ExitStack() as stack:
        path = _readable(pathlib.Path(recording).resolve(), stack)
        window = _window(size) if bare else size
        drawing = Drawing(stack.enter_context(viewer(window)), path, size)
        if blueprint or bare:
            drawing.arrange(blueprint or ALONE, bare=bare)
        yield drawing


@contextlib.contextmanager
def drawn_beside(
    recording: str | os.PathLike[str], beside: str | os.PathLike[str] | None, **settings: Any
) -> Iterator[Drawing | SideBySide]:
    """Open a `Drawing` of `recording`, with `beside` to its right if given. settings: those of `drawn`."""
    with contextlib.ExitStack() as stack:
        drawing = stack.enter_context(drawn(recording, **settings))
        yield drawing if beside is None else SideBySide(drawing, stack.enter_context(drawn(beside, **settings)))


def check_recording(path: pathlib.Path) -> None:
    """`ValueError` if `path` is no file."""
    if not path.is_file():
        raise ValueError(f"recording must be a file, got {shown(str(path))}")


def _readable(path: pathlib.Path, stack: contextlib.ExitStack) -> pathlib.Path:
    """`path`, or a repaired copy if the recording is incomplete. `ValueError` if it cannot be read."""
    check_recording(path)
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
