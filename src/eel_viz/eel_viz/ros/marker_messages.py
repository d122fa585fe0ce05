# SPDX-License-Identifier: Apache-2.0
"""Makes markers and a path, which RViz and Foxglove show, of the swimmer's messages."""

from collections.abc import Sequence

import numpy as np
from geometry_msgs.msg import Point, PoseStamped, Vector3
from nav_msgs.msg import Path
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

from eel_viz.messages import Backbone, Body, Load, Profiles
from eel_viz.part_messages import JointStates, Motors
from eel_viz.robots.fin_plates import FinPlates
from eel_viz.robots.joint_rings import JointRings
from eel_viz.robots.loads import load_colours, loads_of
from eel_viz.scene3d import colours
from eel_viz.scene3d.load_vectors import ALONG, LoadVectors
from eel_viz.scene3d.skin import Skin
from eel_viz.settings import MarkerSettings

WIDTHS = (0.0044, 0.011)  # m: diameters of shaft and tip of the arrows along the body
END_WIDTHS = (0.008, 0.018)  # m: of those at its ends
RING_WIDTH = 0.003  # m


class SkinMarker:
    """The skin of one `body` as triangles, coloured by the torque C3: blue at -`colour_limit` [N m], red at +."""

    def __init__(self, body: Body, colour_limit: float) -> None:
        self._skin, self._colour_limit = Skin(body.x, body.half_width, body.half_height), colour_limit
        self._corners = self._skin.triangles.ravel()
        self._palette = [_colour(entry) for entry in colours.DIVERGING]

    def marker(self, header: Header, backbone: Backbone, wrench: Profiles | None) -> Marker:
        """The marker of a shape; grey without a wrench."""
        vertices, _ = self._skin.place(backbone.x, backbone.position, backbone.orientation)
        points = [_point(each) for each in vertices.tolist()]
        marker = Marker(header=header, ns="skin", type=Marker.TRIANGLE_LIST, scale=Vector3(x=1.0, y=1.0, z=1.0))
        marker.pose.orientation.w, marker.color = 1.0, _colour(colours.GREY)
        marker.points = [points[corner] for corner in self._corners]
        if wrench is not None:
            torque = self._skin.at_vertices(wrench.x, wrench.values["torque_3"])
            shades = [self._palette[k] for k in colours.diverging_index(torque, self._colour_limit)]
            marker.colors = [shades[corner] for corner in self._corners]
        return marker


class ForceMarkers:
    """The fluid's force on the body as arrows: per length along it in yellow, at nose and tail in magenta."""

    def __init__(self, settings: MarkerSettings) -> None:
        self._vectors = LoadVectors(load_scale=settings.load_scale, end_scale=settings.end_force_scale)

    def markers(self, header: Header, backbone: Backbone, load: Load) -> list[Marker]:
        """One marker for each arrow; those that a shape with more stations had are deleted."""
        along = _arrows(header, "load", self._vectors.along(backbone, load), colours.FORCE, WIDTHS)
        ends = _arrows(header, "end_force", self._vectors.ends(backbone, load), colours.ENDS, END_WIDTHS)
        gone = [Marker(header=header, ns="load", id=k, action=Marker.DELETE) for k in range(len(along), ALONG)]
        return [*along, *gone, *ends]


class FinMarker:
    """The fins of one `body` as triangles, both sides of them."""

    def __init__(self, body: Body) -> None:
        self._plates = FinPlates(body)
        corners = self._plates.triangles
        self._corners = np.concatenate([corners, corners[:, ::-1]]).ravel()

    def markers(self, header: Header, backbone: Backbone, states: JointStates) -> list[Marker]:
        """One marker; none where the `states` lack a fin."""
        if not set(self._plates.names) <= set(states.names):
            return []
        vertices, _ = self._plates.place(backbone, states.angles_of(self._plates.names))
        points = [_point(each) for each in vertices.tolist()]
        marker = Marker(header=header, ns="fins", type=Marker.TRIANGLE_LIST, scale=Vector3(x=1.0, y=1.0, z=1.0))
        marker.pose.orientation.w, marker.color = 1.0, _colour(colours.FIN)
        marker.points = [points[corner] for corner in self._corners]
        return [marker]


class JointMarkers:
    """The joints of one `body` as rings, in the colours of what their motors give of what they can."""

    def __init__(self, body: Body) -> None:
        self._rings, self._count = JointRings(body), len(body.joints)
        self._palette = [_colour(entry) for entry in colours.LOADS]

    def markers(self, header: Header, backbone: Backbone, motors: Motors) -> list[Marker]:
        """One marker for each joint; none where the `motors` are not as many."""
        if len(motors.torque) != self._count:
            return []
        markers, shades = [], load_colours(loads_of(motors)).tolist()
        for k, (ring, shade) in enumerate(zip(self._rings.place(backbone), shades, strict=True)):
            marker = Marker(header=header, ns="joints", id=k, type=Marker.LINE_STRIP, scale=Vector3(x=RING_WIDTH))
            marker.pose.orientation.w, marker.color = 1.0, self._palette[shade]
            marker.points = [_point(each) for each in ring.tolist()]
            markers.append(marker)
        return markers


def midline(header: Header, backbone: Backbone) -> Path:
    """The backbone as a path: one pose, in REP-103 axes, for each station."""
    path = Path(header=header)
    for position, orientation in zip(backbone.position.tolist(), backbone.orientation.tolist(), strict=True):
        pose = PoseStamped(header=header)
        pose.pose.position = _point(position)
        turn = pose.pose.orientation
        turn.x, turn.y, turn.z, turn.w = orientation
        path.poses.append(pose)
    return path


def _arrows(
    header: Header, space: str, arrows: tuple[np.ndarray, np.ndarray], colour: colours.Colour, size: tuple[float, float]
) -> list[Marker]:
    origins, vectors = arrows
    shaft, head = size
    markers = []
    for k, (begin, end) in enumerate(zip(origins.tolist(), (origins + vectors).tolist(), strict=True)):
        marker = Marker(header=header, ns=space, id=k, type=Marker.ARROW, scale=Vector3(x=shaft, y=head))
        marker.pose.orientation.w, marker.color = 1.0, _colour(colour)
        marker.points = [_point(begin), _point(end)]
        markers.append(marker)
    return markers


def _point(values: list[float]) -> Point:
    return Point(x=values[0], y=values[1], z=values[2])


def _colour(values: Sequence[int] | np.ndarray) -> ColorRGBA:
    red, green, blue = (float(value) / 255.0 for value in values)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)
