# SPDX-License-Identifier: Apache-2.0
"""`python evidence/life.py`: filmed swimmers beside what was measured on them.

python evidence/life.py lamprey docs/data/lamprey_midlines.csv --widths docs/data/widths.csv --out lamprey.png
python evidence/life.py robot docs/data/tendon_fish_hinges_?.??Hz.csv --rigid 0.64
"""

import argparse
import sys
from pathlib import Path
from typing import TypeAlias

import numpy as np
from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.quantity import positive
from eel_dynamics.commands.filmed import add_film_options, beat_from
from eel_dynamics.commands.options import add_options, add_repeated, scene_of, set_numbers
from eel_dynamics.model.body.text import body_of
from eel_gaits.film.beat import Beat
from eel_studies.outputs import Table, checked_outs, write_files
from eel_studies.pictures import BLACK, BLUE, GREY, LOOKS, PALE_BLUE, Axes, Draw, Figure, along_way, legend_above
from studied.lamprey import HEIGHTS, LampreySwim, Thickened, in_thick_water, lamprey, swims, thickened
from studied.lamprey import PLANAR as WATER_OF_FILM
from studied.leave_out import PLANAR, Choice, choices, computed, swum
from studied.tendon_fish import tendon_fish

from eel_dynamics import Run

NAME = "life.py"
Drawn: TypeAlias = tuple[Table, Draw, tuple[float, float]]  # with the picture and its size, inches
FIRST = {"appendage_factor": 1.0}  # one number: with two, films that are left out are predicted worse
SHOWN = 6  # midlines of a beat


def _add_options(parser: Parser) -> None:
    parser.add_argument(
        "swimmer",
        choices=("lamprey", "robot"),
        help="lamprey: without any fitted number, as a band over the body's height, and in thicker water; robot: drag "
        "fitted on some films, judged by the others",
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="films: tracked points, docs/howto/motions.md")
    add_film_options(parser)
    add_options(parser, "--scale", "--body", "--scene", body=(None, "of the robot: that of the tendon fish"))
    add_repeated(parser, "--set", "NAME=VALUE", "a number of the body")
    parser.add_argument("--widths", metavar="FILE", help="of a lamprey: columns s_by_length, lamprey_width_by_length")
    parser.add_argument("--mass", type=float, metavar="KG", help="of the robot (by its body's density)")
    parser.add_argument("--fit", type=int, default=2, metavar="N", help="films that are fitted at a time (2)")
    add_repeated(parser, "--first", "NAME=VALUE", "a number of the body to fit, with its first guess "
                 f"({', '.join(f'{name}={value:g}' for name, value in FIRST.items())})")  # fmt: skip
    add_options(parser, "--out")


@command(NAME, "Swim by filmed motions, and compare with what was measured.", add_options=_add_options)
def main(options: argparse.Namespace) -> None:
    outs = checked_outs(NAME, options)
    beats = [beat_from(file, options) for file in options.files]
    for beat in beats:
        print(f"{beat.film.name}: points {', '.join(beat.film.names)}")
        print(*(f"{beat.film.name}, doubtful: {text}\n" for text in beat.doubts), sep="", end="")
    table, draw, size = (_lamprey if options.swimmer == "lamprey" else _robot)(beats, options)
    print(table.text())
    write_files(outs, table.write_csv, draw, size)


def _lamprey(beats: list[Beat], options: argparse.Namespace) -> Drawn:
    if len(beats) != 1 or options.widths is None:
        raise ValueError("lamprey takes one film, and the --widths of the body by its length")
    (beat,) = beats
    widths = Path(options.widths)
    scene, numbers = scene_of(options.scene, WATER_OF_FILM), set_numbers(options.set)
    found = swims(beat, widths, scene, **numbers)
    bodies = [lamprey(beat.film.length, height, widths, **numbers) for height in HEIGHTS]
    measured = thickened(Path(options.files[0]))
    thick = [in_thick_water(beat, body, measured, scene) for body in bodies]
    table = table_of_lamprey(beat, found, measured, thick)
    return table, lambda figure: draw_lamprey(figure, beat, found, measured, thick), (6.8, 6.4)


