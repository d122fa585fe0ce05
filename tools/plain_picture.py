# SPDX-License-Identifier: Apache-2.0
"""A picture of a recording where Rerun's viewer cannot draw: the body at four instants from the side and from above,
with the head's path; its torque, and its speed.

Of a swimmer that is all body, as that of the demo: fins and joints are not drawn.
"""

import os
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.output_file import replacing
from eel_viz.recording.reading import read
from eel_viz.scene3d import colours
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from eel_viz import entities

INSTANTS = (0.42, 0.575, 0.81, 0.965)  # of the recording's duration
SCALED_FROM = 0.4  # of the duration: from here on the colours' scale fits
SIZE = (16.0, 9.0)  # inches of 100 pixels
VIEWS = {"from the side": (0, 2, 1), "from above": (0, 1, 2)}  # axes along and up the picture, and towards the eye
EYE = {"from the side": -1.0, "from above": 1.0}  # on which side of the third axis
LIGHT = np.array((-0.35, -0.5, 0.79))  # direction to it
EDGE = 0.12  # m around the body
WATER, GROUND, PLAIN, LABEL, PATH = (
    tuple(np.array(each) / 255.0)
    for each in (colours.WATER_BACKGROUND, colours.WATER_SHALLOW, colours.PLAIN, colours.LABEL, colours.PATH)
)


def draw_plain(recording: str | os.PathLike[str], picture: Path) -> None:
    """Draw the `recording` to the PNG `picture`. `ValueError` where it has no skin, torque or speed."""
    figure = Figure(figsize=SIZE, facecolor=WATER)
    draw_body(figure, recording)
    draw_torque(figure, figure.add_axes((0.72, 0.56, 0.26, 0.37)), recording)
    speed = read(recording, entities.SPEED)
    plot: Any = figure.add_axes((0.72, 0.07, 0.238, 0.37), facecolor=WATER)
    plot.plot(speed.time, np.ravel(speed["scalars"]), color=PLAIN)
    plot.set(title="speed of the head [m/s]", xlabel="time [s]", xlim=(speed.time[0], speed.time[-1]))
    for each in figure.axes:
        each.tick_params(colors=LABEL)
        for text in (each.title, each.xaxis.label, each.yaxis.label):
            text.set_color(LABEL)
        for edge in each.spines.values():
            edge.set_color(LABEL)
    with replacing(picture) as draft:
        figure.savefig(draft, format="png", dpi=100, facecolor=WATER)


def draw_body(figure: Figure, recording: str | os.PathLike[str]) -> None:
    """The skin at each of the `INSTANTS`, and the head's path, in each of the `VIEWS`, all to one scale."""
    skin = read(recording, entities.SKIN)
    triangles = read(recording, entities.SKIN, static=True)["triangle_indices"][0].astype(int)
    path = read(recording, entities.POSITION)["scalars"]
    at = skin.stamps_of["vertex_positions"]
    rows = [int(np.argmin(np.abs(at - at[0] - share * (at[-1] - at[0])))) for share in INSTANTS]
    corners, shades = [], []
    for row in rows:
        coloured = np.searchsorted(skin.stamps_of["vertex_colors"], at[row], side="right") - 1
        packed = np.array(skin.values["vertex_colors"][coloured], dtype=np.uint32)
        rgb = np.stack([(packed >> shift) & 255 for shift in (24, 16, 8)], axis=1) / 255.0
        corners.append(np.array(skin.values["vertex_positions"][row])[triangles])
        shades.append(rgb[triangles].mean(axis=1))
    faces, heads = np.concatenate(corners), [np.array(skin.values["vertex_positions"][row])[0] for row in rows]
    lit = np.concatenate(shades) * _light(faces)[:, None]
    whole = np.concatenate([faces.reshape(-1, 3), path])
    low, high = whole.min(axis=0) - EDGE, whole.max(axis=0) + EDGE
    heights = [float((high - low)[up]) for _, up, _ in VIEWS.values()]
    grid = {"left": 0.03, "right": 0.67, "bottom": 0.07, "top": 0.95, "hspace": 0.2, "height_ratios": heights}
    for axes, (name, (along, up, away)) in zip(figure.subplots(2, 1, gridspec_kw=grid), VIEWS.items(), strict=True):
        near = np.argsort(EYE[name] * faces[:, :, away].mean(axis=1), kind="stable")  # far parts first
        axes.set_facecolor(GROUND)
        axes.plot(path[:, along], path[:, up], color=PATH, linewidth=1.0, zorder=1)
        corners_of: Any = faces[near][:, :, [along, up]]
        drawn = PolyCollection(corners_of, facecolors=lit[near], edgecolors="face", linewidths=0.3)
        axes.add_collection(drawn)
        for head, row in zip(heads, rows, strict=True) if away == 1 else ():  # the other view has no room for words
            place = {"xytext": (8, 8), "textcoords": "offset points", "color": LABEL}
            axes.annotate(f"head, {at[row] / 1e9:.1f} s", (head[along], head[up]), **place)
        axes.set(aspect="equal", xlim=(low[along], high[along] + 2.0 * EDGE), ylim=(low[up], high[up]))
        axes.set(xlabel="xyz"[along] + " [m]", ylabel="xyz"[up] + " [m]")
        title = f"{name}: the body, its flanks in the colour of the torque, and the path of its head"
        axes.set_title(title, loc="left", color=LABEL)


def _light(faces: np.ndarray) -> np.ndarray:
    """Brightness (n,) of triangles (n, 3, 3): half of it by their slope to the light."""
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    return np.asarray(0.6 + 0.4 * np.abs(normals @ LIGHT))


def draw_torque(figure: Figure, axes: Any, recording: str | os.PathLike[str]) -> None:
    """C3 over time and body; the deepest colour is the greatest after the start."""
    wrench = read(recording, entities.WRENCH_NUMBERS)
    torque, x, time = wrench["torque_3"], wrench["x"][0], wrench.time
    limit = float(np.abs(torque[time >= time[0] + SCALED_FROM * (time[-1] - time[0])]).max()) or 1.0
    shown = axes.pcolormesh(time, x, torque.T, cmap=ListedColormap(colours.DIVERGING / 255.0), vmin=-limit, vmax=limit)
    axes.set(title="torque C3 [N m]: pulses run from nose to tail", xlabel="time [s]", ylabel="X from the nose [m]")
    axes.invert_yaxis()
    bar = figure.colorbar(shown, ax=axes)
    bar.outline.set_edgecolor(LABEL)
