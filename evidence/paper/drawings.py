# SPDX-License-Identifier: Apache-2.0
"""Figures 5 to 9 of the paper, and two more. Each function draws runs of the falling gait into an empty figure."""

import numpy as np
from eel_studies.pictures import (
    AS_PRINTED,
    BLACK,
    BLUE,
    COLOUR_BAR,
    GREEN,
    ORANGE,
    OWN,
    PALE_BLUE,
    PURPLE,
    Axes,
    Figure,
    legend_above,
    mark_pitch,
)

from eel_dynamics import Run

FRAME_PERIOD = 0.5  # s, of Fig. 6: 2 frames a second
INSTANT = 7.0  # s, of Fig. 7
PLACE = 0.5  # m, of Fig. 8
SECTIONS = (0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95)  # of the length, drawn in Fig. 5


def draw_body(figure: Figure, run: Run, *_: object) -> None:
    """Draw Fig. 5: outlines from the side and from above, and cross-sections at their true size."""
    body = run.body
    # points are denser at the nose, where the outline is round
    x = body.length * np.concatenate((np.linspace(0.0, 0.05**0.5, 60) ** 2, np.linspace(0.05, 1.0, 200)[1:]))
    side, above, ellipses = figure.subplots(3, 1, sharex=True)
    for axes, half, name in (
        (side, body.half_height(x), "from the side\n$X_3$ [m]"),
        (above, body.half_width(x), "from above\n$X_2$ [m]"),
    ):
        axes.fill_between(x, -half, half, facecolor=PALE_BLUE, edgecolor=BLUE, linewidth=1.4)
        axes.set_ylabel(name)
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    for place in body.length * np.array(SECTIONS):
        width, height = float(body.half_width(place)), float(body.half_height(place))
        ellipses.fill(place + width * np.cos(angle), height * np.sin(angle), facecolor=PALE_BLUE, edgecolor=BLUE)
    ellipses.set_ylabel("sections\n$X_3$ [m]")
    ellipses.set_xlabel("$X_1$ [m], nose to tail")
    ends = -0.03 * body.length, 1.03 * body.length
    for axes in (side, above, ellipses):
        axes.set(aspect="equal", ylim=(-0.07, 0.07), xlim=ends, yticks=[-0.05, 0.0, 0.05])


def draw_configurations(figure: Figure, run: Run, *_: object) -> None:
    """Draw Fig. 6: the backbone twice a second, in space, from above and from the side (world axes [m])."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    figure.set_layout_engine("none")  # the layout engine does not suit 3D axes
    space = figure.add_axes((0.0, 0.67, 0.93, 0.29), projection="3d")
    above, side = figure.add_axes((0.19, 0.5, 0.78, 0.12)), figure.add_axes((0.19, 0.19, 0.78, 0.27))
    bar = figure.add_axes((0.19, 0.08, 0.78, 0.015), label=COLOUR_BAR)
    colours = ScalarMappable(Normalize(run.time[0], run.time[-1]), "cividis")
    for time in np.arange(run.time[0], run.time[-1] + 1e-9, FRAME_PERIOD):
        x, y, z = run.backbone[np.argmin(np.abs(run.time - time)), ::2].T
        line = {"color": colours.to_rgba(time), "linewidth": 1.8, "solid_capstyle": "round"}
        space.plot(x, y, z, **line)
        for axes, across in ((above, y), (side, z)):
            axes.plot(x, across, **line)
            axes.plot(x[0], across[0], "o", color=line["color"], markersize=3.5)
    space.set_xlabel("x [m]", labelpad=6)
    space.set_ylabel("y [m]", labelpad=-4)
    space.set_zlabel("z [m]", labelpad=-4)
    space.tick_params(pad=0)
    space.set_aspect("equal", adjustable="box")
    space.view_init(elev=24, azim=-64)
    space.set_xticks(range(-4, 2))
    space.set_yticks([0.0, 1.0])
    space.set_zticks([-2.0, -1.0, 0.0])
    space.set_box_aspect([high - low for low, high in (space.get_xlim(), space.get_ylim(), space.get_zlim())], zoom=1.4)
    for axes, name in ((above, "y [m]\nfrom above"), (side, "z [m]\nfrom the side")):
        axes.set(ylabel=name, xlim=(-4.3, 1.2))
        axes.set_aspect("equal", adjustable="box")
    above.tick_params(labelbottom=False)
    side.set_xlabel("x [m]; a dot marks the head")
    side.set_yticks([-2.0, -1.0, 0.0], ["-2", "-1", "0"])
    figure.align_ylabels((above, side))
    figure.colorbar(colours, cax=bar, orientation="horizontal", label="time [s]")


def draw_wrench_along_the_body(figure: Figure, run: Run, printed: Run, *_: object) -> None:
    """Draw Fig. 7: N1 [N], C2 and C3 [N m] against X at t = 7 s, of our run and of the `printed` reading."""
    profiles = [[field[np.argmin(np.abs(each.time - INSTANT))] for field in wrench_of(each)] for each in (run, printed)]
    _draw_wrench(figure, run.x, profiles, f"$X_1$ [m], nose to tail, at t = {INSTANT:g} s")


def draw_wrench_in_time(figure: Figure, run: Run, printed: Run, *_: object) -> None:
    """Draw Fig. 8: N1 [N], C2 and C3 [N m] against t at X = 0.5 m, of our run and of the `printed` reading."""
    station = int(np.argmin(np.abs(run.x - PLACE)))
    profiles = [[field[:, station] for field in wrench_of(each)] for each in (run, printed)]
    _draw_wrench(figure, run.time, profiles, f"time t [s], at $X_1$ = {PLACE:g} m; grey: pitch bends")
    mark_pitch(figure.axes)


def wrench_of(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] and torque [N m], (T, M, 3), of a run whose scene has them."""
    assert run.force is not None and run.torque is not None
    return run.force, run.torque


