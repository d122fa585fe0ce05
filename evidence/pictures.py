# SPDX-License-Identifier: Apache-2.0
"""The pictures of the visualiser in docs/images, and films of swimmers: `python evidence/pictures.py`.

One picture for each arrangement, and a film: the falling gait at the standard accuracy, with the run at draft accuracy
laid over it where two are compared; few colours keep them small. Films of a course with the pilot, of two swimmers
beside each other, and of a robot whose torque limit is lowered until it cannot follow. Rerun's viewer draws them
without a display; status 3 where it cannot.
"""

import io
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from eel_dynamics.analysis.trim import Lump
from eel_dynamics.model.fins.text import fins_from_text
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_gaits.pilot.goals import path
from eel_gaits.pilot.pilot import Pilot
from eel_studies.pilot.closed_loop import STEP, swim_with
from eel_studies.roll_hold.study import PAIR
from eel_viz.pictures.drawing import Drawing, SideBySide, drawn, drawn_beside
from eel_viz.pictures.film import film
from eel_viz.pictures.render import frames, times
from eel_viz.recording.library import to_rerun
from eel_viz.settings import BLUEPRINTS
from eel_viz.viewer import CannotRender
from PIL import Image

from eel_dynamics import Body, Robot, Run, Scene, Simulation, ballast_for, simulate
from eel_gaits import Law, falling, still, straight

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
MOMENT = 8.3  # s: a strong bend
SIZE, BAR = (1280, 720), 36  # pixels: window, and the empty bar at its top
COLOURS, MOST = 256, 176
COURSE, COURSE_END = [(4.0, 0.0, 0.0), (7.0, 2.0, -0.4), (10.0, 1.5, 0.0)], 23.0  # m; s
BALLAST_AHEAD = 0.07  # m, by which the ballast of an untrimmed hull lies ahead of its place
LIMITS = ((1.0, 3.0), (0.3, 6.0), (0.2, 9.0), (0.1, 12.0))  # N m of a weaker and weaker robot, and until when [s]
LIMITED, TABS = (1080, 640), 60  # pixels of its film: window, and the bar at its top with the tabs
WIDTH = 760  # pixels of that film


