# SPDX-License-Identifier: Apache-2.0
"""Draws one swimmer in its water: line, skin and eyes, arrows, path of the head, frames of the cameras."""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import Backbone, Body, Load, Pose
from eel_viz.scene3d import colours, legend
from eel_viz.scene3d.arrows import Arrows
from eel_viz.scene3d.camera import FollowFrame, PathFrame
from eel_viz.scene3d.course import Course
from eel_viz.scene3d.notes import AHEAD, Notes
from eel_viz.scene3d.shapes import tiles
from eel_viz.scene3d.skin import Skin
from eel_viz.scene3d.track import Strobes, Track
from eel_viz.scene3d.water import WaterBox

AXES_LENGTH = 0.12  # m
LONGEST = 0.16  # m: arrow of the water's velocity
SHADOW_POINTS = 24
BEHIND = 0.22  # of the distance from head to tail: how much of the wake is in the picture
PATH_WATER_PERIOD = 400_000_000  # ns: its frame changes slowly


class SwimmerScene:
    """Draws into `stream`; reach: that of `Course`; scales: those of `Arrows`, by name."""

    def __init__(self, stream: BatchedStream, *, reach: float, **scales: float) -> None:
        self._stream = stream
        self._skin: Skin | None = None
        self._torque_limit = 0.0  # N m: of the colours in the legend
        self._loaded, self._fastest = False, 0.0  # m/s: of the water so far
        self._frame, self._path_frame = FollowFrame(), PathFrame()
        self._water, self._path_water = (WaterBox(stream, root) for root in (entities.WATER, entities.PATH_WATER))
        self._path_water_stamp: int | None = None  # ns
        self._track, self._strobes = Track(stream), Strobes(stream)
        self._notes = Notes(stream)
        self._arrows, self._course = Arrows(stream, **scales), Course(stream, reach)
        stream.log_static(entities.WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        stream.log_static(entities.BACKBONE, rr.LineStrips3D.from_fields(colors=[colours.LABEL], radii=[0.0004]))
        shadow = rr.Mesh3D.from_fields(triangle_indices=tiles(SHADOW_POINTS, 2), albedo_factor=(0, 0, 0, 130))
        stream.log_static(entities.SHADOW, shadow)
        world = rr.Transform3D(parent_frame=f"tf#{entities.WORLD}", child_frame=entities.WORLD_FRAME)
        stream.log_static(f"{entities.WORLD}/frames", world)
        head = rr.Transform3D(parent_frame=f"tf#{entities.HEAD}", child_frame=entities.HEAD_FRAME)
        stream.log_static(f"{entities.HEAD}/frame", head)
        stream.log_static(entities.FLOW, rr.Arrows3D.from_fields(colors=[colours.FLOW], radii=[0.0018]))
        for path in (entities.HEAD, entities.TAIL):
            stream.log_static(path, rr.TransformAxes3D(AXES_LENGTH))

    def body(self, body: Body) -> None:
        """Take the sections, and log what never changes of skin and eyes."""
        self._course.resize(body.length)
        self._skin = skin = Skin(body.x, body.half_width, body.half_height)
        self._stream.log_static(entities.SKIN, rr.Mesh3D.from_fields(triangle_indices=skin.triangles))
        # until a torque comes; not static, for static colours would hide later ones
        self._stream.add_row(0, entities.SKIN, rr.Mesh3D, vertex_colors=skin.shades)
        shades = (colours.IRIS, colours.PUPIL) * 2
        eyes = rr.Ellipsoids3D(centers=skin.eyes, half_sizes=skin.eye_sizes, colors=shades, fill_mode="solid")
        self._stream.log_static(entities.EYES, eyes)

    def course(self, points: np.ndarray) -> None:
        """Draw the way `points` (n, 3) [m] of a goal."""
        self._course.draw(points)

    def head(self, stamp: int, pose: Pose) -> None:
        """Draw the path of the head, and its axes."""
        self._track.draw(stamp, pose.position)
        self._stream.add_pose(stamp, entities.HEAD, pose.position, pose.orientation)

    def line(self, stamp: int, backbone: Backbone) -> None:
        """Draw the backbone, and its strobes."""
        self._strobes.draw(stamp, backbone.position)
        self._stream.add_lines(stamp, entities.BACKBONE, backbone.position[None])

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Draw skin, tail, water and arrows, and move the cameras' frames."""
        position, length = backbone.position, float(backbone.x[-1] - backbone.x[0])
        frame = self._frame.follow(stamp, in_sight(position), length)
        self._notes.body(stamp, backbone, self._frame.filter.velocity, frame)
        self._water.draw(stamp, *frame)
        log_frame(self._stream, stamp, entities.FOLLOW, *frame)
        frame = self._path_frame.include(position, length)
        if self._path_water_stamp is None or abs(stamp - self._path_water_stamp) >= PATH_WATER_PERIOD:
            self._path_water_stamp = stamp
            self._path_water.draw(stamp, *frame)
        log_frame(self._stream, stamp, entities.WHOLE_PATH, *frame)
        self._draw_shadow(stamp, backbone)
        self._stream.add_pose(stamp, entities.TAIL, position[-1], backbone.orientation[-1])
        if self._skin is not None:
            vertices, normals = self._skin.place(backbone.x, position, backbone.orientation)
            self._stream.add_row(stamp, entities.SKIN, rr.Mesh3D, vertex_positions=vertices, vertex_normals=normals)
            self._stream.add_pose(stamp, entities.EYES, position[0], backbone.orientation[0])
        self._arrows.backbone(stamp, backbone)

    def _draw_shadow(self, stamp: int, backbone: Backbone) -> None:
        """Draw the shadow on the floor, as wide as the body, below it."""
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

    def torque(self, stamp: int, x: np.ndarray, torque: np.ndarray, limit: float, peak: tuple[float, float]) -> None:
        """Colour the flanks by `torque` (M,) [N m] at `x` (M,) [m]; the colours are deepest at `limit`.

        peak: place [m] and size [N m] of the greatest torque of the last seconds.
        """
        self._notes.peak(stamp, *peak)
        if limit != self._torque_limit:
            if not self._torque_limit:
                legend.log_bar(self._stream)
            self._torque_limit = limit
            legend.log_limit(self._stream, stamp, limit=limit, unit="N m", name="C3")
        if self._skin is not None:
            shades = self._skin.coloured(x, torque, limit)
            self._stream.add_row(stamp, entities.SKIN, rr.Mesh3D, vertex_colors=shades)

    def flow(self, stamp: int, position: np.ndarray, velocity: np.ndarray) -> None:
        """Draw the water's velocities (n, 3) [m/s] at points (n, 3) [m] as arrows; the longest so far is `LONGEST`."""
        self._fastest = max(self._fastest, float(np.linalg.norm(velocity, axis=1).max(initial=0.0)))
        vectors = (LONGEST / max(self._fastest, 1e-9) * velocity).astype(np.float32)
        self._stream.add_row(stamp, entities.FLOW, rr.Arrows3D, origins=position.astype(np.float32), vectors=vectors)

    def speed(self, stamp: int, speed: float) -> None:
        """Take the speed of the head [m/s], for the words beside its arrow."""
        self._notes.speed(stamp, speed)

    def load(self, stamp: int, load: Load) -> None:
        """Draw the force of the water as arrows."""
        if not self._loaded:
            self._loaded = True
            legend.log_words(self._stream, stamp)
        self._arrows.load(stamp, load)


def in_sight(position: np.ndarray) -> np.ndarray:
    """What must be in the picture of a body at `position` (M, 3) [m]: body, arrow, the beginning of the wake."""
    ahead = position[:1] - position[-1:]
    return np.concatenate([position, position + AHEAD[1] * ahead, position - BEHIND * ahead])


def log_frame(stream: BatchedStream, stamp: int, path: str, centre: np.ndarray, radius: float) -> None:
    """Log the frame of a camera: its `centre` (3,) and `radius` [m]."""
    scale = np.full((1, 3), radius, dtype=np.float32)
    stream.add_row(stamp, path, rr.Transform3D, translation=centre[None], scale=scale)
