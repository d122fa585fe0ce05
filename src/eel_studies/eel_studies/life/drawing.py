# SPDX-License-Identifier: Apache-2.0
"""The pictures of `eel life`."""

import numpy as np
from eel_dynamics.runs.run import Run
from eel_gaits.film.beat import Beat

from eel_studies.life.lamprey import MEASURED, LampreySwim
from eel_studies.life.leave_out import Choice
from eel_studies.pictures import BLACK, BLUE, GREY, LOOKS, PALE_BLUE, Axes, Figure, legend_above

SHOWN = 6  # midlines of a beat


def draw_lamprey(figure: Figure, beat: Beat, found: list[LampreySwim], thick: list[list[float]]) -> None:
    """Midlines of one beat, measured above and computed below; speed over the fin's height; speed over viscosity."""
    panels = figure.subplot_mosaic([["lines", "lines"], ["speed", "water"]], height_ratios=(1.4, 1.0))
    lines, speed, water = (panels[name] for name in ("lines", "speed", "water"))
    _draw_midlines(lines, beat, found[len(found) // 2].run)
    heights, ours = [swim.height for swim in found], np.array([swim.speed for swim in found])
    bands = np.array([swim.band for swim in found])
    speed.fill_between(heights, ours - bands, ours + bands, color=PALE_BLUE, label="95 % by the beats")
    speed.plot(heights, ours, color=BLUE, marker="o", label="computed")
    speed.axhline(beat.measured.speed, color=BLACK, linestyle=(0, (4, 2)), label="measured")
    speed.set(xlabel="half-height of the fin [L]", ylabel="speed [m/s]", ylim=(0.0, None))
    times = [each.times for each in MEASURED]
    speeds, spreads = zip(*((each.speed, each.spread) for each in MEASURED), strict=True)
    water.errorbar(times, speeds, spreads, color=BLACK, marker="s", linestyle=(0, (4, 2)), capsize=3)
    low, high = 1e3 * np.min(thick, axis=0), 1e3 * np.max(thick, axis=0)
    water.fill_between(times, low, high, color=PALE_BLUE)
    water.plot(times, 0.5 * (low + high), color=BLUE, marker="o")
    water.set(xlabel="viscosity, times water's", ylabel="speed [mm/s]", ylim=(0.0, None))
    speed.margins(x=0.0)
    water.margins(x=0.0)
    legend_above(figure, 3)


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
        ahead = start[0] - start[-1]
        ahead = ahead / np.linalg.norm(ahead)
        turn = np.stack((ahead, [-ahead[1], ahead[0]]), axis=1)
        for part in range(SHOWN):
            frame = int(np.argmin(np.abs(time - time[0] - part * beat.period / SHOWN)))
            line = (points[frame] - start.mean(axis=0)) @ turn / length
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
