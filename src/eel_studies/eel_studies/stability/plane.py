# SPDX-License-Identifier: Apache-2.0
"""A planar law in three dimensions: does round-off grow out of the plane, and is the cause the model or the numerics?

The components out of the plane are the head's roll and pitch rates and its velocity along axis 3, (Omega1 l, Omega2 l,
V3). They do not depend on the orientation of the head: there is no weight, so no direction is special. A perturbation
of 1e-15 grows. A line is fitted to the logarithm of its size over whole periods while it is small. A growth rate that
depends neither on the accuracy nor on the perturbation is a property of the model.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from eel_base.files.markdown import table as table_of
from eel_model.body.body import Body
from eel_model.scene import Scene

from eel_gaits import straight
from eel_studies.stability.drift import recorded

LONG = 10_000  # periods
LOOKED_AT = 50  # instants of a long run that are evaluated
ACCURACIES = (1e-2, 1e-4, 1e-6)
PUSHES = (1e-15, 1e-12)  # rad/s, or m/s
TWIST_COLUMN = {"roll": 0, "pitch": 1, "vertical": 5}  # of the head's twist
LONGEST = 40  # periods over which a perturbation is followed
LINEAR = 1e-6  # m/s: below it, growth is linear in the perturbation
COLUMNS = (
    *("accuracy", "pushed in roll", "in pitch", "along axis 3"),
    "by round-off alone, head turned across all axes",
)
DOMINANT_AFTER = 6  # periods after which the fastest mode dominates
TURNED = np.array([0.15, 0.30, -0.08, np.sqrt(1.0 - 0.1189)])  # quaternion of a head turned about all axes


@dataclass(frozen=True)
class Growth:
    """Growth of a perturbation out of the plane: rate per period, direction (3,) (roll, pitch, vertical)."""

    rate: float
    mode: np.ndarray


def out_of_plane(
    periods: Any,
    *,
    push: float = 0.0,
    axis: str = "roll",
    accuracy: float = 1e-4,
    orientation: Any = None,
    body: Body | None = None,
    **scene: Any,
) -> np.ndarray:
    """(Omega1 l, Omega2 l, V3) of the head (T, 3) [m/s], in head axes, at `periods` (T,) of the gait `straight`.

    push: initial perturbation [rad/s or m/s] of the `axis` in `TWIST_COLUMN`. orientation: initial quaternion. scene:
    fields of `Scene`. `SimulationStopped` where the run cannot go on.
    """
    twist = np.zeros(6)
    twist[TWIST_COLUMN[axis]] = push
    swimmer, out, _ = recorded(
        np.asarray(periods, dtype=float),
        body=body,
        scene=Scene(internal_wrench=False, ledger=False, **scene),
        accuracy=accuracy,
        stations=[0.0],
        law=straight(period=1.0),
        orientation=(0.0, 0.0, 0.0, 1.0) if orientation is None else orientation,
        twist=twist,
    )
    length = swimmer.body.length
    return np.asarray(out.twist[:, list(TWIST_COLUMN.values())] * (length, length, 1.0))


def growth(**swimmer: Any) -> Growth:
    """Fit the growth of a perturbation. swimmer: keywords of `out_of_plane`."""
    found = out_of_plane(np.arange(LONGEST + 1), **{"push": PUSHES[0], **swimmer})
    size = np.linalg.norm(found, axis=1)
    above = np.flatnonzero(size > LINEAR)
    end = above[0] if len(above) else len(size)
    first = min(DOMINANT_AFTER, end - 2)
    rate = np.polyfit(np.arange(first, end), np.log(size[first:end]), 1)[0]
    return Growth(float(rate), found[end - 1] / size[end - 1])


def table(long: int = LONG) -> str:
    """The result in words and numbers, as Markdown. long: periods of the run without a perturbation."""
    found, rows = [], []
    for accuracy in ACCURACIES:
        pushed = [[growth(accuracy=accuracy, push=push, axis=axis) for push in PUSHES] for axis in TWIST_COLUMN]
        turned = [growth(accuracy=accuracy, push=0.0, orientation=TURNED)]
        rows.append((f"{accuracy:g}", *(", ".join(f"{each.rate:.3f}" for each in row) for row in (*pushed, turned))))
        found += [each for row in (*pushed, turned) for each in row]
    rates = [each.rate for each in found]
    mean, spread = np.mean(rates), max(rates) - min(rates)
    swimmers = [("the paper's robot", f"{mean:.3f}", _mode(found[-1]))]
    for name, changes in variants().items():
        each = growth(**changes)
        swimmers.append((name, f"{each.rate:.3f}", _mode(each)))
    rest = max(
        np.abs(out_of_plane(np.linspace(0.0, long, LOOKED_AT + 1), accuracy=accuracy)).max()
        for accuracy in ACCURACIES[:2]
    )
    return "\n".join(
        [
            f"Without a push the swimmer is out of its plane by {rest:g} m/s in {long:,} periods: zeros stay zeros.",
            f"A push of {PUSHES[0]:g} or {PUSHES[1]:g} grows by exp({mean:.2f}) = {np.exp(mean):.1f} a period, to "
            f"within {spread:.2g} in the exponent whatever its",
            "axis, its size and the accuracy; so does round-off, once the plane is not one of the axes':",
            "",
            table_of(COLUMNS, rows),
            "",
            table_of(("swimmer", "growth", "mode: roll, pitch, vertical"), swimmers),
        ]
    )


def variants() -> dict[str, dict[str, Any]]:
    """Variants that the growth is compared over: keywords of `growth`, by name."""
    robot = Body.boyer2010()

    def shaped(half_width: Any, half_height: Any) -> Body:
        return Body(length=1.0, half_width=half_width, half_height=half_height, kinks=robot.kinks)

    return {
        "without drag": {"resistive": False},
        "without wake": {"wake": False},
        "without inertia of the water": {"reactive": False},
        "sections round": {"body": shaped(robot.half_height, robot.half_height)},
        "sections wider than high": {"body": shaped(robot.half_height, robot.half_width)},
    }


def _mode(found: Growth) -> str:
    mode = found.mode * np.sign(found.mode[np.argmax(np.abs(found.mode))])
    return ", ".join(f"{part:.2f}" for part in mode)
