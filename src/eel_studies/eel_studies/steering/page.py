# SPDX-License-Identifier: Apache-2.0
"""Writes docs/explanation/steering.md: what grows in a swim, what bends can do about it, what ballast does."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from eel_base.files import markdown
from eel_gaits.laws.law import Law

from eel_studies.steering.linearisation import INPUTS, PeriodicLinearisation, periodic_linearisation
from eel_studies.steering.study import (
    CONTROLLED,
    GAITS,
    HIGHEST,
    SEEN,
    SWIM,
    Scan,
    linearised,
    radius_of_gyration,
    recovery,
    sideways_acceleration,
    sway,
)

HEIGHTS = (0.0, 0.01)  # m, of the tables of the first gait
SHOWN = (0.0, 0.005, 0.01, 0.02)  # m, of the table of all gaits
LEANS = (5.0, 20.0)  # degrees
BEND = 0.3  # rad/m, that counts as much as a roll of 1 rad
RISES = (0.1, 0.25, 0.5)  # parts of a period
YAW, PITCH = INPUTS[:3], INPUTS[3:]
SAME = 1e-6  # multipliers that differ by less are one

PAGE = """# Can it be steered?

Made by `eel steering --page {page}`. The paper's robot, in the scene's default physics.

The motion is linearised over one period of the gait. The settled motion repeats itself, except for position and
heading. The monodromy matrix maps a small disturbance at the start of a period to the disturbance at its end. Its
eigenvalues, the *multipliers*, are the factors by which a disturbance along a mode changes in one period. Above 1 in
magnitude the disturbance grows. In Python this is `periodic_linearisation(law, scene=...)`.

## What grows
The gait `straight` at 1 Hz without ballast. Disturbances in the plane (heading, speed, drift) decouple from those out
of it (roll, pitch, vertical), by the mirror symmetry of body and gait.

{without}

