"""What stands around the swimmer: a water floor with metres, the colour legend, and the path of the head.

The floor is a grid of 12 m by 12 m that jumps along by whole metres, so it has no edge, and sinks by whole metres if
the swimmer comes near; its labels say where it is in the world frame.
"""

import numpy as np
import rerun as rr

from eel_viz import colours, entities

HALF = 6  # m, from the middle of the grid to its edge
CLEARANCE = 0.4  # m, between swimmer and floor at least
LABELLED = 2  # m, from the swimmer to the labels
EYE = np.array((-0.46, -0.92, 0.55))  # m, camera in the frame that follows the swimmer
EYE_TARGET = (0.03, 0.0, -0.05)  # m, where it looks
LEGEND_AT = (0.5, -0.21, -0.2)  # m, from the camera: ahead, to the right, up
LEGEND_SIZE = (0.16, 0.009)  # m


class Water:
    """The floor below the swimmer, the swimmer's shadow on it, and the labels of its metres."""

    def __init__(self, stream: rr.RecordingStream) -> None:
        self._stream = stream
        self._at: tuple[int, int, int] | None = None
        lines, shades = [], []
        for k in range(-2 * HALF, 2 * HALF + 1):
            c = k / 2
            lines += [[(c, -HALF, 0), (c, HALF, 0)], [(-HALF, c, 0), (HALF, c, 0)]]
            shades += [colours.WATER_LINE if k % 2 else colours.WATER_LINE_MAJOR] * 2
        stream.log(entities.GRID, rr.LineStrips3D(lines, colors=shades, radii=rr.Radius.ui_points(0.5)), static=True)
        stream.log(entities.SHADOW, rr.LineStrips3D.from_fields(colors=[(4, 10, 17)], radii=[0.03]), static=True)

    def draw(self, position: np.ndarray) -> None:
        """Floor and shadow for a backbone `position`, (M, 3) [m]."""
        middle = position.mean(axis=0)
        x, y = (int(np.floor(value)) for value in middle[:2])
        floor = -1 if self._at is None else self._at[2]
        while float(position[:, 2].min()) - CLEARANCE < floor:
            floor -= 1
        if self._at != (x, y, floor):
            self._at = (x, y, floor)
            self._place(x, y, floor)
        shadow = np.array(position[:: max(1, len(position) // 24)], dtype=np.float32)
        shadow[:, 2] = floor + 0.002
        self._stream.log(entities.SHADOW, rr.LineStrips3D.from_fields(strips=[shadow]))

    def _place(self, x: int, y: int, floor: int) -> None:
        self._stream.log(entities.GRID, rr.Transform3D(translation=(x, y, floor)))
        right, front = x + LABELLED, y - 1  # where they do not stand before the swimmer, as the camera looks at first
        places = [(i, front, floor) for i in range(x - LABELLED, right)] + [
            (right, j, floor) for j in range(front, y + 4)
        ]
        texts = [f"x {i} m" for i in range(x - LABELLED, right)] + [f"y {j} m" for j in range(front, y + 4)]
        texts[places.index((right, front, floor))] = f"x {right}, y {front}, z {floor} m"
        self._stream.log(
            entities.GRID_LABELS,
            rr.Points3D(
                places,
                labels=texts,
                show_labels=True,
                radii=rr.Radius.ui_points(2.0),
                colors=[colours.WATER_LABEL] * len(texts),
            ),
        )


def log_legend(stream: rr.RecordingStream, *, limit: float, unit: str, name: str) -> None:
    """A bar of the skin's colours in the lower left corner of the following view, as its camera stands at first."""
    ahead = _unit(np.subtract(EYE_TARGET, EYE))
    right = _unit(np.cross(ahead, (0.0, 0.0, 1.0)))
    up = np.cross(right, ahead)
    steps = 33
    middle = EYE + LEGEND_AT[0] * ahead + LEGEND_AT[1] * right + LEGEND_AT[2] * up
    along = np.linspace(-0.5, 0.5, steps)[:, None] * LEGEND_SIZE[0] * right
    vertices = np.concatenate([middle + along, middle + along + LEGEND_SIZE[1] * up])
    k = np.arange(steps - 1)
    triangles = np.concatenate([np.stack([k, k + 1, k + steps], 1), np.stack([k + 1, k + steps + 1, k + steps], 1)])
    shades = np.tile(colours.diverging(np.linspace(-1.0, 1.0, steps), 1.0), (2, 1))
    stream.log(
        f"{entities.LEGEND}/bar",
        rr.Mesh3D(vertex_positions=vertices, triangle_indices=triangles, vertex_colors=shades),
        static=True,
    )
    places = [middle + share * LEGEND_SIZE[0] * right for share in (-0.5, 0.0, 0.5)]
    texts = [f"-{limit:g}", f"{name} [{unit}]", f"+{limit:g}"]
    stream.log(
        f"{entities.LEGEND}/labels",
        rr.Points3D(places, labels=texts, show_labels=True, radii=rr.Radius.ui_points(0.1), colors=[colours.LABEL] * 3),
        static=True,
    )


class Track:
    """The path of the head: one short line a frame, which views add up from the start to the cursor."""

    def __init__(self, stream: rr.RecordingStream) -> None:
        self._stream = stream
        self._last: np.ndarray | None = None
        stream.log(
            entities.TRACK,
            rr.LineStrips3D.from_fields(colors=[colours.AMBER], radii=[rr.Radius.ui_points(1.3)]),
            static=True,
        )

    def draw(self, position: np.ndarray) -> None:
        """Go on to `position`, (3,) [m]."""
        if self._last is not None:
            self._stream.log(entities.TRACK, rr.LineStrips3D.from_fields(strips=[np.stack([self._last, position])]))
        self._last = np.array(position)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)
