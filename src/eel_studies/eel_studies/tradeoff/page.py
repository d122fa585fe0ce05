# SPDX-License-Identifier: Apache-2.0
"""What docs/appendix/tradeoff.md tells: six rows, a picture and the worth of terms of one scene; presets in all."""

import math
import platform
from datetime import date
from pathlib import Path

from eel_dynamics.accuracy.accuracy import PRESETS

import eel_core
from eel_studies.outputs import Outputs
from eel_studies.table import Table
from eel_studies.tradeoff.measuring import REACHED, Trade
from eel_studies.tradeoff.table import WANTED, cheapest, digits_table, worth_table

PARTS = "digits", "picture", "models", "scenes"


def write_page(outputs: Outputs, found: list[Trade], pictures: list[str]) -> None:
    """Write the page, where one is asked for, of the trades `found` and their `pictures`, as the page links them."""
    first = found[0]
    values = {
        "machine": machine(),
        "gait": first.name,
        "duration": f"{first.duration:g}",
        "digit": digit_line(first),
    }
    scenes = "\n\n".join((scenes_table(found).markdown(), *pictures[1:]))
    texts = digits_table(first).markdown(), pictures[0], worth_table(first).markdown(), scenes
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
    """How well the reference is known, in words."""
    unstable = f" {len(trade.unstable)} settings diverged." if trade.unstable else ""
    poor = "" if trade.reference_error <= 10.0 * REACHED else f": this scene cannot be solved to {REACHED:g}"
    return (
        f"Two methods on two grids agree to {trade.reference_error:.0e}{poor}; smaller errors are not told apart."
        f"{unstable}"
    )


def scenes_table(found: list[Trade]) -> Table:
    """A row for each scene: how well its reference is known, what presets deliver, and times real time."""
    rows = []
    for trade in found:
        rows_of = {row.accuracy.name: row for row in trade.rows}
        cells = [rows_of.get(name) for name in PRESETS]
        texts = ("diverges" if row is None else f"{row.error:.0e} at {row.times_real_time:.0f}" for row in cells)
        rows.append((f"{trade.name}, {trade.duration:g} s", f"{trade.reference_error:.0e}", *texts))
    return Table(("scene", "reference", *PRESETS), rows)


def machine() -> str:
    """Processor, date and instruction set of the measurement, in words."""
    processor = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        processor = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f"one core ({processor}), {date.today()}, the mechanics compiled for {eel_core.build_info()['level']}"
