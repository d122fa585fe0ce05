"""Writes docs/tradeoff.md: the tables, the picture, and how to read them."""

import platform
from datetime import date
from pathlib import Path

from eel_gaits.output_file import replacing

import eel_core
from eel_dynamics.studies.tradeoff.delivered import FAR, Trial, delivered_table, exceeding, farthest, scatter_line
from eel_dynamics.studies.tradeoff.models import Model
from eel_dynamics.studies.tradeoff.settings import CHECK, REFERENCE
from eel_dynamics.studies.tradeoff.table import model_table, trade_table

HEAD = """# What exactness costs, and what a scene requires

Made by `tradeoff {gaits} --page {page}`{machine}.
Times are of the processor, medians of {repeats} rounds in which all settings take turns, of the motion alone (no
ledger, no wrench, one sample), set-up included; they carry over to another machine as ratios only. Errors are against a
run of {points:g} points per body length and a tolerance of {tolerance:g} per step: of the head's position at the end by
its path, and of the torque field (51 stations, 201 instants) by its greatest magnitude.

`P`, `T`: on the Pareto front of pose, of torque: no other setting is both cheaper and more exact. `adams` takes one
evaluation a step, of variable length; `dormand-prince` is the pair of orders 5(4), six evaluations a step, of a length
chosen by the tolerance; `classical` is the Runge-Kutta method of order 4 with fixed steps. `no kinks`: the
places along the body where cross flow and roll change their sign, and the printed friction jumps, are not looked for.

How to read the second table of a gait: a poorer model, solved exactly, is off by that much, so a setting whose own
error is a tenth of it is exact enough wherever that physics is in doubt. What makes no difference to a gait may be left
out of its scene.
"""


DELIVERED = """
## What the targets deliver

Each target of 1e-2 to 1e-9 that the table of accuracy has, on {cases} cases: the gaits of the library and random laws
that the calibration has not seen, both bodies, laminar and printed friction and no drag. Error: the greater of the
head's position and the torque, or of the position where no torque was asked for. Gaits swim for 10 s (4 s without
drag), random laws of a fifth of the usual bends to twice these and 0.4 to 2.5 times the usual pace for 3 to 16 s at
that pace. The settings are the table's for a swim as hard (`difficulty.py`). What is left is luck: errors of many
steps and panels cancel more or less, and the place where a swim ends is one of many where its error could be read.
Nearly all swims are to keep within their target, so many get more than they asked for, and no table can have all of
them within 30 below it. Nor could a pilot run: the luck at ten times the target tells little of that at the target, and
it would cost six tenths of what it is for. The estimate of a run's own error is the difference from a finer run
(`run.error_estimate`).

"""


def write_page(path: Path, found: list[tuple], picture: str | None, trials: list[Trial] | None = None):
    """Write the page to `path`.

    found: pairs of a trade and its models. picture: path of the first gait's picture, relative to the page; None: no
    picture. trials: of what the targets deliver; None: not measured. `OSError` where the page cannot be written.
    """
    gaits = " ".join(trade.law.name for trade, _ in found)
    text = HEAD.format(
        gaits=gaits,
        page=path,
        machine=machine(),
        repeats=found[0][0].repeats,
        points=REFERENCE.resolution,
        tolerance=REFERENCE.tolerance,
    )
    if picture:
        text += f"\n![The trade of the {found[0][0].law.name} gait]({picture})\n"
    for trade, models in found:
        text += f"\n## {trade.law.name}, {trade.duration:g} s\n\n{reference_line(trade)}\n\n"
        text += trade_table(trade, markdown=True) + "\n\n"
        text += model_table(models, trade, markdown=True) + "\n"
    if trials:
        text += DELIVERED.format(cases=len({trial.case.name for trial in trials}))
        text += delivered_table(trials, markdown=True) + "\n"
        text += f"\n{scatter_line(trials)}\n"
        text += f"\nFarther than {FAR:g} below the target: {'; '.join(farthest(trials)) or 'none'}.\n"
        text += f"\nAbove the target: {'; '.join(exceeding(trials)) or 'none'}.\n"
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8")


def reference_line(trade) -> str:
    """The convergence of the reference run, in words."""
    pose, torque = trade.reference_error
    unstable = f" {len(trade.unstable)} settings diverged." if trade.unstable else ""
    check = f"{CHECK.resolution:g} points and {CHECK.tolerance:g}"
    return (
        f"The reference differs from a run of {check} by {pose:.0e} in pose and {torque:.0e} in torque; smaller errors "
        f"are not told apart.{unstable}"
    )


def machine() -> str:
    """Processor, date and instruction set of the measurement, in words."""
    processor = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        processor = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f" on one core ({processor}), {date.today()}, the mechanics compiled for {eel_core.build_info()['level']}"


__all__ = ["Model", "reference_line", "write_page"]
