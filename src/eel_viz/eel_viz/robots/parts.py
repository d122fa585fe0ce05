# SPDX-License-Identifier: Apache-2.0
"""Draws fins, joints, motors and appendages of one swimmer, through the methods of their topics, if it has any."""

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.batched_stream import BatchedStream
from eel_viz.messages import AT_LIMIT, Backbone, Body, JointStates, Motors
from eel_viz.robots.motor_plots import MotorPlots
from eel_viz.robots.part_shapes import AppendageBalls, FinPlates, JointRings
from eel_viz.same_stamp import SameStamp
from eel_viz.scene3d import colours, legend

THIN, THICK = -1.5, -2.4  # negative: pixels in Rerun: lines of a ring, and of one at its limit


class Parts:
    """Draws the parts and logs their numbers, through the methods of topics."""

    def __init__(self, stream: BatchedStream) -> None:
        self._stream = stream
        self._plates: FinPlates | None = None
        self._rings: JointRings | None = None
        self._balls: AppendageBalls | None = None
        self._motors: MotorPlots | None = None
        self._joints = 0
        self._turned: SameStamp[Backbone, JointStates] = SameStamp(self._draw_fins)
        self._driven: SameStamp[Backbone, Motors] = SameStamp(self._draw_rings)
        self._names: dict[str, tuple[str, ...]] = {}

    def body(self, stamp: int, body: Body) -> None:
        self._joints = len(body.joints)
        shown = {"fins": bool(body.fins), "joints": bool(body.joints), "appendages": len(body.appendages) > 0}
        if any(shown.values()):
            legend.log_parts(self._stream, **shown)
        if shown["appendages"]:
            self._balls = AppendageBalls(body)
            balls = rr.Points3D.from_fields(radii=self._balls.radii, colors=colours.APPENDAGE)
            self._stream.log_static(entities.APPENDAGES, balls)
        if body.fins:
            self._plates = FinPlates(body)
            plates = rr.Mesh3D.from_fields(triangle_indices=self._plates.triangles, albedo_factor=colours.FIN)
            self._stream.log_static(entities.FINS, plates)
            self._stream.log_series_style(entities.FIN_ANGLES, self._plates.names)
        if body.joints:
            self._rings = JointRings(body)
            self._motors = self._motors or MotorPlots(self._stream)

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        if self._plates is not None and self._stream.drawing_due("fins", stamp):
            self._turned.first(stamp, backbone)
        if self._rings is not None and self._stream.drawing_due("rings", stamp):
            self._driven.first(stamp, backbone)
        if self._balls is not None and self._stream.drawing_due("appendages", stamp):
            places = self._balls.place(backbone).astype(np.float32)
            self._stream.add_row(stamp, entities.APPENDAGES, rr.Points3D, positions=places)

    def fin_states(self, stamp: int, states: JointStates) -> None:
        self._log_states(stamp, entities.FIN_NUMBERS, states)
        if self._plates is not None and set(self._plates.names) <= set(states.names):
            self._turned.second(stamp, states)
            if self._stream.number_due("fin angles", stamp):
                angles = np.degrees(states.angles_of(self._plates.names))
                self._stream.add_scalars(stamp, entities.FIN_ANGLES, angles)

    def joint_states(self, stamp: int, states: JointStates) -> None:
        self._log_states(stamp, entities.JOINT_NUMBERS, states)

    def motor_states(self, stamp: int, motors: Motors) -> None:
        """Log and draw torques, limits and powers of the motors, if any."""
        if len(motors.torque) and self._stream.number_due(entities.MOTOR_NUMBERS, stamp):
            self._log_names(stamp, entities.MOTOR_NUMBERS, "MotorStates", motors.names)
            values = {name: getattr(motors, name) for name in ("torque", "limit", "power")}
            self._stream.add_arrays(stamp, entities.MOTOR_NUMBERS, "MotorStates", values)
        if self._motors is not None and len(motors.torque) == self._joints:
            self._motors.draw(stamp, motors)
            self._driven.second(stamp, motors)

    def _log_states(self, stamp: int, path: str, states: JointStates) -> None:
        if not states.names:
            return
        self._log_names(stamp, path, "JointState", states.names)
        if self._stream.number_due(path, stamp):
            rows = {"position": states.angle, "velocity": states.rate, "effort": states.torque}
            known = {name: row for name, row in rows.items() if row is not None}
            self._stream.add_arrays(stamp, path, "JointState", known)

    def _log_names(self, stamp: int, path: str, kind: str, names: tuple[str, ...]) -> None:
        if names and self._names.get(path) != names:
            self._names[path] = names
            self._stream.log(stamp, path, rr.DynamicArchetype(kind, components={"name": list(names)}))

    def _draw_fins(self, stamp: int, backbone: Backbone, states: JointStates) -> None:
        assert self._plates is not None
        vertices, normals = self._plates.place(backbone, states.angles_of(self._plates.names))
        self._stream.add_row(stamp, entities.FINS, rr.Mesh3D, vertex_positions=vertices, vertex_normals=normals)

    def _draw_rings(self, stamp: int, backbone: Backbone, motors: Motors) -> None:
        assert self._rings is not None
        loads = motors.loads
        self._stream.add_row(
            stamp,
            entities.JOINTS,
            rr.LineStrips3D,
            strips=self._rings.place(backbone).astype(np.float32),
            colors=colours.LOADS[colours.load_index(loads)],
            radii=np.where(loads >= AT_LIMIT, THICK, THIN).astype(np.float32),
        )
