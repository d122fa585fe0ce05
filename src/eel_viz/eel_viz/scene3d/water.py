# SPDX-License-Identifier: Apache-2.0
"""Draws the water around a frame of `camera`: a floor with light on it, two walls behind the swimmer, and scales.

The floor's light is a pattern that stands still in the world. It and the walls fade into the water with the distance.
The floor's lines lie at round coordinates of the world, those of the walls at round depths.
Every second one has a label: x and y along the floor, the depth (-z) along an upright edge. The
box follows the frame by whole meshes, and takes the mesh that fits the frame's radius.
"""

from typing import Any

import numpy as np
import rerun as rr

from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.labels import text_labels

MESHES = (1.0, 2.5, 5.0, 10.0)  # possible widths of a mesh, times a power of ten
MESHES_IN_RADIUS = 1.4  # at least, where the mesh is chosen
KEPT = (1.2, 5.0)  # meshes in the radius, between which the mesh stays
ASIDE, ABOVE, BELOW = 2.4, 0.9, 1.0  # how far the box reaches from the centre at least [radii]
LAG = 1.5  # meshes: how far the centre moves before the box follows
LABEL_SIZE = (0.15, 0.085)  # half of a label with the swimmer's thickness, as tangents in the picture
APART = (0.20, 0.065)  # labels nearer than this would overlap, as tangents in the picture of a small view
LABELLED = (1.3 * camera.EDGE, 0.93 * camera.EDGE)  # the part of the picture that has labels, as tangents
TILES = 21  # vertices of the floor along each side
FACE = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, TILES)], indexing="ij"), axis=-1).reshape(
    -1, 2
)  # along, across
EDGE = np.flatnonzero(FACE[:, 1] % 1.0 == 0.0)  # of a wall: its lower and upper edge alone
MARK = 1.5  # pixels: the dot below a label
GRID, LABELS, WALLS = "grid", "labels", "walls"

Labels = dict[tuple[float, float, float], str]  # texts by their places [m]


