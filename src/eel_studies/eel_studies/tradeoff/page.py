# SPDX-License-Identifier: Apache-2.0
"""What docs/appendix/tradeoff.md tells: six rows, a picture, and the simpler models."""

import math
import platform
from datetime import date
from pathlib import Path

import eel_core
from eel_studies.outputs import Outputs
from eel_studies.tradeoff.measuring import Trade
from eel_studies.tradeoff.models import Model
from eel_studies.tradeoff.settings import CHECK
from eel_studies.tradeoff.table import WANTED, cheapest, digits_table, model_table

PARTS = "digits", "picture", "models"


def write_page(outputs: Outputs, found: list[tuple[Trade, list[Model]]], pictures: list[str]) -> None:
    """Write the page, where one is asked for, of the first gait.

    found: pairs of a trade and its models. pictures: of them, as the page links them.
    """
    first, models = found[0]
    values = {
        "machine": machine(),
        "gait": first.name,
        "duration": f"{first.duration:g}",
        "digit": digit_line(first),
    }
    texts = digits_table(first).markdown(), pictures[0], model_table(models, first).markdown()
    outputs.write(dict(zip(PARTS, texts, strict=True)), values)


def digit_line(trade: Trade) -> str:
    """What one more digit costs in the mean of the short table, in words; empty where it has fewer than two rows."""
    rows = [row for row in cheapest(trade) if row is not None]
    if len(rows) < 2:
        return ""
    digits = math.log10(WANTED[0] / WANTED[len(rows) - 1])
    factor = (rows[0].times_real_time / rows[-1].times_real_time) ** (1.0 / digits)
    return f"One more digit takes {factor:.1f} times as long, in the mean."


def reference_line(trade: Trade) -> str:
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
    return f"one core ({processor}), {date.today()}, the mechanics compiled for {eel_core.build_info()['level']}"