def main() -> int:
    """Draw them all; status 3 where the viewer cannot draw."""
    fine, draft = (
        simulate(falling(), accuracy=accuracy, sample_period=0.02, load=True) for accuracy in ("standard", "draft")
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        fine.to_rerun(folder / "falling.rrd", compare=draft)
        course(folder / "course.rrd")
        to_rerun(folder / "servos.rrd", [weakened()], ["eight servos"], blueprint="robot")
        write = partial(write_film, folder=folder)
        try:
            with drawn(folder / "falling.rrd", size=SIZE) as drawing:
                for arrangement in BLUEPRINTS:
                    if arrangement not in ("robot", "sensors"):  # it has none
                        drawing.arrange(arrangement)
                        keep(drawing.png(MOMENT), arrangement)
            with drawn(folder / "falling.rrd", size=(800, 450), bare=True) as drawing:
                write("falling.webp", drawing, fps=10.0, quality=36, start=4.0, end=9.9)
            with drawn(folder / "course.rrd", size=(640, 360), bare=True) as drawing:
                write("pilot.webp", drawing, fps=7.0, quality=36, start=4.0, end=COURSE_END, speed=3.0)
            how: dict[str, Any] = {"sample_period": 0.04, "accuracy": 1e-3, "estimate": False}
            fins = [simulate(falling(), 10.0, fins=fins, **how) for fins in (None, fins_from_text(PAIR))]
            rests = [simulate(still(), 8.0, body=hull, scene=Scene(weight=True), **how) for hull in hulls()]
            for name, runs in (("falling_fins.webp", fins), ("trim.webp", rests)):
                recordings = [folder / f"{side}.rrd" for side in ("left", "right")]
                for run, recording in zip(runs, recordings, strict=True):
                    run.to_rerun(recording)
                with drawn_beside(*recordings, size=(480, 300), bare=True) as beside:
                    write(name, beside, fps=6.0, quality=20)
            with drawn(folder / "servos.rrd", size=LIMITED) as drawing:
                write("servos.webp", drawing, fps=6.0, quality=24, start=2.0, end=LIMITS[-1][1] - STEP, top=TABS)
        except CannotRender as reason:
            print(f"pictures: {reason}", file=sys.stderr)
            return 3
    return 0


def course(recording: Path) -> None:
    """A swim past way points, by the pilot."""
    pilot = Pilot()
    pilot.follow(path(COURSE, 0.5, pilot.settings.limits))
    voyage = swim_with(pilot, COURSE_END, kept_every=2 * STEP)
    assert voyage.run is not None
    voyage.run.to_rerun(recording, goal=[(0.0, 0.0, 0.0), *COURSE])


def weakened() -> Iterator[tuple[str, Any]]:
    """The messages of a robot of eight servos whose torque limit falls as `LIMITS` say."""
    law, robot = straight(), Robot.named("eight_servos")
    simulation = Simulation(law=law, robot=robot.changed(torque_limit=LIMITS[0][0]), accuracy=1e-3)
    time = 0.0
    for limit, end in LIMITS:
        simulation = simulation.copy_with(robot=robot.changed(torque_limit=limit)) if time else simulation
        snapshots = []
        while time < end - 1e-9:
            simulation.advance(time)
            snapshots.append(simulation.observe(load=False))
            time = round(time + STEP, 9)
        yield from messages_of_run(Run.of_snapshots(snapshots, simulation, Law(name=f"torque limit {limit:g} N m")))


def hulls() -> tuple[Body, Body]:
    """The robot's hull with all the ballast that it takes: too far ahead, and where it floats level."""
    light = Body.boyer2010().changed(density=850.0)
    level = ballast_for(light, offset=0.02)
    lump = Lump(light, None, level.mass, level.station - BALLAST_AHEAD, level.length)
    return light.changed(mass_per_length=lump, centre_of_mass_offset=level.trim.offset), level.body


def write_film(
    name: str,
    drawing: Drawing | SideBySide,
    folder: Path,
    *,
    fps: float,
    quality: int,
    start: float | None = None,
    end: float | None = None,
    speed: float = 1.0,
    top: int = 0,
) -> None:
    """Write the film `name` of `drawing`; `folder` takes its pictures. top: pixels that are cut off; then it is no
    wider than `WIDTH`."""
    at = times(drawing, fps=fps, start=start, end=end, speed=speed)
    pictures = frames(drawing, folder, at)
    for picture in pictures if top else ():
        with Image.open(picture) as whole:
            cut = whole.convert("RGB").crop((0, top, whole.width, whole.height))
        cut.resize((WIDTH, WIDTH * cut.height // cut.width), Image.Resampling.LANCZOS).save(picture)
    film(folder, len(at), FOLDER / name, fps=fps, quality=quality)
    tell(FOLDER / name)


def keep(png: bytes, name: str) -> None:
    """Without the empty bar, in few colours: most of them for large areas, the others so that each is near its own."""
    picture = Image.open(io.BytesIO(png)).convert("RGB").crop((0, BAR, *SIZE))
    path = FOLDER / f"{name}.png"
    palette, colours = Image.new("P", (1, 1)), []
    for count, method in ((MOST, Image.Quantize.MEDIANCUT), (COLOURS - MOST, Image.Quantize.MAXCOVERAGE)):
        colours += (picture.quantize(count, method=method).getpalette() or [])[: 3 * count]
    palette.putpalette(colours)
    picture.quantize(palette=palette, dither=Image.Dither.NONE).save(path, optimize=True)
    tell(path)


def tell(path: Path) -> None:
    """Print name and size."""
    print(f"{path.relative_to(FOLDER.parent.parent)}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    sys.exit(main())
