"""Draws the surroundings of the swimmer: a floor with a grid in metres, and the colour legend.

The floor is a grid of 12 m by 12 m. It follows the swimmer in steps of 1 m, and sinks by whole metres if the swimmer
comes near. Its labels give the world coordinates.
"""

from functools import lru_cache

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import camera, colours

HALF = 6  # m, from the middle of the grid to its edge
CLEARANCE = 0.4  # m, between swimmer and floor at least
LABEL_SIZE = (0.15, 0.085)  # half of a label with the swimmer's thickness, as tangents in the picture
LEGEND_AT = (0.5, -0.21, -0.2)  # m, from the camera: ahead, to the right, up
LEGEND_SIZE = (0.16, 0.009)  # m


class Water:
    """Draws the floor below the swimmer, the swimmer's shadow on it, and the labels of the grid."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._at: tuple[int, int, int] | None = None
        self._labelled: dict[tuple[int, int, int], str] = {}
        lines, shades = [], []
        for k in range(-2 * HALF, 2 * HALF + 1):
            c = k / 2
            lines += [[(c, -HALF, 0), (c, HALF, 0)], [(-HALF, c, 0), (HALF, c, 0)]]
            shades += [colours.WATER_LINE if k % 2 else colours.WATER_LINE_MAJOR] * 2
        stream.log_static(entities.GRID, rr.LineStrips3D(lines, colors=shades, radii=rr.Radius.ui_points(0.5)))
        stream.log_static(entities.SHADOW, rr.LineStrips3D.from_fields(colors=[(4, 10, 17)], radii=[0.03]))

    def draw(self, stamp: int, position: np.ndarray, middle: np.ndarray) -> None:
        """Draw floor, shadow and labels at `stamp` [ns].

        position: of the backbone, (M, 3) [m]. middle: the point that the camera follows, (3,) [m].
        """
        x, y = (int(np.floor(value)) for value in middle[:2])
        floor = -1 if self._at is None else self._at[2]
        while float(position[:, 2].min()) - CLEARANCE < floor:
            floor -= 1
        if self._at != (x, y, floor):
            self._at = (x, y, floor)
            self._stream.log(stamp, entities.GRID, rr.Transform3D(translation=self._at))
        shadow = np.array(position[:: max(1, len(position) // 24)], dtype=np.float32)
        shadow[:, 2] = floor + 0.002
        self._stream.add_row(stamp, entities.SHADOW, rr.LineStrips3D, strips=shadow[None])
        labels = _clear_labels(*_labels(x, y, floor), position - middle, middle)
        if labels != self._labelled:
            self._labelled = labels
            self._label(stamp, labels)

    def _label(self, stamp: int, labels: dict[tuple[int, int, int], str]) -> None:
        self._stream.log(
            stamp,
            entities.GRID_LABELS,
            rr.Points3D(
                list(labels),
                labels=list(labels.values()),
                show_labels=True,
                radii=rr.Radius.ui_points(2.0),
                colors=[colours.WATER_LABEL] * len(labels),
            ),
        )


@lru_cache(maxsize=4)
def _labels(x: int, y: int, floor: int) -> tuple[dict[tuple[int, int, int], str], np.ndarray]:
    """Labels by their places [m] on the floor around (x, y): a row of x, a row of y, a corner with x, y and z. Also the
    places as an array (N, 3)."""
    right, far = x + 2, y + 4
    row = {(i, far, floor): f"x {i} m" for i in range(right - 5, right)}
    column = {(right, j, floor): f"y {j} m" for j in range(y - 1, far)}
    labels = {**row, **column, (right, far, floor): f"x {right}, y {far}, z {floor} m"}
    return labels, np.array(list(labels), dtype=float)


def _clear_labels(labels: dict, places: np.ndarray, swimmer: np.ndarray, middle: np.ndarray) -> dict:
    """Those of `labels` at `places`, (N, 3) [m], that do not overlap the swimmer in the picture.

    swimmer: positions of the backbone relative to `middle`, (M, 3) [m].
    """
    apart = np.abs(camera.in_picture(places - middle)[:, None] - camera.in_picture(swimmer))
    hidden = ((apart <= LABEL_SIZE).all(axis=2)).any(axis=1)
    return {place: text for (place, text), behind in zip(labels.items(), hidden.tolist(), strict=True) if not behind}


def log_legend(stream: BatchedStream, *, limit: float, unit: str, name: str) -> None:
    """Log a bar of the skin's colours: in the lower left corner of the following view at its initial camera pose."""
    steps = 33
    middle = camera.before_eye(*LEGEND_AT)
    along = np.linspace(-0.5, 0.5, steps)[:, None] * LEGEND_SIZE[0] * camera.RIGHT
    vertices = np.concatenate([middle + along, middle + along + LEGEND_SIZE[1] * camera.UP])
    k = np.arange(steps - 1)
    triangles = np.concatenate([np.stack([k, k + 1, k + steps], 1), np.stack([k + 1, k + steps + 1, k + steps], 1)])
    shades = np.tile(colours.diverging(np.linspace(-1.0, 1.0, steps), 1.0), (2, 1))
    stream.log_static(
        f"{entities.LEGEND}/bar",
        rr.Mesh3D(vertex_positions=vertices, triangle_indices=triangles, vertex_colors=shades),
    )
    places = [middle + share * LEGEND_SIZE[0] * camera.RIGHT for share in (-0.5, 0.0, 0.5)]
    texts = [f"-{limit:g}", f"{name} [{unit}]", f"+{limit:g}"]
    stream.log_static(
        f"{entities.LEGEND}/labels",
        rr.Points3D(places, labels=texts, show_labels=True, radii=rr.Radius.ui_points(0.1), colors=[colours.LABEL] * 3),
    )
