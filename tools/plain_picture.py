# SPDX-License-Identifier: Apache-2.0
"""A picture of a recording where Rerun's viewer cannot draw: the body at four instants, its torque, and the speed.

Of a swimmer that is all body, as that of the demo: fins and joints are not drawn.
"""

import os
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.files.output_file import replacing
from eel_viz.recording.reading import read
from eel_viz.scene3d import colours
from matplotlib.colors import LightSource, ListedColormap
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from eel_viz import entities

INSTANTS = (0.42, 0.575, 0.81, 0.965)  # of the recording's duration
SCALED_FROM = 0.4  # of the duration: from here on the colours' scale fits
SIZE = (14.4, 9.0)  # inches of 100 pixels
WATER, PLAIN, LABEL = (
    tuple(np.array(each) / 255.0) for each in (colours.WATER_BACKGROUND, colours.PLAIN, colours.LABEL)
)


def draw_plain(recording: str | os.PathLike[str], picture: Path) -> None:
    """Draw the `recording` to the PNG `picture`. `ValueError` where it has no skin, torque or speed."""
    figure = Figure(figsize=SIZE, facecolor=WATER)
    times = draw_body(figure.add_axes((0.0, 0.37, 1.0, 0.60), projection="3d", facecolor=WATER), recording)
    draw_torque(figure, figure.add_axes((0.06, 0.07, 0.5, 0.24)), recording)
    speed = read(recording, entities.SPEED)
    plot: Any = figure.add_axes((0.70, 0.07, 0.27, 0.24), facecolor=WATER)
    plot.plot(speed.time, np.ravel(speed["scalars"]), color=PLAIN)
    plot.set(title="speed of the head [m/s]", xlabel="time [s]", xlim=(speed.time[0], speed.time[-1]))
    for each in figure.axes:
        each.tick_params(colors=LABEL)
        for text in (each.title, each.xaxis.label, each.yaxis.label):
            text.set_color(LABEL)
        for edge in each.spines.values():
            edge.set_color(LABEL)
    shown = ", ".join(f"{time:.1f}" for time in times)
    figure.text(0.02, 0.965, f"The body at {shown} s; its flanks have the colour of the torque C3", color=LABEL)
    with replacing(picture) as draft:
        figure.savefig(draft, format="png", dpi=100, facecolor=WATER)


def draw_body(axes: Any, recording: str | os.PathLike[str]) -> list[float]:
    """The skin at each of the `INSTANTS`, in one collection: near parts hide those behind. Returns the times [s]."""
    skin = read(recording, entities.SKIN)
    triangles = read(recording, entities.SKIN, static=True)["triangle_indices"][0].astype(int)
    at = skin.stamps_of["vertex_positions"]
    rows = [int(np.argmin(np.abs(at - at[0] - share * (at[-1] - at[0])))) for share in INSTANTS]
    corners, shades = [], []
    for row in rows:
        coloured = np.searchsorted(skin.stamps_of["vertex_colors"], at[row], side="right") - 1
        packed = np.array(skin.values["vertex_colors"][coloured], dtype=np.uint32)
        rgb = np.stack([(packed >> shift) & 255 for shift in (24, 16, 8)], axis=1) / 255.0
        corners.append(np.array(skin.values["vertex_positions"][row])[triangles])
        shades.append(rgb[triangles].mean(axis=1))
    faces = np.concatenate(corners)
    light: dict[str, Any] = {"shade": True, "lightsource": LightSource(azdeg=300.0, altdeg=60.0), "clip_on": False}
    axes.add_collection3d(Poly3DCollection(faces, facecolors=np.concatenate(shades), **light))
    low, high = faces.min(axis=(0, 1)), faces.max(axis=(0, 1))
    size = np.maximum(high - low, 0.3)
    low, high = (low + high - size) / 2, (low + high + size) / 2
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(size, zoom=1.3)
    for name, side in zip("xyz", size, strict=True):
        axes.locator_params(axis=name, nbins=max(2, round(6.0 * side / size.max())))
    axes.view_init(elev=35.0, azim=-110.0)
    for axis, name in zip((axes.xaxis, axes.yaxis, axes.zaxis), "xyz", strict=True):
        axis.set_pane_color(tuple(np.array(colours.WATER_SHALLOW) / 255.0))
        axis.set_label_text(f"{name} [m]", color=LABEL)
    return [float(at[row] / 1e9) for row in rows]


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
