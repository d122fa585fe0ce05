# SPDX-License-Identifier: Apache-2.0
"""Files of midlines as a film of a fish gives them, for the tests."""

import math

import numpy as np

from eel_gaits import kern_fast

ARC = np.linspace(0.0, 1.0, 21)
FINE = np.linspace(0.0, 1.0, 401)


def write_midlines(path, position_at, *, end=4.0, noise=0.0):
    """A file of midlines, 50 a second, that swim ahead and turn; position_at(time): (21, 2) [m]."""
    draw, lines = np.random.default_rng(5), ["time,arc_length,x,y"]
    for time in np.arange(round(50 * end) + 1) / 50.0:
        turn = 0.4 * math.sin(5.0 * time) + 0.1 * time
        rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        place = position_at(time) @ rotation.T - [0.3 * time, 0.0] + noise * draw.normal(size=(len(ARC), 2))
        lines += [f"{time},{x},{a},{b}" for x, (a, b) in zip(ARC, place.tolist(), strict=True)]
    path.write_text("\n".join(lines))
    return path


def kern_midline(time):
    """Points (21, 2) of the midline of Kern and Koumoutsakos's eel at `time` [s], from its curvature."""

    def integral(values):
        return np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(FINE))))

    angle = integral(kern_fast().curvature(time, FINE)[0][:, 2])
    return np.stack([np.interp(ARC, FINE, integral(along(angle))) for along in (np.cos, np.sin)], axis=1)
