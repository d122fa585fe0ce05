# SPDX-License-Identifier: Apache-2.0
"""The pictures of the visualiser in docs/images, and films of the swimmer and of a course: `make pictures`.

One picture for each arrangement, and the film: the falling gait at the standard accuracy, with the run at draft
accuracy laid over it where two are compared, drawn by Rerun's viewer without a display at one moment; few colours keep
them small.
"""

import io
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace as NS
from typing import Any

from eel_dynamics.analysis.trim import Lump
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_gaits.pilot.goals import path
from eel_gaits.pilot.pilot import Pilot
from eel_model.fins.text import fins_from_text
from eel_studies.pilot.closed_loop import STEP, swim_with
from eel_studies.roll_hold.study import PAIR
from eel_viz.pictures.drawing import drawn, drawn_beside
from eel_viz.pictures.film import film
from eel_viz.pictures.render import frames, times
from eel_viz.recording.library import to_rerun
from eel_viz.settings import BLUEPRINTS
from eel_viz.viewer import CannotRender
from PIL import Image

from eel_dynamics import Body, Run, Scene, Simulation, ballast_for, simulate
from eel_gaits import Law, falling, still

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images"
MOMENT = 8.3  # s: a strong bend
SIZE, BAR = (1280, 720), 36  # pixels: window, and the empty bar at its top
COLOURS = 256
FILM, FILM_SIZE, FPS, QUALITY = "falling.webp", (800, 450), 10.0, 36
FILMED = (4.0, 9.9)  # s: start and end
COURSE_FILM, COURSE_SIZE, COURSE_FPS, COURSE_SPEED = "pilot.webp", (640, 360), 7.0, 3.0  # the last: of the film's time
COURSE, COURSE_START, COURSE_END = [(4.0, 0.0, 0.0), (7.0, 2.0, -0.4), (10.0, 1.5, 0.0)], 4.0, 23.0  # m; s
BESIDE_SIZE, BESIDE_FPS, BESIDE_QUALITY = (480, 300), 6.0, 20  # of films of two swimmers
BALLAST_AHEAD = 0.07  # m, by which the ballast of an untrimmed hull lies ahead of its place


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
                    if name == "robot":  # it has none
                        continue
                    drawing.arrange(name)
                    tell(keep(drawing.png(MOMENT), name))
            with drawn(recording, size=FILM_SIZE, bare=True) as drawing:
                at = times(drawing, fps=FPS, start=FILMED[0], end=FILMED[1], speed=1.0)
                frames(drawing, Path(folder), at)
            film(folder, len(at), FOLDER / FILM, fps=FPS, quality=QUALITY)
            tell(FOLDER / FILM)
            draw_course(Path(folder))
            tell(FOLDER / COURSE_FILM)
            how: dict[str, Any] = {"sample_period": 0.04, "accuracy": 1e-3, "estimate": False}
            swims = [simulate(falling(), 10.0, fins=fins, **how) for fins in (None, fins_from_text(PAIR))]
            tell(draw_beside("falling_fins.webp", swims, Path(folder)))
            rests = [simulate(still(), 8.0, body=hull, scene=Scene(weight=True), **how) for hull in hulls()]
            tell(draw_beside("trim.webp", rests, Path(folder)))
        except CannotRender as reason:
            print(f"pictures: {reason}", file=sys.stderr)
            return 3
    return 0


def draw_course(folder: Path) -> None:
    """The film of a swim past way points, by the pilot; `folder` takes the recording and the pictures."""
    pilot, snapshots = Pilot(), []
    simulations: list[Simulation] = []
    pilot.follow(path(COURSE, 0.5, pilot.settings.limits))

    def observe(simulation: Simulation) -> None:
        simulations[:] = [simulation]
        if round(simulation.time / STEP) % 2 == 0:
            snapshots.append(simulation.observe())

    swim_with(pilot, COURSE_END, scene=Scene(ledger=False), stations=51, each=observe)
    swum = Run.of_snapshots(snapshots, simulations[0], Law(name="pilot"))
    points = [NS(pose=NS(position=NS(x=x, y=y, z=z))) for x, y, z in [(0.0, 0.0, 0.0), *COURSE]]
    messages = [("goal", NS(poses=points)), *messages_of_run(swum)]
    recording = folder / "course.rrd"
    to_rerun(recording, [messages], ["pilot"])
    with drawn(recording, size=COURSE_SIZE, bare=True) as drawing:
        at = times(drawing, fps=COURSE_FPS, start=COURSE_START, end=COURSE_END, speed=COURSE_SPEED)
        frames(drawing, folder, at)
    film(folder, len(at), FOLDER / COURSE_FILM, fps=COURSE_FPS, quality=QUALITY)


def hulls() -> tuple[Body, Body]:
    """The robot's hull with all the ballast that it takes: too far ahead, and where it floats level."""
    light = Body.boyer2010().changed(density=850.0)
    level = ballast_for(light, offset=0.02)
    lump = Lump(light, None, level.mass, level.station - BALLAST_AHEAD, level.length)
    return light.changed(mass_per_length=lump, centre_of_mass_offset=level.trim.offset), level.body


def draw_beside(name: str, runs: list[Run], folder: Path) -> Path:
    """A film of two `runs`, one beside the other; `folder` takes the recordings and the pictures."""
    recordings = [folder / f"{side}.rrd" for side in ("left", "right")]
    for run, recording in zip(runs, recordings, strict=True):
        run.to_rerun(recording)
    with drawn_beside(*recordings, size=BESIDE_SIZE, bare=True) as drawing:
        at = times(drawing, fps=BESIDE_FPS, start=None, end=None, speed=1.0)
        frames(drawing, folder, at)
    film(folder, len(at), FOLDER / name, fps=BESIDE_FPS, quality=BESIDE_QUALITY)
    return FOLDER / name


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