class WaterBox:
    """Draws the box of one frame into the entities below `root`."""

    def __init__(self, stream: BatchedStream, root: str) -> None:
        self._stream, self._root = stream, root
        self._mesh = 0.0  # m
        self._anchor = np.zeros(3)  # the middle of the box, in meshes
        self._box: tuple[tuple[float, ...], ...] | None = None
        self._all_labels: Labels = {}  # of the box
        self._labels: Labels = {}  # those that are drawn
        triangles = [_tiles(TILES, TILES), *(TILES**2 + k * len(EDGE) + _tiles(TILES, 2) for k in range(2))]
        stream.log_static(f"{root}/{WALLS}", rr.Mesh3D.from_fields(triangle_indices=np.concatenate(triangles)))
        stream.log_static(f"{root}/{GRID}", rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(0.5)))

    @property
    def floor(self) -> float:
        """Height z of the floor [m]."""
        return 0.0 if self._box is None else self._box[0][2]

    def draw(self, stamp: int, centre: np.ndarray, radius: float, swimmer: np.ndarray) -> None:
        """Draw the box at `stamp` [ns] around a frame, without labels that would cover the `swimmer`, (M, 3) [m]."""
        self._place(centre, radius)
        reach = radius / self._mesh
        low = self._anchor - np.ceil(np.array((ASIDE, ASIDE, BELOW)) * reach + LAG)
        high = self._anchor + np.ceil(np.array((ASIDE, ASIDE, ABOVE)) * reach)
        box = tuple(map(tuple, (low * self._mesh, high * self._mesh)))
        if box != self._box:
            self._box = box
            self._draw_grid(stamp, low, high)
            self._draw_walls(stamp, low * self._mesh, high * self._mesh)
            self._all_labels = self._labels_of(low, high, centre, radius)
        labels = self._clear_labels(centre, radius, swimmer)
        if labels != self._labels:
            self._labels = labels
            self._draw_labels(stamp)

    def _place(self, centre: np.ndarray, radius: float) -> None:
        if not self._mesh or not KEPT[0] <= radius / self._mesh <= KEPT[1]:
            self._mesh = fitting_mesh(radius / MESHES_IN_RADIUS)
            self._anchor = np.round(centre / self._mesh)
        place = centre / self._mesh
        far = np.abs(place - self._anchor) > LAG
        self._anchor = np.where(far, np.round(place), self._anchor)

    def _draw_grid(self, stamp: int, low: np.ndarray, high: np.ndarray) -> None:
        (x0, y0, z0), (x1, y1, _) = low, high
        numbers = [np.arange(start, end + 1) for start, end in zip(low, high, strict=True)]
        strips = [[(k, y0, z0), (k, y1, z0)] for k in numbers[0]] + [[(x0, k, z0), (x1, k, z0)] for k in numbers[1]]
        strips = [[a, b, b] for a, b in strips] + [[(x0, y1, k), (x1, y1, k), (x1, y0, k)] for k in numbers[2][1:]]
        shades = [
            colours.WATER_LINE if k % 2 else colours.WATER_LINE_MAJOR
            for k in np.concatenate([*numbers[:2], numbers[2][1:]])
        ]
        placed: Any = np.array(strips) * self._mesh  # rerun's types have lists of strips alone
        lines = rr.LineStrips3D.from_fields(strips=placed, colors=shades)
        self._stream.log(stamp, f"{self._root}/{GRID}", lines)

    def _draw_walls(self, stamp: int, low: np.ndarray, high: np.ndarray) -> None:
        """Floor, and the walls at the greatest x and y, a little behind the lines."""
        apart = 0.01 * self._mesh
        (x0, y0, z0), (x1, y1, z1) = low - np.array((0, 0, apart)), high + np.array((apart, apart, 0))
        u, v = np.moveaxis(FACE, -1, 0)
        floor = np.stack([x0 + u * (x1 - x0), y0 + v * (y1 - y0), np.full_like(u, z0)], axis=1)
        behind = np.stack([x0 + u * (x1 - x0), np.full_like(u, y1), z0 + v * (z1 - z0)], axis=1)
        beside = np.stack([np.full_like(u, x1), y0 + u * (y1 - y0), z0 + v * (z1 - z0)], axis=1)
        away = np.hypot(u - 0.5, v - 0.5)
        light = np.clip(1.0 - 1.9 * away, 0.0, 1.0) * (0.45 + 0.55 * caustics(floor[:, :2] / self._mesh))
        above, deep = v * np.sin(np.pi * u), np.array(colours.WATER_DEEP)
        faces = [(floor, light, colours.WATER_FLOOR)]
        faces += [(wall[EDGE], above[EDGE], colours.WATER_SHALLOW) for wall in (behind, beside)]
        shades = [deep + lit[:, None] * (np.array(bright) - deep) for _, lit, bright in faces]
        mesh = rr.Mesh3D.from_fields(
            vertex_positions=np.concatenate([places for places, _, _ in faces]).astype(np.float32),
            vertex_colors=np.concatenate(shades).astype(np.uint8),
        )
        self._stream.log(stamp, f"{self._root}/{WALLS}", mesh)

    def _clear_labels(self, centre: np.ndarray, radius: float, swimmer: np.ndarray) -> Labels:
        """The labels that lie in the picture, and cover neither the swimmer nor one another, by their places [m]."""
        labels = self._all_labels
        if not labels:
            return {}
        places = camera.in_picture((np.array(list(labels)) - centre) / radius)
        apart = np.abs(places[:, None] - camera.in_picture((swimmer - centre) / radius))
        above_legend = places[:, 1] >= -camera.CLEAR["down"]
        shown = above_legend & (np.abs(places) <= LABELLED).all(axis=1) & ~(apart <= LABEL_SIZE).all(axis=2).any(axis=1)
        clear: Labels = {}
        kept: list[np.ndarray] = []
        for (place, text), seen, free in zip(labels.items(), places, shown.tolist(), strict=True):
            if free and not any((np.abs(seen - other) <= APART).all() for other in kept):
                clear[place] = text
                kept.append(seen)
        return clear

    def _labels_of(self, low: np.ndarray, high: np.ndarray, centre: np.ndarray, radius: float) -> Labels:
        """All labels of the box between `low` and `high`, each (3,) [meshes]."""
        mesh, floor = self._mesh, low[2]
        x_marks, y_marks, z_marks = (
            [k for k in range(int(start), int(end) + 1) if k % 2 == 0] for start, end in zip(low, high, strict=True)
        )
        labels = {(k * mesh, high[1] * mesh, floor * mesh): f"x {k * mesh:g} m" for k in x_marks if k < high[0] - 1}
        labels |= {(high[0] * mesh, k * mesh, floor * mesh): f"y {k * mesh:g} m" for k in y_marks if k < high[1] - 1}
        edges = np.array([(high[0], k, high[2]) for k in np.arange(low[1], high[1])]) * mesh
        right = camera.in_picture((edges - centre) / radius)[:, 0]
        inside = right <= LABELLED[0]
        if inside.any():  # the upright edge at the far right of the picture
            x, y, _ = edges[inside][int(np.argmax(right[inside]))].tolist()
            labels |= {(x, y, k * mesh): f"depth {0.0 - k * mesh:g} m" for k in z_marks if k > floor}
        return labels

    def _draw_labels(self, stamp: int) -> None:
        shades = [colours.WATER_LABEL] * len(self._labels)
        texts = text_labels(rr.Points3D, list(self._labels), list(self._labels.values()), shades, dot=MARK)
        self._stream.log(stamp, f"{self._root}/{LABELS}", texts)


def _tiles(along: int, across: int) -> np.ndarray:
    """Triangles (T, 3) between `along` rows of `across` vertices."""
    here = (np.arange(along - 1)[:, None] * across + np.arange(across - 1)).reshape(-1, 1)
    return np.asarray(here + np.array((0, across, across + 1, 0, across + 1, 1))).reshape(-1, 3)


def caustics(places: np.ndarray) -> np.ndarray:
    """Brightness, 0 to 1, of light that waves have bundled, at `places` (..., 2) [meshes]: bright seams, dark cells."""
    x, y = np.moveaxis(places, -1, 0)
    waves = [
        np.sin(2.1 * (x * np.cos(turn) + y * np.sin(turn)) + 1.7 * turn * turn) for turn in (0.3, 1.5, 2.6, 3.9, 5.2)
    ]
    return np.asarray(np.clip(1.0 - np.abs(np.sum(waves, axis=0)) / 2.0, 0.0, 1.0))


def fitting_mesh(limit: float) -> float:
    """The greatest round width that is not above `limit` > 0 [m]."""
    decade = 10.0 ** np.floor(np.log10(limit))
    return float(max(width for width in MESHES if width * decade <= limit * (1 + 1e-9)) * decade)
