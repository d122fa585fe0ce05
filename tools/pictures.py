# SPDX-License-Identifier: Apache-2.0
"""The pictures of the visualiser in docs/images, one for each arrangement, and a film of the swimmer: `make pictures`.

The falling gait at the standard accuracy, with the run at draft accuracy laid over it where two are compared, drawn by
Rerun's viewer without a display at one moment; few colours keep them small.
"""

import io
import sys
import tempfile
from pathlib import Path

from eel_viz.pictures.drawing import drawn
from eel_viz.pictures.film import film
from eel_viz.pictures.render import frames, times
from eel_viz.settings import BLUEPRINTS
from eel_viz.viewer import CannotRender
from PIL import Image

from eel_dynamics import simulate
from eel_gaits import falling

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images"
MOMENT = 8.3  # s: a strong bend
SIZE, BAR = (1280, 720), 36  # pixels: window, and the empty bar at its top
COLOURS = 256
FILM, FILM_SIZE, FPS, QUALITY = "falling.webp", (800, 450), 10.0, 36
FILMED = (0.4, 8.3)  # s: start and end


def main() -> int:
    """Draw them all; status 3 where the viewer cannot draw."""
    fine, draft = (
        simulate(falling(), accuracy=accuracy, sample_period=0.02, load=True) for accuracy in ("standard", "draft")
    )
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "falling.rrd"
        fine.to_rerun(recording, compare=draft)
        try:
            with drawn(recording, size=SIZE) as drawing:
                for name in BLUEPRINTS:
                    drawing.arrange(name)
                    path = keep(drawing.png(MOMENT), name)
                    tell(path)
            with drawn(recording, size=FILM_SIZE, bare=True) as drawing:
                at = times(drawing, fps=FPS, start=FILMED[0], end=FILMED[1], speed=1.0)
                frames(drawing, Path(folder), at)
            film(folder, len(at), FOLDER / FILM, fps=FPS, quality=QUALITY)
            tell(FOLDER / FILM)
        except CannotRender as reason:
            print(f"pictures: {reason}", file=sys.stderr)
            return 3
    return 0


def tell(path: Path) -> None:
    """Print name and size."""
    print(f"{path.relative_to(FOLDER.parent.parent)}: {path.stat().st_size / 1e3:.0f} kB")


def keep(png: bytes, name: str) -> Path:
    """Without the empty bar, in few colours."""
    picture = Image.open(io.BytesIO(png)).convert("RGB").crop((0, BAR, *SIZE))
    path = FOLDER / f"{name}.png"
    picture.quantize(COLOURS, method=Image.Quantize.MEDIANCUT, kmeans=3).save(path, optimize=True)
    return path


if __name__ == "__main__":
    sys.exit(main())
