# SPDX-License-Identifier: Apache-2.0
"""The legend of the following views: a bar of the torque's colours, and the meaning of arrows and ribbon.

It stands at the lower edge of the picture, below `camera.CLEAR`, so it never covers the swimmer.
"""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.colours import Colour
from eel_viz.scene3d.lettering import standing_texts
from eel_viz.scene3d.skin import tiles

DISTANCE = 1.0  # radii, from the eye: so a tangent in the picture is a length in radii
BAR_AT = (-0.50, -0.425)  # tangents: the middle of the bar
BAR_SIZE = (0.27, 0.018)
WORDS_AT = -0.42  # tangent: the height of the words
FORCE_AT, ENDS_AT, WAKE_AT = -0.06, 0.27, 0.51  # tangents: the middles of the words
FLOW_AT = (0.2, -0.38)  # tangents: the middle of the words on moving water, above the others
PARTS_AT, RINGS_AT, BALLS_AT = -0.455, 0.30, -0.36  # tangents: the height of the words below, and the middles of
# those of the rings and of the balls
LETTERS = 0.020  # tangent: height of a capital
BAND = (-0.60, -0.365)  # tangents: lower and upper edge of the ground of the legend
STEPS = 33
MILLI = 0.01  # below this limit the bar tells thousandths of its unit


def log_bar(stream: BatchedStream) -> None:
    """Log the bar and its background, for all times."""
    middle = camera.before_eye(DISTANCE, *BAR_AT)
    along = np.linspace(-0.5, 0.5, STEPS)[:, None] * BAR_SIZE[0] * camera.RIGHT
    vertices = np.concatenate([middle + along, middle + along + BAR_SIZE[1] * camera.UP])
    k = np.arange(STEPS - 1)
    triangles = np.concatenate([np.stack([k, k + 1, k + STEPS], 1), np.stack([k + 1, k + STEPS + 1, k + STEPS], 1)])
    shades = np.tile(colours.diverging(np.linspace(-1.0, 1.0, STEPS), 1.0), (2, 1))
    mesh = rr.Mesh3D(vertex_positions=vertices, triangle_indices=triangles, vertex_colors=shades)
    stream.log_static(f"{entities.LEGEND}/bar", mesh)
    corners = [camera.before_eye(1.02 * DISTANCE, right, up) for up in BAND for right in (-2.0, 2.0)]
    band = rr.Mesh3D(vertex_positions=corners, triangle_indices=tiles(2, 2), albedo_factor=colours.WATER_BACKGROUND)
    stream.log_static(f"{entities.LEGEND}/band", band)


def log_limit(stream: BatchedStream, stamp: int, *, limit: float, unit: str, name: str) -> None:
    """Log the bar's range from `stamp` [ns] on: the values -limit to +limit of the quantity `name`."""
    if limit < MILLI:
        limit, unit = 1e3 * limit, f"m{unit}"
    under = camera.before_eye(DISTANCE, *BAR_AT) - 1.3 * LETTERS * camera.UP
    places = [under + share * BAR_SIZE[0] * camera.RIGHT for share in (-0.5, 0.0, 0.5)]
    stream.log(
        stamp,
        f"{entities.LEGEND}/labels",
        _written(places, [f"-{limit:g}", f"{name} [{unit}]", f"+{limit:g}"]),
    )


def log_words(stream: BatchedStream, stamp: int) -> None:
    """Log the meaning of arrows and ribbon, in their colours."""
    arrows = (FORCE_AT, "force of the water", colours.FORCE), (ENDS_AT, "nose and tail", colours.ENDS)
    stream.log(stamp, f"{entities.LEGEND}/arrows", _words(WORDS_AT, arrows))
    stream.log(stamp, entities.WAKE_LEGEND, _words(WORDS_AT, [(WAKE_AT, "wake", colours.WAKE)]))


def log_flow(stream: BatchedStream, stamp: int, longest: str) -> None:
    """Log what the arrows of the water are, and the speed that the longest of them stands for."""
    words = f"water without the swimmer, longest {longest}"
    stream.log(stamp, entities.FLOW_LEGEND, _words(FLOW_AT[1], [(FLOW_AT[0], words, colours.FLOW)]))


def log_parts(stream: BatchedStream, *, fins: bool, joints: bool, appendages: bool) -> None:
    """Log the meaning of plates, rings and balls, below the other words, for all times."""
    words = {
        (FORCE_AT, "fins", colours.FIN): fins,
        (RINGS_AT, "joints, red at the limit", colours.LABEL): joints,
        (BALLS_AT, "appendages", colours.APPENDAGE): appendages,
    }
    shown = [each for each, there in words.items() if there]
    stream.log_static(f"{entities.LEGEND}/parts", _words(PARTS_AT, shown))


def _words(height: float, words: Sequence[tuple[float, str, Colour]]) -> rr.LineStrips3D:
    """Each of the `words` has the tangent of its middle, its text, and its colour."""
    at, texts, shades = zip(*words, strict=True)
    return _written([camera.before_eye(DISTANCE, right, height) for right in at], texts, shades)


def _written(places: list[np.ndarray], texts: Sequence[str], shades: Sequence[Colour] = ()) -> rr.LineStrips3D:
    return standing_texts(places, texts, LETTERS * camera.RIGHT, LETTERS * camera.UP, shades)
