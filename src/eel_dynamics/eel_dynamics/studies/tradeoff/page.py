# SPDX-License-Identifier: Apache-2.0
"""Writes docs/tradeoff.md: the tables, the picture, and how to read them."""

import platform
from datetime import date
from pathlib import Path

from eel_gaits.output_file import replacing

import eel_core
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


def write_page(path: Path, found: list[tuple], picture: str | None):
    """Write the page to `path`.

    found: pairs of a trade and its models. picture: path of the first gait's picture, relative to the page; None: no
    picture. `OSError` where the page cannot be written.
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
