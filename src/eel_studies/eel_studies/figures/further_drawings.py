# SPDX-License-Identifier: Apache-2.0
"""Figures beyond the paper's. Each function draws runs of the falling gait into an empty matplotlib figure."""

from itertools import product

import numpy as np
from eel_dynamics.runs.run import Run

from eel_studies.figures.orders import Errors
from eel_studies.figures.paper_drawings import wrench_of
from eel_studies.pictures import (
    BLACK,
    BLUE,
    COLOUR_BAR,
    GREEN,
    ORANGE,
    PURPLE,
    Axes,
    Figure,
    legend_above,
    mark_pitch,
    plain,
)

PERIOD = 1.0  # s, of the falling gait


def draw_torque_surface(figure: Figure, run: Run, *_: object) -> None:
    """Draw the internal torques C2 and C3 [N m] over time and X, each as a surface and, below it, as a map."""
    from matplotlib.ticker import MaxNLocator

    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1.0))
    torques = ((1, "$C_2$, pitch [N m]"), (2, "$C_3$, yaw [N m]"))
    for row, (column, name) in enumerate(torques):
        space, axes = figure.add_subplot(grid[row, 0], projection="3d"), figure.add_subplot(grid[row, 1])
        values = wrench_of(run)[1][..., column].T  # (M, T)
        size = np.max(np.abs(values))
        _draw_surface(space, run, values, size)
        levels = np.linspace(-size, size, 20)  # an even number: no line at 0, where the water is still
        drawn = axes.contourf(run.time, run.x, values, levels=levels, cmap="PuOr")
        drawn.set_rasterized(True)
        axes.set(xlabel="time t [s]", ylabel="$X_1$ [m], nose to tail")
        axes.invert_yaxis()
        ticks = MaxNLocator(5, symmetric=True)
        bar = figure.colorbar(drawn, ax=axes, label=name, pad=0.02, ticks=ticks, format="%+.2f")
        bar.ax.set_label(COLOUR_BAR)


def _draw_surface(axes: Axes, run: Run, values: np.ndarray, size: float) -> None:
    """Draw the surface of `values` (M, T) [N m] into 3D `axes`, coarse enough for a small file."""
    from matplotlib.ticker import MaxNLocator

    time, x = run.time[::5], run.x[::5]
    surface = axes.plot_surface(
        *np.meshgrid(time, x),
        values[::5, ::5],
        cmap="PuOr",
        vmin=-size,
        vmax=size,
        rcount=len(x),
        ccount=len(time),
        edgecolor=(0.2, 0.2, 0.2, 0.5),
        linewidth=0.3,
    )
    surface.set_rasterized(True)
    axes.view_init(elev=34, azim=-66)
    axes.set_box_aspect((1.7, 0.9, 0.9), zoom=1.2)
    axes.set(xticks=[0, 2, 4, 6, 8, 10], yticks=[0.0, 0.5, 1.0], zlim=(-size, size))
    axes.zaxis.set_major_locator(MaxNLocator(4, symmetric=True))
    axes.set_xlabel("time t [s]", labelpad=-2)
    axes.set_ylabel("$X_1$ [m]", labelpad=-4)
    axes.tick_params(pad=-2)


def draw_head_path(figure: Figure, run: Run, *_: object) -> None:
    """Draw the paths of the head and of the centre of mass, averaged over a period, from above and from the side."""
    path, centre = run.position, run.center_of_mass
    each = round(PERIOD / (run.time[1] - run.time[0]))  # samples in a period
    averaged = np.array([centre[k : k + each].mean(axis=0) for k in range(len(centre) - each)])
    figure.set_layout_engine("compressed")  # panels of equal scale, close together
    heights = np.ptp(path[:, 1:], axis=0) + 0.4
    panels = figure.subplots(2, 1, sharex=True, height_ratios=heights)
    marks = np.arange(0, len(path), each)
    for axes, column, name in zip(panels, (1, 2), ("y [m], from above", "z, up [m], from the side"), strict=True):
        axes.plot(path[:, 0], path[:, column], color=BLUE, linewidth=1.2, label="head")
        axes.plot(
            averaged[:, 0],
            averaged[:, column],
            color=ORANGE,
            linewidth=1.4,
            linestyle=(0, (5, 2)),
            label="centre of mass, averaged",
        )
        axes.plot(path[marks, 0], path[marks, column], "o", color=BLUE, markersize=3.5)
        for mark in marks[[0, *range(2, len(marks))]]:  # in the first second the head hardly moves
            place, said = (path[mark, 0], path[mark, column]), f"{run.time[mark]:.0f} s"
            axes.annotate(said, place, xytext=(-4, 7), textcoords="offset points", fontsize="x-small")
        axes.set_ylabel(name)
        axes.set_ylim(np.min(path[:, column]) - 0.2, np.max(path[:, column]) + 0.2)
        axes.set_aspect("equal", adjustable="box")
        axes.grid(alpha=0.3)
    axes.set_xlabel("x [m]; it swims towards -x")
    legend_above(figure)


