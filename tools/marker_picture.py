# SPDX-License-Identifier: Apache-2.0
"""Draws what the node `markers` publishes for the falling gait as RViz would, into docs/images: `make pictures`.

The skin is shaded, arrows keep their colours, the midline is black; one square of the grid is 0.1 m.
"""

from itertools import pairwise

import numpy as np
from eel_dynamics.runs.exchange.records import records
from eel_viz.messages import read_backbone, read_body, read_load, read_wrench
from eel_viz.ros.marker_messages import ForceMarkers, SkinMarker, midline
from eel_viz.settings import MarkerSettings
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from nav_msgs.msg import Path
from pictures import FOLDER, MOMENT, tell
from std_msgs.msg import Header
from visualization_msgs.msg import Marker

from eel_dynamics import simulate
from eel_gaits import falling

SQUARE, BACKGROUND = 0.1, "#303030"  # m; RViz's own colour
FROM = {"elev": 62.0, "azim": -70.0}
SIDES, PARTS, HEAD = 8, 8, 0.23  # of an arrow: sides, parts of its shaft, RViz's length of its head by its own
LIGHT = LightSource(azdeg=300.0, altdeg=60.0)


def triples(points) -> np.ndarray:
    """Points as rows (n, 3)."""
    return np.array([(point.x, point.y, point.z) for point in points])


def shown(time: float) -> tuple[list[Marker], Path]:
    """What the node makes of the falling gait at that time [s]: markers and midline."""
    topics = dict(records(simulate(falling(), time, sample_period=time, load=True)))
    backbone, settings = read_backbone(topics["backbone"]), MarkerSettings()
    skin = SkinMarker(read_body(topics["body"]), settings.colour_limit)
    forces = ForceMarkers(settings).markers(Header(), backbone, read_load(topics["hydrodynamic_load"]))
    markers = [skin.marker(Header(), backbone, read_wrench(topics["internal_wrench"])), *forces]
    return markers, midline(Header(), backbone)


def arrow(start: np.ndarray, end: np.ndarray, shaft: float, head: float) -> np.ndarray:
    """Corners (n, 3, 3) of an arrow as RViz draws it; `shaft` and `head` are diameters [m]."""
    along = end - start
    side = np.cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 * np.linalg.norm(along) else (1.0, 0.0, 0.0))
    side /= max(np.linalg.norm(side), 1e-12)
    up = np.cross(along, side) / max(np.linalg.norm(along), 1e-12)
    angles = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    circle = 0.5 * (np.outer(np.cos(angles), side) + np.outer(np.sin(angles), up))
    neck = 1.0 - HEAD
    radii = [*((neck * k / PARTS, shaft) for k in range(PARTS + 1)), (neck, head), (1.0, 0.0)]
    rings = [start + place * along + diameter * circle for place, diameter in radii]
    corners = []
    for near, far in pairwise(rings):
        corners += [np.stack((near[:-1], near[1:], far[1:]), axis=1), np.stack((near[:-1], far[1:], far[:-1]), axis=1)]
    return np.concatenate(corners)


def draw(markers: list[Marker], line: Path, file) -> None:
    """Write the picture. All triangles are one collection, so that near ones hide those behind."""
    figure = Figure(figsize=(9.6, 5.4), facecolor=BACKGROUND)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d", facecolor=BACKGROUND, computed_zorder=False)
    shapes, colours = [], []
    for marker in markers:
        if marker.action != Marker.ADD:
            continue
        points, colour = triples(marker.points), (marker.color.r, marker.color.g, marker.color.b)
        if marker.type == Marker.TRIANGLE_LIST:
            shapes.append(points.reshape(-1, 3, 3))
            shades = np.array([(each.r, each.g, each.b) for each in marker.colors])
            colours.append(shades.reshape(-1, 3, 3).mean(axis=1))
        else:
            shapes.append(arrow(*points, marker.scale.x, marker.scale.y))
            colours.append(np.tile(colour, (len(shapes[-1]), 1)))
    corners = np.concatenate(shapes)
    faces = Poly3DCollection(
        corners, facecolors=np.concatenate(colours), shade=True, lightsource=LIGHT, zorder=3, clip_on=False
    )
    axes.add_collection3d(faces)
    axes.plot(
        *triples(pose.pose.position for pose in line.poses).T, color="black", linewidth=1.0, zorder=4, clip_on=False
    )
    every = corners.reshape(-1, 3)
    low, high = (SQUARE * each for each in (np.floor(every.min(axis=0) / SQUARE), np.ceil(every.max(axis=0) / SQUARE)))
    for k, other in ((0, 1), (1, 0)):  # the grid lies below the swimmer
        for place in np.arange(low[k], high[k] + 0.5 * SQUARE, SQUARE):
            edge = np.full((2, 3), low[2])
            edge[:, k], edge[:, other] = place, (low[other], high[other])
            axes.plot(*edge.T, color="#707070", linewidth=0.6, zorder=1, clip_on=False)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.45)
    axes.view_init(**FROM)
    axes.set_axis_off()
    figure.savefig(file, dpi=100, facecolor=BACKGROUND)


if __name__ == "__main__":
    draw(*shown(MOMENT), FOLDER / "markers.png")
    tell(FOLDER / "markers.png")
