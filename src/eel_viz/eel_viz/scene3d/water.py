# SPDX-License-Identifier: Apache-2.0
"""Draws the water around a frame of `camera`: a floor, two walls behind the swimmer, and scales.

Floor and walls fade into the water with distance. The floor's lines lie at round coordinates of the world, the walls'
lines at round depths. Some have a label: x and y along the floor, the depth (-z) along the edge between the walls. The
box follows the frame in steps of whole meshes. The size of its mesh fits the frame's radius.
"""

from typing import Any

import numpy as np
import rerun as rr

from eel_viz.batched_stream import BatchedStream
from eel_viz.scene3d import camera, colours
from eel_viz.scene3d.lettering import standing_texts
from eel_viz.scene3d.skin import tiles

MESHES = (1.0, 2.5, 5.0, 10.0)  # possible widths of a mesh, times a power of ten
MESHES_IN_RADIUS = 1.4  # least number of meshes in the radius when the mesh is chosen
KEPT = (1.2, 5.0)  # meshes in the radius: range in which the mesh is kept
ASIDE, ABOVE, BELOW = 2.4, 0.9, 1.0  # least distances of the box's faces from the centre [radii]
LAG = 1.5  # meshes: movement of the centre before the box follows
LETTERS = 0.085  # height of a label's capitals [radii]
APART = {"x": 0.8, "y": 1.4, "depth": 0.4}  # least distances of labels along an edge [radii]
ALONG = {"x": (1.0, 0, 0), "y": (0, -1.7, 0), "depth": (0, -1.7, 0)}  # letters, on their wall; wider on a slanting one
CORNER = 0.45  # from the corner to the first label of an edge [radii]
LABELLED = 1.1 * camera.EDGE, 0.95 * camera.EDGE  # the part of the picture that has labels, as tangents
TILES = 9  # vertices of the floor along each side
FACE = np.stack(np.meshgrid(*2 * [np.linspace(0.0, 1.0, TILES)], indexing="ij"), axis=-1).reshape(
    -1, 2
)  # along, across
EDGE = np.flatnonzero(FACE[:, 1] % 1.0 == 0.0)  # of a wall: only its lower and upper edge
GRID, LABELS, WALLS, FLOOR = "grid", "labels", "walls", "floor"