def draw_ledger(figure: Figure, run: Run, *_: object) -> None:
    """Draw the powers [W], the works [J] and the residual [J] of the energy ledger over time."""
    energy = run.energy
    assert energy is not None
    lines = (
        ("actuator", "actuators", BLUE, "-"),
        ("drag", "drag along the body", ORANGE, (0, (5, 2))),
        ("wake", "wake", GREEN, (0, (2, 1.5))),
        ("nose", "nose", PURPLE, (0, (5, 1.5, 1, 1.5))),
    )
    power, work, residual = figure.subplots(3, 1, sharex=True, height_ratios=(1.0, 1.0, 0.6))
    for name, label, colour, dash in lines:
        power.plot(run.time, energy[f"{name}_power"], color=colour, linestyle=dash, linewidth=1.3, label=label)
        work.plot(run.time, energy[f"{name}_work"], color=colour, linestyle=dash, linewidth=1.3, label=f"_{label}")
    work.plot(run.time, energy.kinetic_body + energy.kinetic_fluid, color=BLACK, linewidth=1.0, label="kinetic energy")
    left = np.where(energy.residual == 0.0, np.nan, np.abs(energy.residual))  # 0 at the start has no logarithm
    residual.semilogy(run.time, left, color=BLACK, linewidth=1.0)
    power.set_ylabel("power into body\nand water [W]")
    work.set_ylabel("its integral [J]")
    residual.set_ylabel("|residual| [J]")
    residual.set_xlabel("time t [s]; grey: pitch bends")
    legend_above(figure, columns=3)
    for axes in (power, work, residual):
        plain(axes)
    figure.align_ylabels()
    mark_pitch((power, work))


def draw_convergence(figure: Figure, run: Run, printed: Run, errors: Errors) -> None:
    """Draw errors against nodes and against the step, without (False) and with (True) drag of cross flow and roll."""
    by_nodes, by_step = figure.subplots(1, 2)
    for axes, found in ((by_nodes, errors["in_space"]), (by_step, errors["in_time"])):
        for (drag, colour), (name, mark) in product(
            ((False, BLUE), (True, ORANGE)), (("motion", "o"), ("torque", "s"))
        ):
            axes.loglog(
                found[drag].against,
                getattr(found[drag], name),
                color=colour,
                marker=mark,
                markersize=4,
                linewidth=1.2,
                linestyle="-" if name == "motion" else (0, (4, 2)),
                label=f"{name}, {'with' if drag else 'without'} cross-flow drag",
            )
        axes.grid(alpha=0.3, which="major")
    by_nodes.set(xlabel="points per body length", ylabel="relative error")
    by_nodes.set_xticks([10, 20, 50, 100, 200], labels=["10", "20", "50", "100", "200"], minor=False)
    by_nodes.minorticks_off()
    step = np.array([0.005, 0.05])
    by_step.loglog(step, 1.0 * step**4, color=BLACK, linewidth=0.8, linestyle=":", label="order 4")
    by_step.set(xlabel="step in time [s]")
    by_step.set_xticks([0.005, 0.01, 0.02, 0.05], labels=["0.005", "0.01", "0.02", "0.05"], minor=False)
    by_step.minorticks_off()
    by_nodes.set_title("along the body: one evaluation", fontsize="medium")
    by_step.set_title("in time: 2.5 s, Runge-Kutta 4", fontsize="medium")
    legend_above(figure, columns=3)