def table_of_lamprey(
    beat: Beat, found: list[LampreySwim], measured: list[Thickened], thick: list[list[float]]
) -> Table:
    """Measured, ours as a band over the bodies, and the difference; with what was `measured` in thick water."""
    seen, ours = beat.measured, [swim.figures for swim in found]
    speeds = [swim.speed for swim in found]
    low, high = (speeds[0] - found[0].band), (speeds[-1] + found[-1].band)
    strides = [speed * beat.period / beat.film.length for speed in speeds]
    tails = [float(each.excursion[-1]) for each in ours]
    rows = [
        _row("speed [m/s]", seen.speed, speeds),
        ("speed, with the beats' 95 % band [m/s]", f"{seen.speed:.4g}", f"{low:.4g} to {high:.4g}", ""),
        _row("stride [L]", seen.stride, strides),
        _row("tail, side to side [L]", float(seen.excursion[-1]), tails),
        _row("wave [L]", seen.wavelength, [each.wavelength for each in ours]),
        _row("slip", seen.slip, [stride / each.wavelength for stride, each in zip(strides, ours, strict=True)]),
        _row("Strouhal number", seen.strouhal, [tail / stride for tail, stride in zip(tails, strides, strict=True)]),
        _row("head's yaw, amplitude [rad]", seen.yaw, [each.yaw for each in ours]),
    ]
    for index, (times, _, _, speed, spread) in enumerate(measured):
        ours_here = [1e3 * row[index] for row in thick]
        name = f"speed at {times:g} x viscosity [mm/s]"
        rows.append((name, f"{speed:g} +- {spread:g}", *_against(speed, ours_here)))
        if index:
            fall, falls = speed / measured[0].speed_mm_s - 1.0, [row[index] / row[0] - 1.0 for row in thick]
            rows.append((f"fall at {times:g} x viscosity", f"{fall:.0%}", f"{min(falls):.0%} to {max(falls):.0%}", ""))
    return Table(("", "measured", "ours, over fins of 0.02 to 0.04 L", "difference"), rows)


def _row(name: str, measured: float, ours: list[float]) -> tuple[str, ...]:
    return (name, f"{measured:.4g}", *_against(measured, ours))


def _against(measured: float, ours: list[float]) -> tuple[str, str]:
    low, high = min(ours), max(ours)
    return f"{low:.4g} to {high:.4g}", f"{low / measured - 1.0:+.0%} to {high / measured - 1.0:+.0%}"


def _robot(beats: list[Beat], options: argparse.Namespace) -> Drawn:
    if len(beats) <= options.fit or options.fit < 1:
        raise ValueError(f"robot needs more films than the {options.fit} that --fit takes, got {len(beats)}")
    body = tendon_fish() if options.body is None else body_of(options.body)
    if options.mass is not None:
        body = body.changed(density=positive("mass", options.mass, "kg") / body.volume)
    body = body.changed(**set_numbers(options.set))
    first, scene = set_numbers(options.first, "--first") or FIRST, scene_of(options.scene, PLANAR)
    guessed = computed(beats, body, scene)
    found = choices(beats, body, first, options.fit, scene)
    table = table_of_robot(beats, guessed, found)
    last = max(range(len(beats)), key=lambda film: 1.0 / beats[film].period)
    left_out = next((each for each in found if last not in each.fitted), found[0])
    swim = beats[last], swum(beats[last], body.changed(**left_out.values), scene)[0]
    return table, lambda figure: draw_robot(figure, beats, guessed, found, swim), (6.8, 6.2)


def table_of_robot(beats: list[Beat], guessed: np.ndarray, found: list[Choice]) -> Table:
    """A row for each choice of the films that are fitted, with the speeds of all and the error of the others."""
    measured = np.array([beat.measured.speed for beat in beats])
    heads = [beat.film.name.rpartition(".")[0] for beat in beats]
    rows = [
        ("measured [m/s]", *(f"{each:.4f}" for each in measured), ""),
        ("nothing fitted", *(f"{each:.4f}" for each in guessed), f"{np.mean(np.abs(guessed - measured)):.4f}"),
    ]
    for each in found:
        values = ", ".join(f"{name} {value:.3g}" for name, value in each.values.items())
        cells = [f"{speed:.4f}{'*' if film in each.fitted else ''}" for film, speed in enumerate(each.speeds)]
        rows.append((values, *cells, f"{np.mean(np.abs(each.left_out(measured))):.4f}"))
    left_out = np.concatenate([each.left_out(measured) for each in found])
    rows.append(("leave-out error, mean of all", *("" for _ in beats), f"{np.mean(np.abs(left_out)):.4f}"))
    return Table(("*: fitted", *heads, "mean error"), rows)


