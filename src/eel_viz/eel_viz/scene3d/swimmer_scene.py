# SPDX-License-Identifier: Apache-2.0
"""Draws one swimmer in its water: skin and eyes, shadow, notes, the frames of the cameras."""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.limit import Limit
from eel_viz.messages import Backbone, Body, Profiles, Twist
from eel_viz.scene3d import colours, legend
from eel_viz.scene3d.camera import FollowFrame, PathFrame
from eel_viz.scene3d.notes import AHEAD, Notes
from eel_viz.scene3d.skin import Skin, tiles
from eel_viz.scene3d.water import WaterBox

SHADOW_POINTS = 24
BEHIND = 0.22  # length of the wake in the picture, relative to the distance from head to tail
PATH_WATER_PERIOD = 400_000_000  # ns: the frame of the path changes slowly


class SwimmerScene:
    """Draws through the methods of topics. limit: of the torque's colours, kept up to date elsewhere."""

    def __init__(self, stream: BatchedStream, limit: Limit) -> None:
        self._stream, self._limit = stream, limit
        self._skin: Skin | None = None
        self._explained = 0.0  # N m: the limit in the legend
        self._frame, self._path_frame = FollowFrame(), PathFrame()
        self._water, self._path_water = (WaterBox(stream, root) for root in (entities.WATER, entities.PATH_WATER))
        self._notes = Notes(stream)
        stream.log_static(entities.WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        shadow = rr.Mesh3D.from_fields(triangle_indices=tiles(SHADOW_POINTS, 2), albedo_factor=(0, 0, 0, 130))
        stream.log_static(entities.SHADOW, shadow)

    def body(self, stamp: int, body: Body) -> None:
        """Take the sections, and log the constant data of skin and eyes."""
        self._skin = skin = Skin(body.x, body.half_width, body.half_height)
        self._notes.fit(body.length)
        self._stream.log_static(entities.SKIN, rr.Mesh3D.from_fields(triangle_indices=skin.triangles))
        # until a torque comes; not static, as static colours would hide later ones
        self._stream.add_row(0, entities.SKIN, rr.Mesh3D, vertex_colors=skin.shades)
        shades = (colours.IRIS, colours.PUPIL) * 2
        eyes = rr.Ellipsoids3D(centers=skin.eyes, half_sizes=skin.eye_sizes, colors=shades, fill_mode="solid")
        self._stream.log_static(entities.EYES, eyes)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        self._notes.speed(stamp, float(np.linalg.norm(twist.linear)))

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Draw skin, eyes, shadow and water, and move the cameras' frames."""
        if not self._stream.drawing_due("skin", stamp):
            return
        position, length = backbone.position, float(backbone.x[-1] - backbone.x[0])
        frame = self._frame.follow(stamp, in_sight(position), length)
        self._notes.body(stamp, backbone, self._frame.filter.velocity, frame)
        self._water.draw(stamp, *frame)
        log_frame(self._stream, stamp, entities.FOLLOW, *frame)
        frame = self._path_frame.include(position, length)
        if self._stream.due("path water", stamp, PATH_WATER_PERIOD):
            self._path_water.draw(stamp, *frame)
        log_frame(self._stream, stamp, entities.WHOLE_PATH, *frame)
        self._draw_shadow(stamp, backbone)
        if self._skin is not None:
            vertices, normals = self._skin.place(backbone.x, position, backbone.orientation)
            self._stream.add_row(stamp, entities.SKIN, rr.Mesh3D, vertex_positions=vertices, vertex_normals=normals)
            self._stream.add_pose(stamp, entities.EYES, position[0], backbone.orientation[0])

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """Colour the flanks by the torque C3."""
        if not self._stream.drawing_due("flanks", stamp):
            return
        limit = self._limit.value
        if limit != self._explained:
            if not self._explained:
                legend.log_bar(self._stream)
            self._explained = limit
            legend.log_limit(self._stream, stamp, limit=limit, unit="N m", name="C3")
        if self._skin is not None:
            shades = self._skin.coloured(wrench.x, wrench.values["torque_3"], limit)
            self._stream.add_row(stamp, entities.SKIN, rr.Mesh3D, vertex_colors=shades)

    def _draw_shadow(self, stamp: int, backbone: Backbone) -> None:
        """Draw the shadow on the floor below the body, as wide as the body."""
        x = np.linspace(backbone.x[0], backbone.x[-1], SHADOW_POINTS)
        middle = np.stack([np.interp(x, backbone.x, column) for column in backbone.position.T], axis=1)
        along = np.gradient(middle[:, :2], axis=0)
        aside = along[:, ::-1] * (1.0, -1.0) / np.maximum(np.linalg.norm(along, axis=1), 1e-9)[:, None]
        width = np.interp(x, self._skin.x, self._skin.half_width) if self._skin is not None else np.zeros_like(x)
        edges = np.repeat(middle[:, None], 2, axis=1)
        edges[:, :, :2] += np.array((1.0, -1.0))[:, None] * (width[:, None] * aside)[:, None]
        edges[:, :, 2] = self._water.floor + 0.002 * (x[-1] - x[0])
        self._stream.add_row(
            stamp, entities.SHADOW, rr.Mesh3D, vertex_positions=edges.reshape(-1, 3).astype(np.float32)
        )


def in_sight(position: np.ndarray) -> np.ndarray:
    """The points that must be in the picture of a body at `position` (M, 3) [m]: body, arrow, start of the wake."""
    ahead = position[:1] - position[-1:]
    return np.concatenate([position, position + AHEAD[1] * ahead, position - BEHIND * ahead])


def log_frame(stream: BatchedStream, stamp: int, path: str, centre: np.ndarray, radius: float) -> None:
    """Log the frame of a camera: its `centre` (3,) and `radius` [m]."""
    scale = np.full((1, 3), radius, dtype=np.float32)
    stream.add_row(stamp, path, rr.Transform3D, translation=centre[None], scale=scale)
