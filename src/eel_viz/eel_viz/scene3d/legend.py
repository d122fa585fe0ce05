# SPDX-License-Identifier: Apache-2.0
"""The legend of the following views: a bar of the torque's colours, and the scale of the arrows.

It stands at the lower edge of the picture, below `camera.CLEAR`, and so never before the swimmer.
"""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.labels import text_labels

DISTANCE = 1.0  # radii, from the eye: so a tangent in the picture is a length in radii
BAR_AT = (-0.54, -0.425)  # tangents: the middle of the bar
BAR_SIZE = (0.30, 0.018)
ARROWS_AT = ((0.19, -0.395), (0.50, -0.395))  # of the load along the body, and at the ends
WAKE_AT = (0.345, -0.45)  # of the wake
STEPS = 33


def log_bar(stream: BatchedStream, stamp: int, *, limit: float, unit: str, name: str) -> None:
    """Log the bar at `stamp` [ns], with the values -limit to +limit."""
    right, up = BAR_AT
    middle = camera.before_eye(DISTANCE, right, up)
    along = np.linspace(-0.5, 0.5, STEPS)[:, None] * BAR_SIZE[0] * camera.RIGHT
    vertices = np.concatenate([middle + along, middle + along + BAR_SIZE[1] * camera.UP])
    k = np.arange(STEPS - 1)
    triangles = np.concatenate([np.stack([k, k + 1, k + STEPS], 1), np.stack([k + 1, k + STEPS + 1, k + STEPS], 1)])
    shades = np.tile(colours.diverging(np.linspace(-1.0, 1.0, STEPS), 1.0), (2, 1))
    mesh = rr.Mesh3D(vertex_positions=vertices, triangle_indices=triangles, vertex_colors=shades)
    stream.log(stamp, f"{entities.LEGEND}/bar", mesh)
    places = [middle + share * BAR_SIZE[0] * camera.RIGHT for share in (-0.5, 0.0, 0.5)]
    stream.log(
        stamp,
        f"{entities.LEGEND}/labels",
        text_labels(rr.Points3D, places, [f"-{limit:g}", f"{name} [{unit}]", f"+{limit:g}"]),
    )


def log_arrow_scale(
    stream: BatchedStream, stamp: int, *, load_scale: float, end_scale: float, wake_scale: float
) -> None:
    """Log what the lengths of arrows and wake mean: `load_scale` [m per N/m], `end_scale`, `wake_scale` [m per N]."""
    at = camera.before_eye(DISTANCE, *WAKE_AT)
    wake = f"momentum to the wake per time (scheme), 1 N: {wake_scale:g} m"
    stream.log(stamp, entities.WAKE_LEGEND, text_labels(rr.Points3D, [at], [wake], [colours.WAKE]))
    texts = [f"1 N/m: {load_scale:g} m", f"1 N: {end_scale:g} m"]
    places = [camera.before_eye(DISTANCE, right, up) for right, up in ARROWS_AT]
    stream.log(
        stamp, f"{entities.LEGEND}/arrows", text_labels(rr.Points3D, places, texts, [colours.TEAL, colours.MAGENTA])
    )
