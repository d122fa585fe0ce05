# SPDX-License-Identifier: Apache-2.0
"""Swimmers with the mean beat of a film: options of commands, the body, and the effect of smoothing on the speed."""

import argparse
from collections.abc import Sequence

import numpy as np
from eel_common.wording import shown
from eel_gaits.film.beat import Beat, beat_of
from eel_gaits.film.film import LIKELY, Film, read_film

from eel_dynamics.batches.simulate_batch import simulate_batch
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.body.text import body_of
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED

FITTING = 0.05  # allowed relative difference of the body's and the film's length
ACCURACY = 1e-2  # of the swims for the effect of smoothing
EEL = "kern2006"


def add_film_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for reading a film; all concern files of midlines."""
    parser.add_argument(
        "--units",
        metavar="UNIT",
        help="of midlines: m, cm, mm, um, km, inch, or px with --scale; of joints: rad or deg",
    )
    parser.add_argument("--time", default="", metavar="COLUMN", help="of times in a table, by its name or number")
    parser.add_argument("--rate", type=float, metavar="FPS", help="frames per second, where a file counts frames")
    parser.add_argument("--animal", metavar="NAME,...", help="which of several animals in the file, or its tracks")
    parser.add_argument("--points", metavar="NAME,...", help="those along the body, from head to tail: names, or "
                        "patterns such as spine* (all, in the file's order)")  # fmt: skip
    parser.add_argument("--likely", type=float, metavar="P", help="a tracker's likelihood or score "
                        f"below which a point counts as missing ({LIKELY:g})")  # fmt: skip
    parser.add_argument(
        "--rigid", type=float, default=0.0, metavar="PART", help="of the length from the head on that does not bend (0)"
    )
    parser.add_argument("--harmonics", type=int, metavar="N", help="of the beat (as many as predict it best)")


def film_of(path: str, options: argparse.Namespace) -> Film:
    """The film in the file at `path`, read with these `options`."""
    scale = None if options.scale == 1.0 else options.scale
    points = None if options.points is None else [name.strip() for name in options.points.split(",")]
    return read_film(
        path, units=options.units, scale=scale, time=options.time, rate=options.rate, animal=options.animal,
        points=points, likely=options.likely,
    )  # fmt: skip


def beat_from(path: str, options: argparse.Namespace) -> Beat:
    """The mean beat in the file at `path`, with these `options`."""
    return beat_of(film_of(path, options), harmonics=options.harmonics, rigid=options.rigid)


def body_for(text: str | None, film: Film) -> Body:
    """The body of --body; None or kern2006: an eel's, as long as the `film`'s swimmer."""
    if text in (None, EEL):
        return Body.kern2006(film.length)
    body = body_of(str(text))
    if abs(body.length - film.length) > FITTING * film.length:
        raise ValueError(
            f"body {shown(body.name)} is {body.length:g} m long, the swimmer in the film {film.length:.4g} m: give a "
            f"body of that length, or none for {EEL} of that length"
        )
    return body


def speeds_of(beats: Sequence[Beat], body: Body, scene: Scene) -> np.ndarray:
    """Mean speed [m/s] of each of the `beats` in the settled state; NaN for a swim that stops."""
    laws = [beat.law(body.length) for beat in beats]
    batch = simulate_batch(laws, UNTIL_SETTLED, bodies=body, scenes=scene, accuracy=ACCURACY, estimate=False)
    return np.array([np.nan if batch.stopped[i] else batch[i].mean_speed for i in range(len(laws))])


def effect_of_fit(beat: Beat, body: Body, scene: Scene) -> list[tuple[str, str]]:
    """The effect of the choice of the fit on the speed, as names and sentences."""
    others = [beat_of(beat.film, harmonics=count, rigid=beat.rigid) for count in range(1, beat.most_harmonics + 1)]
    speeds = speeds_of([beat, *others, *beat.others], body, scene)
    mean, by_count, without = speeds[0], speeds[1 : len(others) + 1], speeds[len(others) + 1 :]
    half = float(beat.half_band(without))
    listed = ", ".join(f"{count + 1}: {speed:.4g}" for count, speed in enumerate(by_count))
    seen = beat.measured.speed
    return [
        ("speed", f"{mean:.4g} m/s, {mean - half:.4g} to {mean + half:.4g} m/s by the beats (95 %)"),
        ("speed by harmonics", f"{listed} m/s"),
        ("beside the film", f"{seen:.4g} m/s measured: {mean / seen - 1.0:+.1%} computed"),
    ]
