# SPDX-License-Identifier: Apache-2.0
"""Speed and power behind a cylinder over the spacing of its street, and one street with its swimmer."""

import numpy as np

from eel_studies.drafting.study import FOLLOWING, Study, Wake
from eel_studies.pictures import BLUE, GREEN, GREY, ORANGE, Axes, Figure

SIZE = 9.0, 6.6  # inches


def draw_study(figure: Figure, study: Study) -> None:
    """Speed and power over the spacing, a dot a phase; below, the water of a street."""
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    speed, power = (figure.add_subplot(grid[0, column]) for column in (0, 1))
    still = study.still
    _draw_dots(speed, study, "speed", still.speed, "speed / that in still water")
    spacings = np.linspace(study.spacings[0], study.spacings[-1], 200)
    locked = FOLLOWING * still.speed + spacings / study.period
    shown = locked < 1.05 * study.table("speed").max()
    speed.plot(spacings[shown], locked[shown] / still.speed, color=GREEN, label="one spacing a beat")
    drafting = study.drafting.speed / still.speed
    speed.axhline(drafting, color=ORANGE, dashes=(4, 2), label="mean velocity of the street alone")
    speed.legend(frameon=False)
    _draw_dots(power, study, "power", still.power, "power / that in still water")
    _draw_dots(power, study, "paid", still.power, "", colour=ORANGE, label="positive part alone")
    power.legend(frameon=False)
    _draw_street(figure.add_subplot(grid[1, :]), Wake(still.speed, 1.0))


def _draw_dots(
    axes: Axes, study: Study, name: str, unit: float, title: str, colour: str = BLUE, label: str = "phases"
) -> None:
    table = study.table(name) / unit
    across = np.repeat(study.spacings[:, None], table.shape[1], axis=1)
    axes.plot(across.ravel(), table.ravel(), ".", color=colour, markersize=5, label=label)
    axes.axhline(1.0, color=GREY, linewidth=0.8)
    axes.set_xlabel("spacing of the vortices [body lengths]")
    axes.grid(alpha=0.3)
    if title:
        axes.set_ylabel(title)


def _draw_street(axes: Axes, wake: Wake) -> None:
    x, y = np.linspace(-1.0, 2.0, 121), np.linspace(-0.4, 0.4, 33)
    places = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1)
    sample = wake.flow(0.0).sample(places.reshape(-1, 3))
    spin = (sample.jacobian[:, 1, 0] - sample.jacobian[:, 0, 1]).reshape(len(y), len(x))
    limit = float(np.abs(spin).max())
    axes.pcolormesh(x, y, spin, cmap="PuOr", vmin=-limit, vmax=limit, shading="gouraud", rasterized=True)
    u, v, _ = np.moveaxis(sample.velocity.reshape(len(y), len(x), 3), -1, 0)
    axes.quiver(x[::4], y[::4], u[::4, ::4], v[::4, ::4], width=0.0015)
    axes.plot([0.0, 1.0], [0.0, 0.0], color="black", linewidth=4, solid_capstyle="round", alpha=0.6)
    axes.set(aspect="equal", xlabel="x [m]; the cylinder is ahead, to the right", ylabel="y [m]")
    axes.set_title(
        "vorticity and velocity of a street with a spacing of a body length, and the body", fontsize="medium"
    )
