# SPDX-License-Identifier: Apache-2.0
"""The meaning of each colour, the same in every view, and distinct for colour-blind readers.

The colours of the axes are Okabe and Ito's orange, bluish green and sky blue. The diverging map goes from a light blue
through the dark of the eel's back to a light red; its lightness L* rises evenly to both sides. So both signs differ in
hue and lightness from zero, and a body without torque keeps its own colour. Space, drawings and maps have a dark ground
in every theme.
Curves over time have the theme's own ground, so their lightness lies between (`curve`).
"""

import numpy as np

from eel_viz.messages import AT_LIMIT

Colour = tuple[int, int, int]  # red, green, blue: 0 to 255

AXIS = ((230, 134, 40), (0, 170, 130), (86, 180, 233))  # section axes 1, 2, 3; also x, y, z
ACTUATORS = (236, 84, 72)  # red: their power
FORCE = (240, 218, 66)  # yellow: the water's force along the body, and its power
ENDS = (222, 80, 150)  # magenta: the water's force at nose and tail, and its power
WAKE = (150, 120, 235)  # violet: momentum given to the wake, and its power
FLOW = (112, 190, 216)  # pale blue: motion of the undisturbed water
PATH = (150, 172, 192)  # blue-grey: path of the head
COURSE = (150, 232, 196)  # mint: way points of a goal
SPRINGS = (0, 150, 136)  # teal: springs and dampers of joints
FIN = (140, 214, 110)  # lime: fins, and their power
APPENDAGE = (170, 150, 200)  # lilac: appendages, and their power
EXTERNAL = (250, 190, 190)  # pink: the power of wrenches from outside
OTHER = (244, 244, 240)  # white: the run that is laid over this one
PLAIN = (190, 196, 202)  # a single quantity in its plot
GREY = (150, 155, 160)  # no data
LABEL = (205, 210, 215)  # letters on the ground of plots and of the legend
NOTE = (255, 255, 255)  # letters in front of the water
TICK = (100, 106, 114)  # grid of drawings: contrasts of grids with their grounds are above 3
FRAME = (140, 146, 154)
WATER_LINE = (44, 80, 104)  # between the lines at round coordinates
WATER_LINE_MAJOR = (98, 142, 170)
WATER_LABEL = (150, 180, 205)  # letters on the walls
WATER_BACKGROUND = (9, 20, 33)
PLOT_BACKGROUND = (13, 16, 17)
WATER_DEEP, WATER_SHALLOW, WATER_FLOOR = (8, 20, 32), (24, 64, 90), (24, 66, 86)
BACK, BELLY = (80, 98, 82), (226, 222, 200)  # colours of the skin
BRIGHTEST_CURVE, DEEP_CURVE = 0.28, 0.125  # luminance, 0 to 1: a contrast of 3 with white, and with the dark ground
IRIS, PUPIL = (214, 178, 92), (8, 9, 10)

_ANCHORS = np.array(  # of lightness L* = 80, 70, 60, 50, 40, 50, 60, 70, 80
    [
        (149, 204, 254),
        (110, 174, 255),
        (71, 145, 244),
        (72, 121, 180),
        BACK,
        (168, 103, 75),
        (236, 104, 68),
        (255, 139, 100),
        (255, 182, 137),
    ],
    dtype=float,
)
DIVERGING = (
    np.stack([np.interp(np.linspace(0, 8, 256), np.arange(9), _ANCHORS[:, channel]) for channel in range(3)], axis=1)
    .round()
    .astype(np.uint8)
)
# of a motor's torque / limit: from grey to white; the last entry, red, is the limit
LOADS = np.concatenate([np.linspace((84, 92, 102), (246, 246, 242), 255), [ACTUATORS]]).round().astype(np.uint8)


def dim(colour: Colour, factor: float = 0.45) -> Colour:
    """The same hue, darker: for drawings in the background, such as an envelope."""
    red, green, blue = (int(channel * factor) for channel in colour)
    return red, green, blue


def curve(colour: Colour, brightest: float = BRIGHTEST_CURVE) -> Colour:
    """The same hue, dark enough for a white ground: of the luminance `brightest` at most."""
    light = (np.array(colour) / 255.0) ** 2.2
    share = min(1.0, brightest / float(light @ (0.2126, 0.7152, 0.0722)))
    red, green, blue = (int(channel) for channel in 255.0 * (share * light) ** (1 / 2.2))
    return red, green, blue


def deep(colour: Colour) -> Colour:
    """The same hue for a curve beside others whose hues eyes without red or green cannot tell from it."""
    return curve(colour, DEEP_CURVE)


def faded(colour: Colour, left: np.ndarray) -> np.ndarray:
    """`colour` mixed with the water's: the shares `left` (n,) of it remain. uint8 (n, 3)."""
    mixed = np.outer(left, colour) + np.outer(1.0 - left, WATER_BACKGROUND)
    return np.asarray(mixed, dtype=np.uint8)


def diverging(values: np.ndarray, limit: float) -> np.ndarray:
    """Colours of signed `values`: bluest at -limit and below, dark at 0, reddest at +limit and above; uint8 (...,
    3)."""
    return np.asarray(DIVERGING[diverging_index(values, limit)])


def diverging_index(values: np.ndarray, limit: float) -> np.ndarray:
    """Rows of `DIVERGING` for `values`, uint8, same shape."""
    return np.clip((np.asarray(values) / limit + 1.0) * 127.5 + 0.5, 0, 255).astype(np.uint8)


def load_index(loads: np.ndarray) -> np.ndarray:
    """Rows of `LOADS` for the `loads` (...,), torque / limit, uint8. The last row, red, is at the limit."""
    below = np.clip(np.nan_to_num(loads) * 254.0, 0.0, 254.0).round()
    return np.where(loads >= AT_LIMIT, 255, below).astype(np.uint8)
