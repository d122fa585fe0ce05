# SPDX-License-Identifier: Apache-2.0
"""The picture of a run: path, speed and torque; and of a batch: all paths."""

from typing import Any

import numpy as np
from eel_common.cell import BLUE, GREY, figure

BODIES = 6  # instants at which the body is drawn
MOST_ROWS = 10  # of a table of swimmers
MOST_PATHS = 200


def picture_of_run(run: Any) -> Any:
    """A matplotlib figure: the path of the head with the body at some instants, from above; speed; torque C3."""
    panels = 2 if run.torque is None else 3
    made, (panels_of_row,) = figure(3.5 * panels, 2.5, (1, panels), width_ratios=[1.35, 1.0, 1.2][:panels])
    above, speed = panels_of_row[:2]
    for line in run.backbone[np.linspace(0, len(run.time) - 1, BODIES).astype(int)]:
        above.plot(line[:, 0], line[:, 1], color=BLUE, linewidth=1.6)
        above.plot(line[0, 0], line[0, 1], "o", color=BLUE, markersize=3.5)
    above.plot(run.position[:, 0], run.position[:, 1], color=GREY, linewidth=0.7)
    above.set(title="body and path from above; dot: nose", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    above.set_adjustable("datalim")
    speed.plot(run.time, np.linalg.norm(run.twist[:, 3:], axis=1), color=BLUE, linewidth=1.1)
    speed.set(title="speed of the head [m/s]", xlabel="time [s]", ylim=(0.0, None))
    if run.torque is not None:
        torque, axes = run.torque[:, :, 2], panels_of_row[2]
        limit = float(np.abs(torque[len(torque) // 3 :]).max()) or 1.0  # without the start
        drawn = axes.pcolormesh(run.time, run.x, torque.T, cmap="RdBu_r", vmin=-limit, vmax=limit, shading="auto")
        axes.set(title="yaw torque C3 [N m]", xlabel="time [s]", ylabel="X from the nose [m]")
        axes.invert_yaxis()
        made.colorbar(drawn, ax=axes)
    return made


def picture_of_batch(batch: Any) -> Any:
    """A matplotlib figure: the paths of all heads from above, or evenly chosen ones of a large batch; and their
    speeds."""
    made, ((above, speed),) = figure(6.8, 2.5, (1, 2))
    chosen = np.unique(np.linspace(0, len(batch) - 1, min(len(batch), MOST_PATHS)).astype(int))
    for k in chosen:
        kept = slice(0, int(batch.samples[k]))
        look = {"color": BLUE, "linewidth": 0.8, "alpha": max(0.15, 1.0 / len(chosen) ** 0.5)}
        above.plot(
            batch.position[k, kept, 0], batch.position[k, kept, 1], **look, marker="o", markersize=3, markevery=[-1]
        )
        speed.plot(batch.time[kept], np.linalg.norm(batch.twist[k, kept, 3:], axis=1), **look)
    above.set(
        title=f"paths of {len(chosen)} heads (dot: end), from above", xlabel="x [m]", ylabel="y [m]", aspect="equal"
    )
    above.set_adjustable("datalim")
    speed.set(title="speeds of the heads [m/s]", xlabel="time [s]", ylim=(0.0, None))
    return made


def lines_of_batch(batch: Any) -> str:
    """A table of the first swimmers: law, body, end of the path, greatest sampled torque, reason for a stop."""
    lines = [repr(batch), f"{'':>4}  {'law':<16} {'body':<12} {'x, y, z at the end [m]':>26}  {'C at most [N m]':>15}"]
    for k in range(min(len(batch), MOST_ROWS)):
        last = max(int(batch.samples[k]) - 1, 0)
        end = " ".join(f"{value:+8.3f}" for value in batch.position[k, last])
        torque = "" if batch.torque is None else f"{np.linalg.norm(batch.torque[k], axis=-1).max():.4g}"
        names = f"{batch.laws[k].name[:16]:<16} {batch.bodies[k].name[:12]:<12}"
        lines.append(f"{k:>4}  {names} {end:>26}  {torque:>15}  {batch.error[k] or ''}")
    if len(batch) > MOST_ROWS:
        lines.append(f"... and {len(batch) - MOST_ROWS} more")
    return "\n".join(line.rstrip() for line in lines)
