# SPDX-License-Identifier: Apache-2.0
"""The pictures of the visualiser in docs/images, and films of the swimmer and of a course: `make pictures`.

What the node `markers` publishes is drawn as RViz would draw it: the skin is shaded, arrows keep their colours, the
midline is black; one square of the grid is 0.1 m. Then come one picture for each arrangement, and the film: the falling
gait at the standard accuracy, with the run at draft accuracy laid over it where two are compared, drawn by Rerun's
viewer without a display at one moment; few colours keep them small.
"""

import io
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace as NS
from typing import Any

import numpy as np
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_gaits.pilot.goals import path
from eel_gaits.pilot.pilot import Pilot
from eel_gym.episode_recording import STACKED
from eel_studies.pilot.closed_loop import STEP, swim_with
from eel_viz.messages import read_backbone, read_body, read_load, read_wrench
from eel_viz.pictures.drawing import drawn
from eel_viz.pictures.film import film
from eel_viz.pictures.render import frames, times
from eel_viz.recording.library import to_rerun
from eel_viz.ros.marker_messages import ForceMarkers, SkinMarker, midline
from eel_viz.settings import BLUEPRINTS, MarkerSettings
from eel_viz.viewer import CannotRender
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from PIL import Image
from std_msgs.msg import Header
from visualization_msgs.msg import Marker

from eel_dynamics import Run, Scene, Simulation, simulate
from eel_gaits import Law, falling

FOLDER = Path(__file__).resolve().parent.parent / "docs" / "images"
MOMENT = 8.3  # s: a strong bend
SIZE, BAR = (1280, 720), 36  # pixels: window, and the empty bar at its top
COLOURS = 256
FILM, FILM_SIZE, FPS, QUALITY = "falling.webp", (800, 450), 10.0, 36
FILMED = (4.0, 9.9)  # s: start and end
COURSE_FILM, COURSE_SIZE, COURSE_FPS, COURSE_SPEED = "pilot.webp", (640, 360), 7.0, 3.0  # the last: of the film's time
COURSE, COURSE_START, COURSE_END = [(4.0, 0.0, 0.0), (7.0, 2.0, -0.4), (10.0, 1.5, 0.0)], 4.0, 23.0  # m; s
SQUARE, BACKGROUND = 0.1, "#303030"  # m; RViz's own colour
SIDES, PARTS, HEAD = 8, 8, 0.23  # of an arrow: sides, parts of its shaft, RViz's length of its head by its own


def main() -> int:
    """Draw them all; status 3 where the viewer cannot draw."""
    draw_markers(FOLDER / "markers.png")
    fine, draft = (
        simulate(falling(), accuracy=accuracy, sample_period=0.02, load=True) for accuracy in ("standard", "draft")
    )
    tell(FOLDER / "markers.png")
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "falling.rrd"
        fine.to_rerun(recording, compare=draft)
        try:
            with drawn(recording, size=SIZE) as drawing:
                for name in BLUEPRINTS:
                    drawing.arrange(name)
                    tell(keep(drawing.png(MOMENT), name))
            with drawn(recording, size=FILM_SIZE, bare=True) as drawing:
                at = times(drawing, fps=FPS, start=FILMED[0], end=FILMED[1], speed=1.0)
                frames(drawing, Path(folder), at)
            film(folder, len(at), FOLDER / FILM, fps=FPS, quality=QUALITY)
            tell(FOLDER / FILM)
            draw_course(Path(folder))
            tell(FOLDER / COURSE_FILM)
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
    columns: dict[str, Any] = {name: np.array([getattr(each, name) for each in snapshots]) for name in STACKED}
    setup = simulations[0].setup
    swum = Run(
        law=Law(name="pilot"),
        body=setup.body,
        scene=setup.scene,
        accuracy=simulations[0].accuracy,
        x=setup.x,
        energy=None,
        steps=0,
        evaluations=0,
        nodes=0,
        **columns,
    )
    points = [NS(pose=NS(position=NS(x=x, y=y, z=z))) for x, y, z in [(0.0, 0.0, 0.0), *COURSE]]
    messages = [("goal", NS(poses=points)), *messages_of_run(swum)]
    recording = folder / "course.rrd"
    to_rerun(recording, [messages], ["pilot"])
    with drawn(recording, size=COURSE_SIZE, bare=True) as drawing:
        at = times(drawing, fps=COURSE_FPS, start=COURSE_START, end=COURSE_END, speed=COURSE_SPEED)
        frames(drawing, folder, at)
    film(folder, len(at), FOLDER / COURSE_FILM, fps=COURSE_FPS, quality=QUALITY)


