# SPDX-License-Identifier: Apache-2.0
"""A filmed lamprey: speed without a fitted number, as a band over what was not published, and in thicker water.

The width of the body is published by the length; its height is not. The trunk's section is taken as 1.2 times as high
as wide, and the tail fin's half-height varies. What was measured in thicker water belongs to its film: it stands in a
file beside it, which gives frequency and wavelength too. The curvature's amplitude is kept as in the film.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from eel_common.files.tables import read_table
from eel_dynamics.commands.filmed import speeds_of
from eel_gaits.film.beat import Beat
from eel_gaits.film.kinematics import Kinematics, kinematics

from eel_dynamics import Body, Run, Scene, simulate
from eel_gaits import Law, Term

HEIGHTS = 0.02, 0.03, 0.04  # L, half-height of the tail fin
TRUNK = 1.2  # height of the trunk by its width
FIN = 0.75, 0.9  # L, where the fin begins to rise, and where it is as high as at the tail
NOSE, THINNEST = 0.03, 1e-4  # L: the rounded end of the head; half-width of the fin's edge
WATER = 1e-6  # m^2/s
BEATS = 6  # at the end of a run, from which its figures are taken
PLANAR = Scene(planar=True, friction="blended", internal_wrench=False)


class Thickened(NamedTuple):
    """Animals of a film in water of so many times the viscosity, by the columns of their file."""

    times_viscosity: float
    frequency_hz: float
    wavelength_mm: float
    speed_mm_s: float
    spread_mm_s: float  # standard deviation of the speed


@dataclass(frozen=True)
class LampreySwim:
    """A swim of the film's beat on a body with a fin of this half-height."""

    height: float  # L
    run: Run
    speed: float  # m/s
    band: float  # m/s, half of the 95 % band by the beats
    figures: Kinematics


def lamprey(length: float, height: float, widths: Path, **numbers: float) -> Body:
    """A lamprey of `length` [m] whose tail fin has a half-height of `height` lengths.

    widths: a file with the columns s_by_length and lamprey_width_by_length; the latter is taken as a radius. numbers:
    of the body.
    """
    table = read_table(widths)
    x = np.linspace(0.0, 1.0, 41)
    round_end = np.sqrt(np.minimum(x / NOSE, 1.0))
    radius = np.interp(x, table.column("s_by_length"), table.column("lamprey_width_by_length"))
    half_width = round_end * np.maximum(radius, THINNEST)
    rise = np.clip((x - FIN[0]) / (FIN[1] - FIN[0]), 0.0, 1.0)
    rise = rise**2 * (3.0 - 2.0 * rise)
    half_height = TRUNK * half_width * (1.0 - rise) + height * rise
    body = Body(x=length * x, half_width=length * half_width, half_height=length * half_height, name="lamprey")
    return body.changed(**numbers)


def swims(beat: Beat, widths: Path, scene: Scene = PLANAR, **numbers: float) -> list[LampreySwim]:
    """The beat on bodies with fins of the half-heights `HEIGHTS`, and these numbers of the body."""
    found = []
    for height in HEIGHTS:
        body = lamprey(beat.film.length, height, widths, **numbers)
        run = simulate(beat.law(body.length), "settled", body=body, scene=scene, accuracy=1e-2)
        last = run.time > run.time[-1] - BEATS * beat.period
        figures = kinematics(run.time[last], run.backbone[last, :, :2], beat.period)
        band = float(beat.half_band(speeds_of(beat.others, body, scene)))
        found.append(LampreySwim(height, run, run.mean_speed, band, figures))
    return found


def thickened(film: Path) -> list[Thickened]:
    """What was measured on the animals of this `film` in thicker water: FILM_thick_water.csv beside it, or nothing.

    The first row is of the film's own water. `ValueError` for a file that does not fit.
    """
    path = film.with_name(f"{film.stem}_thick_water.csv")
    if not path.exists():
        return []
    table, names = read_table(path), Thickened._fields
    if missing := [name for name in names if name not in table]:
        raise table.error(
            f"speeds in thick water must have the columns {', '.join(names)}; {', '.join(missing)} missing"
        )
    rows = np.column_stack([table.column(name) for name in names])
    if len(bad := np.flatnonzero(np.any(rows <= 0.0, axis=1))):
        raise table.error("all numbers must be > 0", bad[0])
    if rows[0, 0] != 1.0:
        raise table.error(f"the first row must be of 1 times the viscosity, got {rows[0, 0]:g}", 0)
    return [Thickened(*row) for row in rows.tolist()]


def in_thick_water(beat: Beat, body: Body, measured: list[Thickened], scene: Scene = PLANAR) -> list[float]:
    """Speed [m/s] at each viscosity that was `measured`, with its frequency, and its wavelength by that in water."""
    found = []
    for each in measured:
        law = wave_of(beat, body.length, 1.0 / each.frequency_hz, measured[0].wavelength_mm / each.wavelength_mm)
        thick = replace(scene, viscosity=each.times_viscosity * WATER)
        found.append(simulate(law, "settled", body=body, scene=thick, accuracy=1e-2).mean_speed)
    return found


def wave_of(beat: Beat, length: float, period: float, waves: float) -> Law:
    """The beat's first harmonic with another `period` [s], and `waves` times as many waves along the body."""
    wave = beat.film.length / length * (beat.curvature[1] - 1j * beat.curvature[2])
    phase = np.unwrap(np.angle(wave))
    wave = np.abs(wave) * np.exp(1j * (phase[0] + waves * (phase - phase[0])))
    knots = np.linspace(0.0, length, 33)
    parts = [np.interp(knots, np.linspace(0.0, length, len(wave)), part) for part in (wave.real, -wave.imag)]
    common: dict[str, Any] = {"knots": tuple(knots), "period": period}
    pairs = zip(parts, (0.5 * math.pi, math.pi), strict=True)
    return Law([Term(amplitude=tuple(part), phase=phase, **common) for part, phase in pairs], name="wave")
