# SPDX-License-Identifier: Apache-2.0
"""A bar chart of how many times longer other programs take, as SVG for a light ground and a dark one."""

import math
from collections.abc import Mapping
from xml.sax.saxutils import escape

WIDTH, LEFT, RIGHT, ROW, TOP = 720, 250, 110, 30, 34  # pixels: of the chart, left and right of the bars, a row, above
MOST = 3000.0  # times, at the right end of the logarithmic axis
LETTERS, OURS, OTHERS = "#767c82", "#3987e5", "#8a94a0"
FONT = f'font-family="sans-serif" font-size="14" fill="{LETTERS}"'

TITLE = "Processor time for the same swim at equal error, times ours (logarithmic)"


def speed_chart(others: Mapping[str, tuple[float, float]]) -> str:
    """The chart: of each program a bar to the least of its numbers of times, and a paler one to the greatest."""
    bars = {"this simulator": (1.0, 1.0), **others}
    rows = [f'<text x="0" y="18" {FONT} font-weight="bold">{TITLE}</text>']
    for k, (name, (least, greatest)) in enumerate(bars.items()):
        y, colour = TOP + ROW * k, OTHERS if k else OURS
        words = f"{least:,.0f}" if least == greatest else f"{least:,.0f} to {greatest:,.0f}"
        rows.append(f'<text x="{LEFT - 10}" y="{y + 16}" text-anchor="end" {FONT}>{escape(name)}</text>')
        for times, opacity in ((greatest, 0.45), (least, 1.0)):
            shape = f'x="{LEFT}" y="{y}" width="{length(times):.1f}" height="20" rx="2"'
            rows.append(f'<rect {shape} fill="{colour}" fill-opacity="{opacity}"/>')
        rows.append(f'<text x="{LEFT + length(greatest) + 8:.1f}" y="{y + 16}" {FONT}>{words}</text>')
    size = f'viewBox="0 0 {WIDTH} {TOP + ROW * len(bars)}" role="img"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n' + "\n".join(rows) + "\n</svg>\n"


def length(times: float) -> float:
    """Of a bar [pixels]; a bar of 1 can be seen."""
    return 6.0 + (WIDTH - LEFT - RIGHT - 6.0) * math.log(times) / math.log(MOST)
