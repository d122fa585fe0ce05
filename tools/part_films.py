# SPDX-License-Identifier: Apache-2.0
"""A robot whose torque limit is lowered until it cannot follow: the film `docs/images/servos.webp` (`make pictures`).

Rerun's viewer draws it; status 3 where it cannot.
"""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_viz.pictures.drawing import Drawing, drawn
from eel_viz.pictures.film import film
from eel_viz.pictures.render import frames, times
from eel_viz.recording.library import to_rerun
from eel_viz.viewer import CannotRender
from PIL import Image

from eel_dynamics import Robot, Run, Simulation
from eel_gaits import Law, straight

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images"
LIMITS = ((1.0, 3.0), (0.3, 6.0), (0.2, 9.0), (0.1, 12.0))  # N m, and until when [s]
STEP = 0.02  # s, between samples
WHOLE = (1080, 640)  # pixels: of a window
WIDTH = 760  # pixels of a film, at most
FPS, QUALITY = 6.0, 24
BAR = 60  # pixels: the empty bar at the top of a window, and its tabs


def weakened() -> Iterator[tuple[str, Any]]:
    """The messages of a robot of eight servos whose torque limit falls as `LIMITS` say."""
    law, robot = straight(), Robot.named("eight_servos")
    simulation = Simulation(law=law, robot=robot.changed(torque_limit=LIMITS[0][0]), accuracy=1e-3)
    time = 0.0
    for limit, end in LIMITS:
        weaker = robot.changed(torque_limit=limit)
        simulation = simulation.copy_with(robot=weaker) if time else simulation
        snapshots = []
        while time < end - 1e-9:
            simulation.advance(time)
            snapshots.append(simulation.observe(load=False))
            time = round(time + STEP, 9)
        yield from messages_of_run(Run.of_snapshots(snapshots, simulation, Law(name=f"torque limit {limit:g} N m")))


def draw(drawing: Drawing, folder: Path, name: str, *, start: float, end: float, top: int = 0) -> None:
    """Write the film `name` of `drawing`, without the `top` pixels of each picture, and print its size."""
    at = times(drawing, fps=FPS, start=start, end=end, speed=1.0)
    for path in frames(drawing, folder, at):
        with Image.open(path) as picture:
            cut = picture.convert("RGB").crop((0, top, picture.width, picture.height))
        size = (WIDTH, WIDTH * cut.height // cut.width) if cut.width > WIDTH else cut.size
        cut.resize(size, Image.Resampling.LANCZOS).save(path)
    film(folder, len(at), FOLDER / name, fps=FPS, quality=QUALITY)
    print(f"docs/images/{name}: {(FOLDER / name).stat().st_size / 1e3:.0f} kB")


def main() -> int:
    """Draw it."""
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            to_rerun(folder / "servos.rrd", [weakened()], ["eight servos"], blueprint="robot")
            with drawn(folder / "servos.rrd", size=WHOLE) as drawing:
                draw(drawing, folder, "servos.webp", start=2.0, end=LIMITS[-1][1] - STEP, top=BAR)
    except CannotRender as reason:
        print(f"part films: {reason}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