class WaterBox:
    """Draws the box of one frame into the entities below `root`."""

    def __init__(self, stream: BatchedStream, root: str) -> None:
        self._stream, self._root = stream, root
        self._mesh = 0.0  # m
        self._anchor = np.zeros(3)  # the middle of the box, in meshes
        self._box: tuple[tuple[float, ...], ...] | None = None
        walls = [k * len(EDGE) + tiles(TILES, 2) for k in range(2)]
        stream.log_static(f"{root}/{WALLS}", rr.Mesh3D.from_fields(triangle_indices=np.concatenate(walls)))
        stream.log_static(f"{root}/{FLOOR}", rr.Mesh3D.from_fields(triangle_indices=tiles(TILES, TILES)))
        stream.log_static(f"{root}/{GRID}", rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(0.5)))

    @property
    def floor(self) -> float:
        """Height z of the floor [m]."""
        return 0.0 if self._box is None else self._box[0][2]

    def draw(self, stamp: int, centre: np.ndarray, radius: float) -> None:
        """Draw the box at `stamp` [ns] around a frame, as far as it has changed."""
        self._place(centre, radius)
        reach = radius / self._mesh
        low = self._anchor - np.ceil(np.array((ASIDE, ASIDE, BELOW)) * reach + LAG)
        high = self._anchor + np.ceil(np.array((ASIDE, ASIDE, ABOVE)) * reach)
        box = tuple(map(tuple, (low * self._mesh, high * self._mesh)))
        if box != self._box:
            self._box = box
            self._draw_grid(stamp, low, high)
            self._draw_faces(stamp, low * self._mesh, high * self._mesh)
            self._draw_labels(stamp, low, high, centre, radius)

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
        placed: Any = np.array(strips) * self._mesh  # rerun's types allow only lists of strips
        lines = rr.LineStrips3D.from_fields(strips=placed, colors=shades)
        self._stream.log(stamp, f"{self._root}/{GRID}", lines)

    def _draw_faces(self, stamp: int, low: np.ndarray, high: np.ndarray) -> None:
        """Floor, and the walls at the greatest x and y, a little behind the lines."""
        apart = 0.01 * self._mesh
        (x0, y0, z0), (x1, y1, z1) = low - np.array((0, 0, apart)), high + np.array((apart, apart, 0))
        u, v = np.moveaxis(FACE, -1, 0)
        floor = np.stack([x0 + u * (x1 - x0), y0 + v * (y1 - y0), np.full_like(u, z0)], axis=1)
        behind = np.stack([x0 + u * (x1 - x0), np.full_like(u, y1), z0 + v * (z1 - z0)], axis=1)
        beside = np.stack([np.full_like(u, x1), y0 + u * (y1 - y0), z0 + v * (z1 - z0)], axis=1)
        lit = np.clip(1.0 - 1.8 * np.hypot(u - 0.5, v - 0.5), 0.0, 1.0)
        self._log_mesh(stamp, FLOOR, floor, lit, colours.WATER_FLOOR)
        above = np.tile((v * np.sin(np.pi * u))[EDGE], 2)
        self._log_mesh(stamp, WALLS, np.concatenate([behind[EDGE], beside[EDGE]]), above, colours.WATER_SHALLOW)

    def _log_mesh(self, stamp: int, name: str, places: np.ndarray, lit: np.ndarray, bright: colours.Colour) -> None:
        """Log the mesh `name` with vertices at `places` (n, 3) [m], in the colour `bright` by shares `lit` (n,)."""
        deep = np.array(colours.WATER_DEEP)
        mesh = rr.Mesh3D.from_fields(
            vertex_positions=places.astype(np.float32),
            vertex_colors=(deep + lit[:, None] * (np.array(bright) - deep)).astype(np.uint8),
        )
        self._stream.log(stamp, f"{self._root}/{name}", mesh)

    def _draw_labels(self, stamp: int, low: np.ndarray, high: np.ndarray, centre: np.ndarray, radius: float) -> None:
        """The labels of the box between `low` and `high`, each (3,) [meshes], that lie in the picture."""
        mesh, size, reach = self._mesh, LETTERS * radius, radius / self._mesh
        places, texts, along = [], [], []
        for axis, (name, apart) in enumerate(APART.items()):
            every = next(step for step in (2, 4, 8, 16) if step * mesh >= apart * radius)
            edge = np.array((high[0], high[1], low[2])) * mesh - 0.02 * radius
            first, last = (
                (low[2] + CORNER * reach, high[2]) if name == "depth" else (low[axis], high[axis] - 2 * CORNER * reach)
            )
            for k in np.arange(np.ceil(first / every), last / every) * every:
                edge[axis] = k * mesh
                places.append(edge + ((0, -9.0, 0) if name == "depth" else (0, 0, 1.2)) * np.array(size))
                texts.append(f"{name} {0.0 - k * mesh if name == 'depth' else k * mesh:g} m")
                along.append(size * np.array(ALONG[name]))
        seen = camera.in_picture((np.array(places) - centre) / radius)
        shown = (np.abs(seen) <= LABELLED).all(axis=1) & (seen[:, 1] >= -camera.CLEAR["down"])
        chosen = np.flatnonzero(shown).tolist()
        shades = [colours.WATER_LABEL] * len(chosen)
        letters = standing_texts(
            [places[k] for k in chosen],
            [texts[k] for k in chosen],
            np.array(along)[chosen],
            np.array((0, 0, size)),
            shades,
        )
        self._stream.log(stamp, f"{self._root}/{LABELS}", letters)


def fitting_mesh(limit: float) -> float:
    """The greatest round width that is not above `limit` > 0 [m]."""
    decade = 10.0 ** np.floor(np.log10(limit))
    return float(max(width for width in MESHES if width * decade <= limit * (1 + 1e-9)) * decade)
