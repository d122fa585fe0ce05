# SPDX-License-Identifier: Apache-2.0
"""Colours for colour-blind readers too: one for each section axis, and a diverging map for signed values.

The three axis colours are Okabe and Ito's orange, bluish green and sky blue. The diverging map goes from a light blue
over the dark of the eel's back to a light red, so that both signs differ in hue and lightness from zero, and a body
without torque looks as it is.
"""

import numpy as np

Colour = tuple[int, int, int]  # red, green, blue: 0 to 255

AXIS = ((230, 134, 40), (0, 170, 130), (86, 180, 233))  # section axes 1, 2, 3
TEAL = (38, 190, 170)
AMBER = (236, 178, 50)
MAGENTA = (222, 80, 150)
WAKE = (150, 120, 235)
GREY = (150, 155, 160)
LABEL = (205, 210, 215)
TICK = (70, 76, 84)
FRAME = (110, 116, 124)
WATER_LINE = (38, 70, 96)
WATER_LINE_MAJOR = (62, 104, 138)
WATER_LABEL = (120, 152, 178)
WATER_BACKGROUND = (9, 20, 33)
PLOT_BACKGROUND = (13, 16, 17)
WATER_DEEP, WATER_SHALLOW = (8, 20, 32), (17, 46, 68)
BACK, BELLY = (58, 74, 62), (226, 222, 200)  # of the skin
IRIS, PUPIL = (214, 178, 92), (8, 9, 10)

_ANCHORS = np.array(
    [
        (150, 205, 255),
        (88, 160, 250),
        (52, 114, 208),
        (48, 84, 128),
        BACK,
        (124, 66, 48),
        (198, 78, 48),
        (244, 118, 70),
        (255, 182, 136),
    ],
    dtype=float,
)
DIVERGING = (
    np.stack([np.interp(np.linspace(0, 8, 256), np.arange(9), _ANCHORS[:, channel]) for channel in range(3)], axis=1)
    .round()
    .astype(np.uint8)
)


def dim(colour: Colour, factor: float = 0.45) -> Colour:
    """The same hue, darker: for drawings in the background, such as an envelope."""
    red, green, blue = (int(channel * factor) for channel in colour)
    return red, green, blue


def faded(colour: Colour, left: np.ndarray) -> np.ndarray:
    """`colour` with the shares `left` (n,) of it, the rest that of the water: uint8 (n, 3)."""
    mixed = np.outer(left, colour) + np.outer(1.0 - left, WATER_BACKGROUND)
    return np.asarray(mixed, dtype=np.uint8)


def diverging(values: np.ndarray, limit: float) -> np.ndarray:
    """Colours of signed `values`: -limit and below the bluest, 0 dark, +limit and above the reddest; uint8 (..., 3)."""
    return np.asarray(DIVERGING[diverging_index(values, limit)])


def diverging_index(values: np.ndarray, limit: float) -> np.ndarray:
    """Rows of `DIVERGING` that show `values`, uint8, same shape."""
    return np.clip((np.asarray(values) / limit + 1.0) * 127.5 + 0.5, 0, 255).astype(np.uint8)
