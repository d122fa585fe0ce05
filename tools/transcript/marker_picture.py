# SPDX-License-Identifier: Apache-2.0
"""Draws what the node `markers` publishes, as RViz would: `marker_picture.py SECONDS FILE`, of the sample at that time.

The skin is shaded, arrows keep their colours, the midline is black; one square of the grid is 0.1 m.
"""

import sys
from itertools import pairwise

import matplotlib
import numpy as np
import rclpy
from eel_ros.qos import keep_all
from matplotlib.colors import LightSource
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from nav_msgs.msg import Path
from visualization_msgs.msg import Marker, MarkerArray

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SQUARE, BACKGROUND = 0.1, "#303030"  # m; RViz's own colour
FROM = {"elev": 62.0, "azim": -70.0}
SIDES, PARTS, HEAD = (
    8,
    8,
    0.23,
)  # of an arrow: sides, parts of its shaft, RViz's length of the head by that of the arrow
LIGHT = LightSource(azdeg=300.0, altdeg=60.0)


def triples(points) -> np.ndarray:
    """Points as rows (n, 3)."""
    return np.array([(point.x, point.y, point.z) for point in points])


def received(time: float) -> tuple[MarkerArray, Path]:
    """Markers and midline of the sample at that simulation time [s]."""
    rclpy.init()
    node = rclpy.create_node("marker_picture")
    wanted, got = round(time * 1e9), {}

    def keep(message, header) -> None:
        if header.stamp.sec * 10**9 + header.stamp.nanosec == wanted:
            got[type(message)] = message

    node.create_subscription(MarkerArray, "markers", lambda each: keep(each, each.markers[0].header), keep_all())
    node.create_subscription(Path, "midline", lambda each: keep(each, each.header), keep_all())
    print(f"waiting for the sample at {time:g} s", flush=True)
    while len(got) < 2:
        rclpy.spin_once(node, timeout_sec=0.1)
    rclpy.shutdown()
    return got[MarkerArray], got[Path]


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


def draw(markers: MarkerArray, midline: Path, file: str) -> None:
    """Write the picture. All triangles are one collection, so that near ones hide those behind."""
    figure = plt.figure(figsize=(9.6, 5.4), facecolor=BACKGROUND)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d", facecolor=BACKGROUND, computed_zorder=False)
    shapes, colours = [], []
    for marker in markers.markers:
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
    line = triples(pose.pose.position for pose in midline.poses)
    axes.plot(*line.T, color="black", linewidth=1.0, zorder=4, clip_on=False)
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
    draw(*received(float(sys.argv[1])), sys.argv[2])
