# SPDX-License-Identifier: Apache-2.0
"""The gallery's recordings and pictures, from the code in docs/gallery.md, and the viewer that shows them in a browser.

`python tools/gallery.py site FOLDER` puts recordings and viewer into the site in FOLDER (`make docs`);
`python tools/gallery.py pictures` draws docs/images/gallery anew (`make pictures`).
The code of a section writes the recording SECTION.rrd. Rerun's executable serves the two files of its web viewer.
"""

import contextlib
import gzip
import io
import os
import re
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import rerun
from eel_viz.pictures.drawing import drawn
from eel_viz.viewer import CannotRender, end_process, free_port, native_viewer, serve_to_browsers
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "images" / "gallery"
SECTION = re.compile(r"^## (.+?)\n.*?^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LARGEST = 3_000_000  # bytes of a recording
SIZE, QUALITY, LARGEST_PICTURE = (800, 450), 70, 60_000  # pixels, of 100, bytes
SCRIPT, MODULE = "re_viewer.js", "re_viewer_bg.wasm"


def sections() -> dict[str, str]:
    """The code of each section of the gallery, by its anchor."""
    return {name.lower().replace(" ", "-"): code for name, code in SECTION.findall(PAGE.read_text())}


def record(name: str, code: str, target: Path) -> None:
    """Run the `code` of the section `name`; its recording, with constant rows first, becomes the file `target`."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path("docs").symlink_to(ROOT / "docs")
        exec(compile(code, f"{PAGE.name}, {name}", "exec"), {"__name__": "__main__"})
        written = Path(f"{name}.rrd")
        if not written.exists():
            raise ValueError(f"the code of {name} in {PAGE.name} must write {written}")
        command = [native_viewer(), "rrd", "optimize", str(written), "-o", str(target)]
        subprocess.run(command, check=True, capture_output=True)
    if target.stat().st_size > LARGEST:
        raise ValueError(
            f"{target.name} must be at most {LARGEST / 1e6:g} MB, got {target.stat().st_size / 1e6:.2f} MB"
        )


def add_viewer(folder: Path) -> None:
    """Put the web viewer of the installed SDK into `folder`; the module is compressed, as many hosts do not do it."""
    stamp = folder / "version.txt"
    if stamp.exists() and stamp.read_text() == rerun.__version__:
        return
    folder.mkdir(parents=True, exist_ok=True)
    with served_viewer() as address:
        script, module = (urllib.request.urlopen(f"{address}/{name}").read() for name in (SCRIPT, MODULE))
    packed = gzip.compress(module, mtime=0)
    files = {SCRIPT: script, f"{MODULE}.gz": packed, stamp.name: rerun.__version__.encode()}
    for name, content in files.items():  # each whole, for another process may do the same
        draft = folder / f"{name}.{os.getpid()}"
        draft.write_bytes(content)
        draft.replace(folder / name)


@contextlib.contextmanager
def served_viewer() -> Iterator[str]:
    """The address at which Rerun's own server offers its web viewer, to this machine alone."""
    host, port = "127.0.0.1", free_port()
    process = serve_to_browsers(host, host, port, f"rerun+http://{host}:{free_port()}/proxy")
    try:
        yield f"http://{host}:{port}"
    finally:
        end_process(process)


def make_site(folder: Path) -> None:
    """Put recordings and viewer into the site in `folder`."""
    add_viewer(folder / "_static" / "viewer")
    (folder / "recordings").mkdir(exist_ok=True)
    for name, code in sections().items():
        target = folder / "recordings" / f"{name}.rrd"
        record(name, code, target)
        print(f"[gallery] {target}: {target.stat().st_size / 1e6:.2f} MB", flush=True)


def draw_pictures(names: list[str]) -> None:
    """Draw the pictures of all sections, or of some. `CannotRender` where the viewer cannot draw."""
    for name, code in sections().items():
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / f"{name}.rrd"
            record(name, code, recording)
            with drawn(recording, size=SIZE, bare=True) as drawing:
                png = drawing.png(drawing.start + 0.8 * (drawing.end - drawing.start))
        target = PICTURES / f"{name}.webp"
        with Image.open(io.BytesIO(png)) as picture:
            picture.convert("RGB").save(target, quality=QUALITY, method=6)
        if target.stat().st_size > LARGEST_PICTURE:
            raise ValueError(f"{target} must be at most {LARGEST_PICTURE / 1e3:g} kB")
        print(f"[gallery] {target.relative_to(ROOT)}: {target.stat().st_size / 1e3:.0f} kB", flush=True)


def main(words: list[str]) -> int:
    """Status 2 for words that are none, 3 where the viewer cannot draw."""
    match words:
        case ["site", folder]:
            make_site(Path(folder).resolve())
        case ["pictures", *names]:
            try:
                draw_pictures(names)
            except CannotRender as reason:
                print(f"gallery: {reason}", file=sys.stderr)
                return 3
        case _:
            print("gallery: say site FOLDER, or pictures", file=sys.stderr)
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
