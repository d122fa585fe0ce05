# SPDX-License-Identifier: Apache-2.0
"""The pictures of the visualiser in docs/images, and films of swimmers: `python evidence/pictures.py [NAME ...]`.

One picture for each arrangement, and a film: the falling gait at the standard accuracy, with the run at draft accuracy
laid over it where two are compared; few colours keep them small. Films of a course with the pilot, of two swimmers
beside each other, in moving water, and of a robot whose torque limit is lowered until it cannot follow. Rerun's viewer
draws them without a display; status 3 where it cannot.
"""

import io
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from eel_common.wording import not_one_of
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

from eel_dynamics import Body, Robot, Run, Scene, Simulation, VortexStreet, Wave, ballast_for, simulate
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
COARSE: dict[str, Any] = {"sample_period": 0.04, "accuracy": 1e-3, "estimate": False}
FLOWS = {  # of docs/howto/flow.md: name of the film, and the water
    "flow_street": VortexStreet(circulation=0.25, core=0.4, spacing=1.6, width=0.45, start=(1.0, 0.0, 0.0)),
    "flow_wave": Wave(amplitude=0.1, wavelength=3.0, surface=0.6),
}


def main(names: list[str]) -> int:
    """Draw those named, or all; status 2 for an unknown name, 3 where the viewer cannot draw."""
    for name in names:
        if name not in MADE:
            print(f"pictures: {not_one_of('name', name, MADE)}", file=sys.stderr)
            return 2
    try:
        for name in names or MADE:
            with tempfile.TemporaryDirectory() as folder:
                MADE[name](Path(folder))
    except CannotRender as reason:
        print(f"pictures: {reason}", file=sys.stderr)
        return 3
    return 0


def arrangements(folder: Path) -> None:
    """A picture of each arrangement, but of those that a body without motors and sensors has not."""
    fine, draft = falls("standard"), falls("draft")
    fine.to_rerun(folder / "falling.rrd", compare=draft)
    with drawn(folder / "falling.rrd", size=SIZE) as drawing:
        for arrangement in BLUEPRINTS:
            if arrangement not in ("robot", "sensors"):
                drawing.arrange(arrangement)
                keep(drawing.png(MOMENT), arrangement)


def falling_alone(folder: Path) -> None:
    """The film of the README."""
    falls("standard").to_rerun(folder / "falling.rrd")
    with drawn(folder / "falling.rrd", size=(800, 450), bare=True) as drawing:
        write_film("falling.webp", drawing, folder, fps=10.0, quality=36, start=4.0, end=9.9)


def piloted(folder: Path) -> None:
    """A course with the pilot."""
    course(folder / "course.rrd")
    with drawn(folder / "course.rrd", size=(640, 360), bare=True) as drawing:
        write_film("pilot.webp", drawing, folder, fps=7.0, quality=36, start=4.0, end=COURSE_END, speed=3.0)


def with_fins(folder: Path) -> None:
    """The falling gait without fins, and with fins that hold the roll."""
    runs = [simulate(falling(), 10.0, fins=fins, **COARSE) for fins in (None, fins_from_text(PAIR))]
    write_beside("falling_fins.webp", runs, folder)


def trimmed(folder: Path) -> None:
    """A hull at rest out of trim, and in trim."""
    runs = [simulate(still(), 8.0, body=hull, scene=Scene(weight=True), **COARSE) for hull in hulls()]
    write_beside("trim.webp", runs, folder)


def motors(folder: Path) -> None:
    """A robot that weakens, with its motors."""
    to_rerun(folder / "servos.rrd", [weakened()], ["eight servos"], blueprint="robot")
    with drawn(folder / "servos.rrd", size=LIMITED) as drawing:
        end = LIMITS[-1][1] - STEP
        write_film("servos.webp", drawing, folder, fps=6.0, quality=24, start=2.0, end=end, top=TABS)


def moving_water(folder: Path) -> None:
    """A swimmer in a street of vortices, and one below a wave."""
    for name, flow in FLOWS.items():
        simulate(straight(), 8.0, flow=flow, **COARSE).to_rerun(folder / f"{name}.rrd")
        with drawn(folder / f"{name}.rrd", size=(640, 410), bare=True) as drawing:
            write_film(f"{name}.webp", drawing, folder, fps=7.0, quality=30, start=2.0, end=7.9)


MADE: dict[str, Callable[[Path], None]] = {  # name: what draws it, given a folder for its own files
    "arrangements": arrangements,
    "falling": falling_alone,
    "pilot": piloted,
    "fins": with_fins,
    "trim": trimmed,
    "servos": motors,
    "flow": moving_water,
}


def falls(accuracy: str) -> Run:
    """The falling gait."""
    return simulate(falling(), accuracy=accuracy, sample_period=0.02, load=True)


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


def write_beside(name: str, runs: list[Run], folder: Path) -> None:
    """Write the film `name` of two `runs` beside each other."""
    recordings = [folder / f"{side}.rrd" for side in ("left", "right")]
    for run, recording in zip(runs, recordings, strict=True):
        run.to_rerun(recording)
    with drawn_beside(*recordings, size=(480, 300), bare=True) as beside:
        write_film(name, beside, folder, fps=6.0, quality=18)


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
    sys.exit(main(sys.argv[1:]))