**One mode grows, by a factor of {growth:.2f} = e^{exponent:.3f} a period.** It is roll, with some pitch. A swim that
begins from rest reaches this rate after some periods; a fit over its first periods gives e^1.45
([stability](../appendix/stability.md#a-planar-law-in-space)). Multipliers of 1 belong to the attitude, which nothing
restores.

The columns *held by* show whether a controller can influence the mode. The value is the least singular value of
[A - multiplier, B], the test of Popov, Belevitch and Hautus, with time in periods and bends as angles between head and
tail. At 0 no controller can influence the mode with these bends. For the multiplier of 1 it shows whether all three
angles can be influenced at once. Bends are uniform along the body, and come and go within the period, over a quarter
of it each.

## What bends can do
- **Yaw alone cannot touch roll**, to first order. A bend in yaw keeps the swimmer in its plane.
- **Pitch can.** The table shows by how much a bend in pitch of 1 rad/m changes the growing mode, in rad of roll. The
  rows differ in the part of the period in which the bend comes, and goes again. The columns are its course between:

{kicks}

  A bend acts one way in one quarter of the period and the other way in the next. So the effect of a constant bend
  depends on how it comes and goes. A bend that varies as the cosine of the gait's phase acts the same way in both.
- **Yaw and pitch together hold all nine modes**, with and without ballast.

This table shows a linear-quadratic controller that acts once a period, in the full model, not in its linearisation:

{recovered}

So bends in yaw and pitch are enough, if the controller knows the attitude and its bends vary with the gait.
This controller knows the whole state exactly, and its model has no error. Noise of sensors, delays and an inexact model
make the result worse. The [pilot](../howto/pilot.md) holds the roll with such bends from the motion of the head alone.

## What ballast does
With `Scene(metacentric_height=h)` the weight acts h below the buoyancy ([model](model.md#weight-and-buoyancy)). With
10 mm the same gait has the multipliers

{with_ballast}

The growth becomes an oscillation that grows. Enough ballast ends it. The moment that turns the swimmer over comes
from the water, and grows with the square of the frequency. The moment of the weight does not. So the height that
stabilises a gait grows with the square of the frequency, and slow or small strokes need little. No more than
{highest:g} mm fit into the body.

{gaits}

*Growth*: the greatest magnitude of the multipliers, without the neutral ones.
*Sway*: the greatest angle between the head's axis 3 and up
over the last {seen} of {swim} periods, after a push of 1 degree of roll. Roll drag goes with the square of the rate.
It hardly acts on a small disturbance, and bounds a large one. So with ballast a gait that is unstable to first order
sways, and does not turn over.

![Multipliers over the metacentric height]({picture})

Where a curve falls and rises again, two oscillations have the same frequency and interact.

## What is left out
Only the moment of the weight is modelled. The mass stays on the backbone. A mass below it would have two more
effects:
- Its moment of inertia in roll is larger by m h^2. The radius of gyration in roll is {gyration:.0f} mm with the
  water, so at 10 mm this is {missing:.0%} more, and at 20 mm {missing_twice:.0%}. The rolling is somewhat slower than
  here.
- It lags behind a sideways acceleration a, and rolls the body like a lean of a/g rad. In the straight gait at 1 Hz
  this is {whole:.2g} for the whole body, and {tail:.2g} for the tail alone; at 0.5 Hz
  a quarter of it. So the roll of the whole body hardly changes, but the torque along the body does.

So results for heights beyond some 20 mm show a trend only.
Coarser settings change the multipliers by at most {error:.0e}.
"""


def write_page(path: Path, scans: list[Scan], picture: str):
    """Write the page to `path`, from the `scans` of `GAITS`. picture: its path from there. `OSError`: not writable."""
    first = {height: linearised(scans[0].law, height, estimate=True) for height in HEIGHTS}
    free = first[0.0]
    gyration = radius_of_gyration(free.body)
    whole, tail = sideways_acceleration(scans[0].law)
    text = PAGE.format(
        page=path,
        without=_modes(free),
        with_ballast=_modes(first[HEIGHTS[-1]]),
        growth=free.growth,
        exponent=np.log(free.growth),
        kicks=_kicks(scans[0].law),
        recovered=_recovered(first),
        gaits=_gaits(scans),
        highest=1e3 * HIGHEST,
        seen=SEEN,
        swim=SWIM,
        picture=picture,
        gyration=1e3 * gyration,
        missing=(0.01 / gyration) ** 2,
        missing_twice=(0.02 / gyration) ** 2,
        whole=whole,
        tail=tail,
        error=max(each.error for each in first.values()),
    )
    markdown.write_page(path, text)


def _modes(found: PeriodicLinearisation) -> str:
    """The modes as a table; a conjugate pair takes one line."""
    rows = []
    held = [found.controllability(inputs) for inputs in (YAW, PITCH, INPUTS)]
    attitude = list(np.flatnonzero(found.neutral))
    for mode, multiplier in enumerate(found.multipliers):
        if multiplier.imag < -SAME or mode in attitude[1:]:
            continue
        value = f"{multiplier.real:.3f}" + (f" ± {multiplier.imag:.3f}i" if multiplier.imag > SAME else "")
        motion = found.motion_of(mode).replace("_", " ")
        if mode in attitude and len(attitude) > 1:
            value, motion = f"{value}, three times", "roll, pitch, heading"
        rows.append((value, f"{abs(multiplier):.3f}", motion, *(_rounded(each[mode]) for each in held)))
    return markdown.table(("multiplier", "magnitude", "motion", "held by yaw", "by pitch", "by both"), rows)


def _kicks(law: Law) -> str:
    lines = ["  | part of the period | constant | as cos | as sin |", "  |---|---|---|---|"]
    for rise in RISES:
        kick = periodic_linearisation(law, rise=rise, estimate=False).kick(0)[len(YAW) :].real
        lines.append(f"  | {rise:g} | " + " | ".join(f"{each:+.3f}" for each in kick) + " |")
    return "\n".join(lines)


def _rounded(value: float) -> str:
    return "0" if value < 1e-6 else f"{value:.2g}"


def _recovered(first: dict[float, PeriodicLinearisation]) -> str:
    head = "metacentric height", "roll at the start", f"after 1, 2, 4, 8, {CONTROLLED} periods", "greatest bend"
    rows = []
    for height, found in first.items():
        for lean in LEANS:
            roll, bend = recovery(found, np.radians(lean), BEND)
            rolls = ", ".join(f"{np.degrees(roll[k - 1]):.2g}" for k in (1, 2, 4, 8, CONTROLLED))
            rows.append((f"{1e3 * height:g} mm", f"{lean:g}°", f"{rolls}°", f"{bend:.2g} rad/m"))
    return markdown.table(head, rows)


def _gaits(scans: list[Scan]) -> str:
    heights = [f"{1e3 * height:g} mm" for height in SHOWN]
    head = "gait", "speed", "steady from", f"growth at {', '.join(heights)}", f"sway at {', '.join(heights[1:])}"
    rows = []
    for scan in scans:
        found = [linearised(scan.law, height) for height in SHOWN]
        speed = np.linalg.norm(found[0].end.position) / found[0].period
        growth = ", ".join(f"{each.growth:.3f}" for each in found)
        swaying = ", ".join(f"{np.degrees(sway(each)):.1f}°" for each in found[1:])
        steady = f"none up to {1e3 * HIGHEST:g} mm" if scan.steady_from is None else f"{1e3 * scan.steady_from:.1f} mm"
        rows.append((scan.name, f"{speed:.2f} m/s", steady, growth, swaying))
    return markdown.table(head, rows)


def scans_of(points: int, progress: Callable[[int, int], object] = lambda done, count: None) -> list[Scan]:
    """The scans of all `GAITS`. progress(done, count) is called after each."""
    scans = []
    for name, law in GAITS.items():
        scans.append(Scan.of(name, law, points))
        progress(len(scans), len(GAITS))
    return scans