def draw_lamprey(
    figure: Figure, beat: Beat, found: list[LampreySwim], measured: list[Thickened], thick: list[list[float]]
) -> None:
    """Midlines of one beat, measured above and computed below; speed over the fin's height, and over the viscosity
    where that was `measured`."""
    panels = figure.subplot_mosaic(
        [["lines", "lines"], ["speed", "water" if measured else "speed"]], height_ratios=(1.4, 1.0)
    )
    lines, speed = panels["lines"], panels["speed"]
    _draw_midlines(lines, beat, found[len(found) // 2].run)
    heights, ours = [swim.height for swim in found], np.array([swim.speed for swim in found])
    bands = np.array([swim.band for swim in found])
    speed.fill_between(heights, ours - bands, ours + bands, color=PALE_BLUE, label="95 % by the beats")
    speed.plot(heights, ours, color=BLUE, marker="o", label="computed")
    speed.axhline(beat.measured.speed, color=BLACK, linestyle=(0, (4, 2)), label="measured")
    speed.set(xlabel="half-height of the fin [L]", ylabel="speed [m/s]", ylim=(0.0, None))
    speed.margins(x=0.0)
    if measured:
        _draw_thick_water(panels["water"], measured, thick)
    legend_above(figure, 3)


def _draw_thick_water(axes: Axes, measured: list[Thickened], thick: list[list[float]]) -> None:
    times, _, _, speeds, spreads = zip(*measured, strict=True)
    axes.errorbar(times, speeds, spreads, color=BLACK, marker="s", linestyle=(0, (4, 2)), capsize=3)
    low, high = 1e3 * np.min(thick, axis=0), 1e3 * np.max(thick, axis=0)
    axes.fill_between(times, low, high, color=PALE_BLUE)
    axes.plot(times, 0.5 * (low + high), color=BLUE, marker="o")
    axes.set(xlabel="viscosity, times water's", ylabel="speed [mm/s]", ylim=(0.0, None))
    axes.margins(x=0.0)


def _draw_midlines(axes: Axes, beat: Beat, run: Run) -> None:
    """Midlines at equal parts of a beat along the way of each, the measured and below them the computed."""
    length = beat.film.length
    ours = run.time > run.time[-1] - 1.001 * beat.period
    middle = beat.film.time >= np.median(beat.film.time)
    sets = (
        (beat.film.time[middle], beat.film.points[middle], BLACK),
        (run.time[ours], run.backbone[ours][:, :, :2], BLUE),
    )
    for row, (time, points, colour) in enumerate(sets):
        start = points[0]
        for part in range(SHOWN):
            frame = int(np.argmin(np.abs(time - time[0] - part * beat.period / SHOWN)))
            line = along_way(points[frame] - start.mean(axis=0), start[0] - start[-1]) / length
            alpha = 0.35 + 0.65 * part / SHOWN
            axes.plot(line[:, 0], line[:, 1] - 0.45 * row, color=colour, linewidth=1.0, alpha=alpha)
    title = f"one beat of {beat.period:.3f} s: measured (black), computed (blue)"
    axes.set(aspect="equal", xlabel="along the way [L]", yticks=[], title=title)


def draw_robot(
    figure: Figure, beats: list[Beat], guessed: np.ndarray, found: list[Choice], swim: tuple[Beat, Run]
) -> None:
    """One beat of a swim that was left out; speed over frequency: measured, without a fit, and predicted."""
    lines, axes = figure.subplots(2, 1, height_ratios=(1.0, 1.4))
    _draw_midlines(lines, *swim)
    frequency = np.array([1.0 / beat.period for beat in beats])
    order = np.argsort(frequency)
    measured = np.array([beat.measured.speed for beat in beats])
    axes.plot(frequency[order], measured[order], color=BLACK, marker="s", label="measured")
    axes.plot(frequency[order], guessed[order], color=GREY, linestyle=(0, (1, 1)), marker="v", label="nothing fitted")
    for index, each in enumerate(found):
        colour, _, mark = LOOKS[index % (len(LOOKS) - 1)]
        rest = [film for film in range(len(beats)) if film not in each.fitted]
        label = "left out, predicted" if index == 0 else None
        axes.plot(frequency[rest], each.speeds[rest], mark, color=colour, alpha=0.8, label=label)
    axes.set(xlabel="beats per second", ylabel="speed [m/s]", ylim=(0.0, None))
    legend_above(figure, 3)


if __name__ == "__main__":
    sys.exit(main())
