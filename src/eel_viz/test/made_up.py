# SPDX-License-Identifier: Apache-2.0
"""A swimmer that never was: smooth analytic fields with the shapes, frames and sizes of the real messages.

The backbone is the integral of the curvature and the sections are orthonormal; the loads are made up.
"""

import math

import numpy as np

STATIONS = 51
LENGTH = 1.0


def body(stations: int = STATIONS) -> dict:
    """Fields of BodyGeometry: the half axes of Boyer, Porez and Leroyer's robot, section 7.2.1."""
    x = np.linspace(0.0, LENGTH, stations)
    radius = 0.05 * np.sqrt(np.clip(1 - (1 - np.minimum(x, 0.05) / 0.05) ** 2, 0.0, 1.0))
    narrow = -(np.sin(np.pi * x - np.pi / 2) + 1) / 6 - x**2 / 8 + 0.5
    bend = np.clip((20 * x - 4) / 11, 0.0, 1.0)
    return {
        "length": LENGTH,
        "mass": 1.944,
        "x": x,
        "half_width": radius * narrow,
        "half_height": radius * (1 - (np.sin(np.pi * bend - np.pi / 2) + 1) / 5),
    }


class Swimmer:
    """The fields at any time, as dictionaries with the messages' field names."""

    def __init__(self, stations: int = STATIONS, offset: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        self.x = np.linspace(0.0, LENGTH, stations)
        self.offset = np.array(offset)

    def curvature(self, t: float) -> dict:
        x, ramp = self.x, min(t, 1.0) ** 2
        amplitude = 1 + 0.5 * x + 2 * x**2
        phase = 2 * np.pi * (x - t)
        pitch = 0.5 * (np.sin(np.pi * t / 5) ** 3) * np.ones_like(x)
        return {
            "x": x,
            "yaw": ramp * amplitude * np.sin(phase),
            "yaw_rate": -2 * np.pi * ramp * amplitude * np.cos(phase),
            "pitch": pitch,
            "pitch_rate": 0.3 * np.pi * np.sin(np.pi * t / 5) ** 2 * np.cos(np.pi * t / 5) * np.ones_like(x),
        }

    def head(self, t: float) -> dict:
        """Position (3,), orientation (4,), linear and angular velocity (3,)."""
        distance = 0.3 * t * t / (t + 1.5)
        heading = 0.35 * min(t, 1.0) * np.sin(2 * np.pi * t) + 0.03 * t
        sway = 0.05 * min(t, 1.0) * np.cos(2 * np.pi * t)
        z = -0.25 * (1 - np.cos(np.pi * t / 10))
        roll = 0.1 * np.sin(np.pi * t)
        half_yaw, half_roll = heading / 2, roll / 2
        orientation = np.array(
            [
                np.cos(half_yaw) * np.sin(half_roll),
                np.sin(half_yaw) * np.sin(half_roll),
                np.sin(half_yaw) * np.cos(half_roll),
                np.cos(half_yaw) * np.cos(half_roll),
            ]
        )
        return {
            "position": self.offset + np.array([distance, 0.015 * t * t + sway, z]),
            "orientation": orientation,
            "linear": np.array([0.3 * t / (t + 1.0), 0.1 * np.sin(2 * np.pi * t), -0.05 * np.sin(np.pi * t / 10)]),
            "angular": np.array([0.1 * np.cos(np.pi * t), 0.02, 2.2 * np.cos(2 * np.pi * t)]),
        }

    def backbone(self, t: float) -> dict:
        """Positions (M, 3) and orientations (M, 4) by marching the curvature from the head with small rotations."""
        curvature, head = self.curvature(t), self.head(t)
        q = tuple(head["orientation"].tolist())
        positions, orientations = [head["position"].tolist()], [q]
        step, pitch, yaw = np.diff(self.x), curvature["pitch"], curvature["yaw"]
        # section axes 2, 3 are -y, +z of base_link
        turns = np.stack([-0.5 * step * (pitch[:-1] + pitch[1:]), 0.5 * step * (yaw[:-1] + yaw[1:])], axis=1)
        for h, (y, z) in zip(step.tolist(), turns.tolist(), strict=True):
            back = _rotated(_times(q, _small(y / 2, z / 2)), -h)
            positions.append([here + moved for here, moved in zip(positions[-1], back, strict=True)])
            q = _times(q, _small(y, z))
            orientations.append(q)
        return {"x": self.x, "position": np.array(positions), "orientation": np.array(orientations)}

    def wrench(self, t: float) -> dict:
        x, ramp = self.x, min(t, 1.0) ** 2
        bell = (x * (1 - x)) ** 1.2 * 4
        wave = 2 * np.pi * (0.9 * x - t)
        return {
            "x": x,
            "torque_1": 0.02 * ramp * bell * np.sin(wave / 2),
            "torque_2": 0.15 * bell * np.sin(np.pi * t / 5),
            "torque_3": 0.55 * ramp * bell * np.sin(wave + 0.4),
            "force_1": 0.8 * ramp * bell * np.cos(2 * wave) - 0.1 * (1 - x),
            "force_2": 1.3 * ramp * bell * np.cos(wave),
            "force_3": 0.2 * ramp * bell * np.sin(np.pi * t / 5),
        }

    def load(self, t: float) -> dict:
        x, ramp = self.x, min(t, 1.0) ** 2
        wave = 2 * np.pi * (x - t)
        return {
            "x": x,
            "force_1": -0.05 * ramp * np.ones_like(x),
            "force_2": 6.0 * ramp * (0.3 + x) * np.cos(wave),
            "force_3": 0.8 * ramp * x * np.sin(np.pi * t / 5) * np.ones_like(x),
            "resistive_1": -0.05 * ramp * np.ones_like(x),
            "resistive_2": 2.0 * ramp * (0.3 + x) * np.cos(wave),
            "resistive_3": 0.1 * ramp * x,
            "tail_force": np.array([-0.4 * ramp, 0.3 * ramp * np.sin(2 * np.pi * t), 0.0]),
            "wake_momentum_rate": np.array([0.4 * ramp, 2.0 * ramp * np.cos(2 * np.pi * t), 0.1 * ramp]),
            "nose_force": np.array([0.1, 0.0, 0.0]) * ramp,
            "fin_force": np.array([0.1, 0.2, 0.3, 0.1, -0.2, 0.3]) * ramp,
        }

    def water(self, t: float) -> np.ndarray:
        """Velocities at the backbone's points."""
        return np.stack([0.1 * np.sin(self.x - t), 0.05 * np.cos(self.x + t), 0.0 * self.x], axis=1)

    def energy(self, t: float) -> dict:
        ramp = min(t, 1.0) ** 2
        actuator = ramp * (1.1 + np.sin(4 * np.pi * t))
        return {
            "kinetic_body": 0.1 * ramp,
            "kinetic_fluid": 0.25 * ramp * (1 + 0.2 * np.sin(4 * np.pi * t)),
            "potential": 0.02 * ramp,
            "actuator_power": actuator,
            "wake_power": -0.5 * actuator,
            "nose_power": -0.03 * ramp,
            "drag_power": -0.35 * actuator,
            "residual": 1e-5 * np.sin(3 * t) * t,
            "flow_power": 0.05 * np.cos(t),
            "fins_power": -0.04 * ramp,
            "damping_power": -0.02 * ramp,
            "elastic": 0.03 * (1 + ramp),
            "appendages_power": -0.01 * ramp,
            "external_power": 0.06 * ramp,
            **{
                f"{part}_work": 0.1 * k * t
                for k, part in enumerate(
                    ("actuator", "wake", "nose", "drag", "flow", "fins", "damping", "appendages", "external"), 1
                )
            },
        }


Quaternion = tuple[float, float, float, float]  # numbers of Python: of three or four they are faster than arrays


def _small(y: float, z: float) -> Quaternion:
    """The rotation by the vector (0, y, z)."""
    angle = math.hypot(y, z)
    share = math.sin(angle / 2) / angle if angle else 0.5
    return 0.0, share * y, share * z, math.cos(angle / 2)


def _times(p: Quaternion, q: Quaternion) -> Quaternion:
    (a, b, c, d), (e, f, g, h) = p, q
    vector = d * e + h * a + b * g - c * f, d * f + h * b + c * e - a * g, d * g + h * c + a * f - b * e
    return *vector, d * h - a * e - b * f - c * g


def _rotated(q: Quaternion, along: float) -> tuple[float, float, float]:
    """The vector (along, 0, 0), rotated."""
    a, b, c, d = q
    return along * (1.0 - 2.0 * (b * b + c * c)), along * 2.0 * (a * b + c * d), along * 2.0 * (a * c - b * d)
