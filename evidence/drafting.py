# SPDX-License-Identifier: Apache-2.0
"""`python evidence/drafting.py`: speed and power of the straight gait behind a cylinder, over its street's spacing and
phase.

python evidence/drafting.py                                          # prints a line per spacing, draws out/drafting.png
python evidence/drafting.py --page docs/explanation/drafting.md --out docs/images    # the page and its picture
"""

import argparse
import sys

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_studies.options import check_least
from eel_studies.outputs import Outputs, Table, add_output_options
from eel_studies.pictures import BLUE, GREEN, GREY, ORANGE, Axes, Figure
from studied.cylinder import Study, Wake, locked_speed, study_of

NAME = "drafting.py"
PARTS = ("picture",)
SIZE = 9.0, 6.6  # inches
SPACINGS = (0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.1, 1.25, 1.5, 2.0, 3.0)  # m
PHASES = 6
LOCKED = 5e-3  # part of the speed of one spacing a beat, within which a swim is locked


def _add_options(parser: Parser) -> None:
    add_output_options(parser)
    parser.add_argument("--phases", type=int, default=PHASES, metavar="N", help=f"at the start, of each ({PHASES})")


@command(
    NAME,
    "Swim the straight gait in the street of vortices behind a cylinder that moves as fast as the "
    "swimmer does in still water, over spacing and phase: speed and power against still water.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    check_least(options, phases=1)
    outputs, progress = Outputs(NAME, options, PARTS), Progress(NAME, "swims")
    study = study_of(SPACINGS, np.arange(options.phases) / options.phases, progress)
    rows = [_row(study, wake, *figures) for wake, *figures in zip(study.wakes, *study.swum.values(), strict=True)]
    for row in rows:
        print(f"spacing {row[0]} m: cylinder {row[1]} m, speed {row[3]}, power {row[4]}, locked {row[6]}")
    picture = outputs.draw("drafting", "Behind a cylinder", lambda figure: draw_study(figure, study), SIZE, ("png",))
    head = "spacing [m]", "cylinder [m]", "core [m]", "speed", "power", "positive part", "locked"
    still, wake = study.still, Wake(study.still.speed, 1.0)
    values = {
        "still_speed": f"{still.speed:.3f}",
        "still_power": f"{still.power:.3f}",
        "mean": f"{wake.mean / still.speed:.2f}",
        "drafting": f"{study.drafting.speed / still.speed:.2f}",
        "least_power": f"{study.swum['power'].min() / still.power:.2f}",
    }
    outputs.write_table("drafting", Table(head, rows))
    outputs.write({"picture": picture}, values)


def _row(study: Study, wake: Wake, speed: np.ndarray, power: np.ndarray, paid: np.ndarray) -> tuple[str, ...]:
    still = study.still
    locked = np.abs(speed / locked_speed(still, wake.spacing) - 1.0) < LOCKED
    sizes = f"{wake.spacing:g}", f"{wake.diameter:.2f}", f"{wake.core:.2f}"
    ranges = _range(speed / still.speed), _range(power / still.power), _range(paid / still.paid)
    return *sizes, *ranges, f"{np.count_nonzero(locked)} of {len(locked)}"


def _range(values: np.ndarray) -> str:
    least, most = f"{values.min():.2f}", f"{values.max():.2f}"
    return least if least == most else f"{least} to {most}"


def draw_study(figure: Figure, study: Study) -> None:
    """Speed and power over the spacing, a dot a phase; below, the water of a street."""
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    speed, power = (figure.add_subplot(grid[0, column]) for column in (0, 1))
    still = study.still
    _draw_dots(speed, study, "speed", still.speed, "speed / that in still water")
    spacings = np.linspace(study.spacings[0], study.spacings[-1], 200)
    locked = locked_speed(still, spacings)
    shown = locked < 1.05 * study.swum["speed"].max()
    speed.plot(spacings[shown], locked[shown] / still.speed, color=GREEN, label="one spacing a beat")
    drafting = study.drafting.speed / still.speed
    speed.axhline(drafting, color=ORANGE, dashes=(4, 2), label="mean velocity of the street alone")
    speed.legend()
    _draw_dots(power, study, "power", still.power, "power / that in still water")
    _draw_dots(power, study, "paid", still.power, "", colour=ORANGE, label="positive part alone")
    power.legend()
    _draw_street(figure.add_subplot(grid[1, :]), Wake(still.speed, 1.0))


def _draw_dots(
    axes: Axes, study: Study, name: str, unit: float, title: str, colour: str = BLUE, label: str = "phases"
) -> None:
    table = study.swum[name] / unit
    across = np.repeat(study.spacings[:, None], table.shape[1], axis=1)
    axes.plot(across.ravel(), table.ravel(), ".", color=colour, markersize=5, label=label)
    axes.axhline(1.0, color=GREY, linewidth=0.8)
    axes.set_xlabel("spacing of the vortices [body lengths]")
    if title:
        axes.set_ylabel(title)


def _draw_street(axes: Axes, wake: Wake) -> None:
    x, y = np.linspace(-1.0, 2.0, 121), np.linspace(-0.4, 0.4, 33)
    places = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1)
    sample = wake.flow(0.0).sample(places.reshape(-1, 3))
    spin = (sample.jacobian[:, 1, 0] - sample.jacobian[:, 0, 1]).reshape(len(y), len(x))
    limit = float(np.abs(spin).max())
    axes.grid(False)
    axes.pcolormesh(x, y, spin, cmap="PuOr", vmin=-limit, vmax=limit, shading="gouraud", rasterized=True)
    u, v, _ = np.moveaxis(sample.velocity.reshape(len(y), len(x), 3), -1, 0)
    axes.quiver(x[::4], y[::4], u[::4, ::4], v[::4, ::4], width=0.0015)
    axes.plot([0.0, 1.0], [0.0, 0.0], color="black", linewidth=4, solid_capstyle="round", alpha=0.6)
    axes.set(aspect="equal", xlabel="x [m]; the cylinder is ahead, to the right", ylabel="y [m]")
    axes.set_title(
        "vorticity and velocity of a street with a spacing of a body length, and the body", fontsize="medium"
    )


if __name__ == "__main__":
    sys.exit(main())