def tell(path: Path) -> None:
    """Print name and size."""
    print(f"{path.relative_to(FOLDER.parent.parent)}: {path.stat().st_size / 1e3:.0f} kB")


def keep(png: bytes, name: str) -> Path:
    """Without the empty bar, in few colours."""
    picture = Image.open(io.BytesIO(png)).convert("RGB").crop((0, BAR, *SIZE))
    path = FOLDER / f"{name}.png"
    picture.quantize(COLOURS, method=Image.Quantize.MEDIANCUT, kmeans=3).save(path, optimize=True)
    return path


def draw_markers(file: Path) -> None:
    """What the node `markers` makes of the falling gait at the moment. All triangles are one collection, so that near
    ones hide those behind."""
    topics = dict(messages_of_run(simulate(falling(), MOMENT, sample_period=MOMENT, load=True)))
    backbone, settings = read_backbone(topics["backbone"]), MarkerSettings()
    skin = SkinMarker(read_body(topics["body"]), settings.colour_limit)
    shown = skin.marker(Header(), backbone, read_wrench(topics["internal_wrench"]))
    shapes = [triples(shown.points).reshape(-1, 3, 3)]
    colours = [np.array([(each.r, each.g, each.b) for each in shown.colors]).reshape(-1, 3, 3).mean(axis=1)]
    for arrow in ForceMarkers(settings).markers(Header(), backbone, read_load(topics["hydrodynamic_load"])):
        if arrow.action == Marker.ADD:
            start, end = triples(arrow.points)
            shapes.append(corners_of(start, end, arrow.scale.x, arrow.scale.y))
            colours.append(np.tile((arrow.color.r, arrow.color.g, arrow.color.b), (len(shapes[-1]), 1)))
    corners = np.concatenate(shapes)
    light: dict[str, Any] = {
        "shade": True,
        "lightsource": LightSource(azdeg=300.0, altdeg=60.0),
        "zorder": 3,
        "clip_on": False,
    }
    figure = Figure(figsize=(9.6, 5.4), facecolor=BACKGROUND)
    axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d", facecolor=BACKGROUND, computed_zorder=False)
    axes.add_collection3d(Poly3DCollection(corners, facecolors=np.concatenate(colours), **light))
    line = triples(pose.pose.position for pose in midline(Header(), backbone).poses)
    axes.plot(*line.T, color="black", linewidth=1.0, zorder=4, clip_on=False)
    low = SQUARE * np.floor(corners.min(axis=(0, 1)) / SQUARE)
    high = SQUARE * np.ceil(corners.max(axis=(0, 1)) / SQUARE)
    x, y = np.meshgrid(*(np.arange(low[k], high[k] + 0.5 * SQUARE, SQUARE) for k in (0, 1)))
    below = np.full_like(x, low[2])  # the grid
    axes.plot_wireframe(x, y, below, color="#707070", linewidth=0.6, zorder=1, clip_on=False)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.45)
    axes.view_init(elev=62.0, azim=-70.0)
    axes.set_axis_off()
    figure.savefig(file, dpi=100, facecolor=BACKGROUND)


def corners_of(start: np.ndarray, end: np.ndarray, shaft: float, head: float) -> np.ndarray:
    """Corners (n, 3, 3) [m] of an arrow as RViz draws it; `shaft` and `head` are diameters [m]."""
    along = end - start
    side = np.cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 * np.linalg.norm(along) else (1.0, 0.0, 0.0))
    side /= max(np.linalg.norm(side), 1e-12)
    up = np.cross(along, side) / max(np.linalg.norm(along), 1e-12)
    angles = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    circle = 0.5 * (np.outer(np.cos(angles), side) + np.outer(np.sin(angles), up))
    neck = 1.0 - HEAD
    radii = [*((neck * k / PARTS, shaft) for k in range(PARTS + 1)), (neck, head), (1.0, 0.0)]
    rings = np.array([start + place * along + diameter * circle for place, diameter in radii])
    a, b, c, d = rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1]
    return np.stack((a, b, c, a, c, d), axis=2).reshape(-1, 3, 3)


def triples(points) -> np.ndarray:
    """Points as rows (n, 3)."""
    return np.array([(point.x, point.y, point.z) for point in points])


if __name__ == "__main__":
    sys.exit(main())