def _draw_wrench(figure: Figure, abscissa: np.ndarray, profiles: list[list[np.ndarray]], name: str) -> None:
    """Draw N1, C2 and C3 in a column. profiles: force and torque (n, 3) against `abscissa`, ours and as printed."""
    rows = (0, 0, "$N_1$ [N]\n(> 0: tension)"), (1, 1, "$C_2$ [N m]\n(pitch)"), (1, 2, "$C_3$ [N m]\n(yaw)")
    for axes, (field, column, label) in zip(figure.subplots(3, 1, sharex=True), rows, strict=True):
        for profile, style in zip(profiles, (OWN, AS_PRINTED), strict=True):
            axes.plot(abscissa, profile[field][:, column], **style)
        _finish(axes, label)
    axes.set_xlabel(name)
    legend_above(figure)
    figure.align_ylabels()


def draw_head_velocity(figure: Figure, run: Run, printed: Run, *_: object) -> None:
    """Draw Fig. 9: V1(0) [m/s] and Omega1(0) [rad/s] against t, of our run and of the `printed` reading."""
    rows = ((3, "$V_1(0)$ [m/s]\n(< 0: ahead)"), (0, "$\\Omega_1(0)$ [rad/s]\n(roll)"))
    for axes, (column, label) in zip(figure.subplots(2, 1, sharex=True), rows, strict=True):
        for each, style in ((run, OWN), (printed, AS_PRINTED)):
            axes.plot(each.time, each.twist[:, column], **style)
        _finish(axes, label)
    axes.set_xlabel("time t [s]; grey: pitch bends")
    legend_above(figure)
    figure.align_ylabels()
    mark_pitch(figure.axes)


def _finish(axes: Axes, label: str) -> None:
    axes.set_ylabel(label)
    axes.axhline(0.0, color=BLACK, linewidth=0.5)
    axes.margins(x=0.0)


def draw_torque(figure: Figure, run: Run, *_: object) -> None:
    """Draw the internal torques C2 and C3 [N m] over time and X, each as a map."""
    panels = figure.subplots(2, 1, sharex=True)
    for axes, column, name in zip(panels, (1, 2), ("$C_2$, pitch [N m]", "$C_3$, yaw [N m]"), strict=True):
        values = wrench_of(run)[1][..., column].T  # (M, T)
        size = np.max(np.abs(values))
        levels = np.linspace(-size, size, 20)  # an even number: no line at 0, where the water is still
        axes.grid(False)
        drawn = axes.contourf(run.time, run.x, values, levels=levels, cmap="PuOr")
        drawn.set_rasterized(True)
        axes.set_ylabel("$X_1$ [m], nose to tail")
        axes.invert_yaxis()
        figure.colorbar(drawn, ax=axes, label=name, pad=0.02, format="%+.2f").ax.set_label(COLOUR_BAR)
    axes.set_xlabel("time t [s]")


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
    names = "power into body\nand water [W]", "its integral [J]", "|residual| [J]"
    for axes, name in zip((power, work, residual), names, strict=True):
        axes.set_ylabel(name)
        axes.margins(x=0.0)
    residual.set_xlabel("time t [s]; grey: pitch bends")
    legend_above(figure, columns=3)
    figure.align_ylabels()
    mark_pitch((power, work))
