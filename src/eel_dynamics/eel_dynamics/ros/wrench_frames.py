# SPDX-License-Identifier: Apache-2.0
"""The frames of external_wrench (geometry_msgs/WrenchStamped): sections that it acts on, with axes turned as base_link.

The head's frame is one. The parameter wrench_frames gives further ones, "NAME X" each, below the same namespace. On /tf
they lie between the stations of the profiles: in place by cubics, to the fourth power of their distance, and turned on
the shortest way from one to the next.
"""

import numpy as np
from eel_common.attitude import world_from_body
from eel_common.quantity import number
from eel_common.wording import shown

from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.ros.parameters import DynamicsParameters

Frames = dict[str, float]  # stations [m] by frame id


def wrench_frames(parameters: DynamicsParameters) -> Frames:
    """All frames by their ids. `ValueError` names a text of the parameter that does not fit."""
    head = parameters.head_frame
    space, taken = head.rpartition("/")[0], (head, parameters.world_frame, parameters.root_frame)
    frames = {head: 0.0}
    for text in filter(None, parameters.wrench_frames):
        words = text.split()
        if len(words) != 2:
            raise ValueError(f"wrench_frames must each be NAME X, with X in m from the head, got {shown(text)}")
        frame = f"{space}/{words[0]}".lstrip("/")
        if frame in (*frames, *taken):
            raise ValueError(f"wrench_frames must have names of their own, got {shown(words[0])} again")
        try:
            station = float(words[1])
        except ValueError:
            station = np.nan
        frames[frame] = number(f"wrench_frames {words[0]}", station, "m", minimum=0.0)
    return frames


def stations_of(frames: Frames) -> tuple[ExternalWrench, ...]:
    """Wrenches of nothing, for which panels end at the frames' stations from the start."""
    return tuple(ExternalWrench(station) for station in frames.values() if station > 0.0)


def poses_at(
    stations: np.ndarray, x: np.ndarray, position: np.ndarray, orientation: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Positions (F, 3) [m] and orientations (F, 4) at `stations` (F,) [m], from those at the stations `x` (M,) [m]."""
    here = np.clip(np.searchsorted(x, stations, side="right") - 1, 0, len(x) - 2)
    length = (x[here + 1] - x[here])[:, None]
    s = np.clip((stations[:, None] - x[here, None]) / length, 0.0, 1.0)
    slope = -length[:, None] * world_from_body(orientation)[..., 0][np.stack([here, here + 1], axis=1)]  # dr/ds
    left = 1.0 - s
    cubic = left**2 * (1.0 + 2.0 * s) * position[here] + s**2 * (3.0 - 2.0 * s) * position[here + 1]
    cubic += left * s * (left * slope[:, 0] - s * slope[:, 1])
    ahead, behind = orientation[here], orientation[here + 1]
    behind = behind * np.where(np.sum(ahead * behind, axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    mixed = left * ahead + s * behind
    return cubic, mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
