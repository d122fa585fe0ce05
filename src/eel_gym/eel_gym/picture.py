# SPDX-License-Identifier: Apache-2.0
"""A small picture of the swimmer, from above and from the side, drawn by matplotlib without a display."""

import numpy as np
from eel_dynamics.model.body.body import Body
from eel_dynamics.simulation.observations import Snapshot

SIZE, DPI = (8.0, 4.0), 100  # inches, dots per inch
REACH = 1.5  # body lengths shown to each side of the head
BODY, MARK = "#0072B2", "#D55E00"


def picture(snapshot: Snapshot, body: Body, marks: list[tuple[float, float, float]]) -> np.ndarray:
    """The picture (400, 800, 3), uint8, of a `Snapshot`; `marks`: points [m]."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # here: it takes longer to import than everything else
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, dpi=DPI)
    canvas = FigureCanvasAgg(figure)
    line, head = snapshot.backbone, snapshot.position
    views = (("from above", "y [m], left", 1, body.half_width), ("from the side", "z [m], up", 2, body.half_height))
    for axes, (title, label, row, half) in zip(figure.subplots(1, 2), views, strict=True):
        axes.fill(*_outline(line[:, (0, row)], np.asarray(half(snapshot.x), dtype=float)), color=BODY)
        for mark in marks:
            axes.plot(mark[0], mark[row], "x", color=MARK, markersize=9)
        reach = REACH * body.length
        axes.set(xlim=(head[0] - reach, head[0] + reach), ylim=(head[row] - reach, head[row] + reach))
        axes.set(aspect="equal", title=f"{title}, t = {snapshot.time:.2f} s", xlabel="x [m], forward", ylabel=label)
        axes.grid(alpha=0.3)
    figure.tight_layout()
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _outline(line: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The outline of a body of half breadths `half` (M,) [m] about its `line` (M, 2) [m]."""
    along = np.gradient(line, axis=0)
    size = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-12)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / size[:, None] * half[:, None]
    both = np.concatenate((line + across, (line - across)[::-1]))
    return both[:, 0], both[:, 1]
