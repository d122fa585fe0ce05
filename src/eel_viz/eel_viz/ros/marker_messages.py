# SPDX-License-Identifier: Apache-2.0
"""Makes markers and a path, for RViz and Foxglove, from the swimmer's messages."""

from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point, PoseStamped, Vector3
from nav_msgs.msg import Path
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

from eel_viz.messages import Backbone, Body, JointStates, Load, Motors, Profiles
from eel_viz.robots.part_shapes import FinPlates, JointRings
from eel_viz.scene3d import colours
from eel_viz.scene3d.centre_line import ALONG, forces_along, forces_at_ends
from eel_viz.scene3d.skin import Skin
from eel_viz.settings import MarkerSettings

WIDTHS = (0.0044, 0.011)  # m: diameters of shaft and tip of the arrows along the body
END_WIDTHS = (0.008, 0.018)  # m: of the arrows at its ends
RING_WIDTH = 0.003  # m


class SkinMarker:
    """The skin of one `body` as triangles, coloured by the torque C3: blue at -`colour_limit` [N m], red at +."""

    def __init__(self, body: Body, colour_limit: float) -> None:
        self._skin, self._colour_limit = Skin(body.x, body.half_width, body.half_height), colour_limit
        self._palette = [_colour(entry) for entry in colours.DIVERGING]

    def markers(self, header: Header, backbone: Backbone, wrench: Profiles | None) -> list[Marker]:
        """One marker; grey without a wrench."""
        vertices, _ = self._skin.place(backbone.x, backbone.position, backbone.orientation)
        corners = self._skin.triangles.ravel()
        marker = _triangles(header, "skin", vertices, corners, colours.GREY)
        if wrench is not None:
            torque = self._skin.at_vertices(wrench.x, wrench.values["torque_3"])
            shades = [self._palette[k] for k in colours.diverging_index(torque, self._colour_limit)]
            marker.colors = [shades[corner] for corner in corners]
        return [marker]


class ForceMarkers:
    """The fluid's force on the body as arrows: per length along it in yellow, at nose and tail in magenta."""

    def __init__(self, settings: MarkerSettings) -> None:
        self._settings = settings

    def markers(self, header: Header, backbone: Backbone, load: Load) -> list[Marker]:
        """One marker for each arrow. Markers left over from a shape with more stations are deleted."""
        markers = []
        for space, (places, forces), scale, colour, (shaft, tip) in (
            ("load", forces_along(backbone, load), self._settings.load_scale, colours.FORCE, WIDTHS),
            ("end_force", forces_at_ends(backbone, load), self._settings.end_force_scale, colours.ENDS, END_WIDTHS),
        ):
            arrows, size = np.stack([places, places + scale * forces], axis=1), Vector3(x=shaft, y=tip)
            markers += [
                _marker(header, space, Marker.ARROW, ends, _colour(colour), size, k) for k, ends in enumerate(arrows)
            ]
            if space == "load":
                deleted = range(len(arrows), ALONG)
                markers += [Marker(header=header, ns=space, id=k, action=Marker.DELETE) for k in deleted]
        return markers


class FinMarker:
    """The fins of one `body` as triangles, visible from both sides."""

    def __init__(self, body: Body) -> None:
        self._plates = FinPlates(body)
        corners = self._plates.triangles
        self._corners = np.concatenate([corners, corners[:, ::-1]]).ravel()

    def markers(self, header: Header, backbone: Backbone, states: JointStates) -> list[Marker]:
        """One marker; none if the `states` lack a fin."""
        if not set(self._plates.names) <= set(states.names):
            return []
        vertices, _ = self._plates.place(backbone, states.angles_of(self._plates.names))
        return [_triangles(header, "fins", vertices, self._corners, colours.FIN)]


class JointMarkers:
    """The joints of one `body` as rings, coloured by their motors' torque / limit."""

    def __init__(self, body: Body) -> None:
        self._rings, self._count = JointRings(body), len(body.joints)

    def markers(self, header: Header, backbone: Backbone, motors: Motors) -> list[Marker]:
        """One marker for each joint; none if the number of `motors` differs."""
        if len(motors.torque) != self._count:
            return []
        shades, size = colours.LOADS[colours.load_index(motors.loads)], Vector3(x=RING_WIDTH)
        return [
            _marker(header, "joints", Marker.LINE_STRIP, ring, _colour(shade), size, k)
            for k, (ring, shade) in enumerate(zip(self._rings.place(backbone), shades, strict=True))
        ]


def midline(header: Header, backbone: Backbone) -> Path:
    """The backbone as a path: one pose, in REP-103 axes, for each station."""
    path = Path(header=header)
    for position, orientation in zip(_points(backbone.position), backbone.orientation.tolist(), strict=True):
        pose = PoseStamped(header=header)
        pose.pose.position = position
        turn = pose.pose.orientation
        turn.x, turn.y, turn.z, turn.w = orientation
        path.poses.append(pose)
    return path


def _triangles(header: Header, space: str, vertices: np.ndarray, corners: np.ndarray, colour: colours.Colour) -> Marker:
    size = Vector3(x=1.0, y=1.0, z=1.0)
    points = _points(vertices)
    marker = _marker(header, space, Marker.TRIANGLE_LIST, vertices[:0], _colour(colour), size)
    marker.points = [points[corner] for corner in corners]
    return marker


def _marker(
    header: Header, space: str, kind: int, points: np.ndarray, colour: ColorRGBA, size: Vector3, number: int = 0
) -> Marker:
    marker = Marker(header=header, ns=space, id=number, type=kind, scale=size, color=colour, points=_points(points))
    marker.pose.orientation.w = 1.0
    return marker


def _points(places: np.ndarray) -> list[Point]:
    return [Point(x=x, y=y, z=z) for x, y, z in places.tolist()]


def _colour(values: Sequence[int] | np.ndarray) -> ColorRGBA:
    red, green, blue = (float(value) / 255.0 for value in values)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)
