# SPDX-License-Identifier: Apache-2.0
"""The page docs/reference/manoeuvres.md, its .csv, and pictures in docs/images/manoeuvres.

Every gait swims with its own numbers on the robot of the paper. Figures and pictures are those of that swim. The page's
text outside the marker lines is written by hand.
"""

import io
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from eel_common.attitude import heading
from eel_common.files import markdown
from eel_studies.outputs import Table
from eel_studies.pictures import BLUE, ORANGE, SETTINGS, along_way
from PIL import Image
from scipy.integrate import cumulative_trapezoid

from eel_dynamics import simulate
from eel_gaits import GAITS, straight

ROOT = Path(__file__).resolve().parents[1]
PAGE, PICTURES = ROOT / "docs/reference/manoeuvres.md", ROOT / "docs/images/manoeuvres"
DURATION, SAMPLE = 20.0, 0.05  # s
COLOURS = 64
HEAD = ("gait", "displacement [m]", "heading", "roll", "speed [m/s]", "Strouhal", "cost of transport [J/m/kg]")


class Swim:
    """A gait's swim of 20 s. heading, roll [degree]: between the means of the first and of the last second."""

    def __init__(self, name):
        self.name = name
        self.run = simulate(GAITS[name](), DURATION, accuracy="standard", sample_period=SAMPLE, estimate=False)
        self.path = self.run.center_of_mass
        self.speed = np.linalg.norm(np.gradient(self.path, self.run.time, axis=0), axis=1)
        self.heading = np.unwrap([heading(orientation) for orientation in self.run.orientation])
        rate = self.run.twist[:, 0]
        self.roll = cumulative_trapezoid(rate, dx=SAMPLE, initial=0.0)
        self.period = 1.0
        try:
            found = self.run.analysis()
            self.period = found.window.period
            further = (found.strouhal, found.cost_of_transport) if found.mean_speed > 0.05 else (None, None)
            self.figures = found.mean_speed, *further
        except ValueError:  # no period
            self.figures = float(np.mean(self.speed[len(self.speed) // 2 :])), None, None

    def change(self, angle, end=DURATION):
        """Change [degree] of an angle from the start to the mean over the last second before `end` [s]."""
        last = round(end / SAMPLE) + 1
        return math.degrees(float(np.mean(angle[last - round(1.0 / SAMPLE) : last]) - angle[0]))

    def at(self, time):
        """Number of the sample at `time` [s]."""
        return round(time / SAMPLE)

    def row(self):
        """The cells of its row in the table."""
        moved = ", ".join(f"{value:+.2f}" for value in self.path[-1] - self.path[0])
        figures = ("-" if value is None else f"{round(value, 9):.3g}" for value in self.figures)
        turned = (f"{self.change(angle) + 0.0:+.0f}°" for angle in (self.heading, self.roll))
        return [self.name, moved, *turned, *figures]

    def picture(self):
        """Shape, path, torque surface and speed, as the bytes of a PNG."""
        with plt.rc_context(dict(SETTINGS)):  # type: ignore[arg-type]
            figure, panels = plt.subplots(1, 4, figsize=(11.0, 2.6), layout="constrained")
            self._shape(panels[0])
            self._path(panels[1])
            self._torque(figure, panels[2])
            panels[3].plot(self.run.time, self.speed, color=BLUE, linewidth=1.2)
            panels[3].set(title="speed", xlabel="t [s]", ylabel="m/s", xlim=(0.0, DURATION))
            panels[3].set_ylim(0.0, max(0.01, 1.05 * np.max(self.speed)))
            raw = io.BytesIO()
            figure.savefig(raw, format="png", dpi=90)
            plt.close(figure)
        raw.seek(0)
        small = io.BytesIO()
        Image.open(raw).convert("RGB").quantize(COLOURS).save(small, "PNG", optimize=True)
        return small.getvalue()

    def _shape(self, axes):
        """Midlines of one period in the strongest part of the swim, relative to the centre of mass, the nose marked."""
        steps = round(self.period / SAMPLE)
        last = self.at(SHAPES.get(self.name, DURATION))
        moved = self.path[last] - self.path[last - steps]
        in_plane = np.ptp(self.path[:, 2]) < 1e-6 and np.linalg.norm(moved) > 0.05 and self.name not in SHAPES
        ahead = moved[:2] if in_plane and self.name != "backward" else np.array((1.0, 0.0))
        for k, index in enumerate(np.linspace(last - steps, last, 9).astype(int)[:-1]):
            line = along_way((self.run.backbone[index] - self.path[index])[:, :2], ahead)
            axes.plot(*line.T, color=plt.cm.cividis(k / 8.0), linewidth=1.0)
            axes.plot(*line[0], "o", color=plt.cm.cividis(k / 8.0), markersize=2.5)
        axes.set_aspect("equal", "datalim")
        axes.set(title="from above, dark to light; dot: nose", xlabel="m", ylabel="m")

    def _path(self, axes):
        axes.plot(self.path[:, 0], self.path[:, 1], color=BLUE, linewidth=1.2, label="from above: y")
        if np.ptp(self.path[:, 2]) > 1e-6:
            axes.plot(self.path[:, 0], self.path[:, 2], color=ORANGE, linewidth=1.2, label="from the side: z")
        axes.plot(*self.path[0, :2], "o", color="black", markersize=3, label="start")
        axes.set_aspect("equal", "datalim")
        axes.legend()
        axes.set(title="path", xlabel="x [m]", ylabel="m")

    def _torque(self, figure, axes):
        steps = round(2.0 * self.period / SAMPLE) + 1
        whole = np.asarray(self.run.torque)
        component = 2 if np.max(np.abs(whole[..., 2])) >= np.max(np.abs(whole[..., 1])) else 1
        shown = slice(-steps, None) if self.name not in ONCE else slice(0, round(ONCE[self.name] / SAMPLE) + 1)
        torque = whole[shown, :, component]
        bound = np.max(np.abs(torque)) or 1.0
        axes.grid(False)
        how = {"cmap": "PuOr", "vmin": -bound, "vmax": bound, "shading": "gouraud"}
        figure.colorbar(axes.pcolormesh(self.run.time[shown], self.run.x, torque.T, **how), ax=axes)
        axes.set(title=f"torque C{component + 1} [N m]", xlabel="t [s]", ylabel="X from the nose [m]")


ONCE = {"c_start": 2.0, "roll_over": 8.0, "falling": 9.0, "rising": 9.0, "diving": 6.0}  # s: what happens at the start
SHAPES = {"c_start": 1.0, "roll_over": 4.0, "burst_and_coast": 2.0, "falling": 3.0, "rising": 3.0, "diving": 4.0}  # s


def _turning(swim, swims):
    rate = (swim.heading[-1] - swim.heading[swim.at(10.0)]) / 10.0
    radius = swim.figures[0] / abs(rate)
    return f"It turns by {math.degrees(rate):+.0f} degrees per second, on a circle of {radius:.2f} m radius."


def _c_start(swim, swims):
    fastest, plain = int(np.argmax(swim.speed)), swims["straight"].speed
    return (
        f"After 3 s the heading is {swim.change(swim.heading, 3.0):+.0f} degrees, and the torque has reached "
        f"{swim.run.greatest_torque()[0]:.1f} N m. The greatest speed is {swim.speed[fastest]:.2f} m/s, after "
        f"{swim.run.time[fastest]:.2f} s; `straight` has {plain[fastest]:.2f} m/s then."
    )


def _burst_and_coast(swim, swims):
    start = swim.at(8.0)  # two cycles of 6 s
    work = swim.run.energy.actuator_work
    way = np.linalg.norm(swim.path[-1] - swim.path[start])
    cost = (work[-1] - work[start]) / way / swim.run.body_mass
    slower = 12.0 * swims["straight"].figures[0] / way  # period of the plain gait at that speed
    plain = simulate(straight(period=slower), 20.0 * slower, accuracy="standard", estimate=False).analysis()
    return (
        f"Over the last two cycles of 6 s the mean speed is {way / 12.0:.2f} m/s, at {cost:.3f} J/m/kg. `straight` "
        f"with a period of {slower:.2f} s has {plain.mean_speed:.2f} m/s at {plain.cost_of_transport:.3f} J/m/kg: in "
        f"this model bursts cost {'more' if cost > plain.cost_of_transport else 'less'}."
    )


def _diving(swim, swims):
    way = swim.path[-1] - swim.path[swim.at(10.0)]
    slope = math.degrees(math.atan2(way[2], math.hypot(way[0], way[1])))
    return f"From 10 s on the path slopes by {slope:+.0f} degrees; nothing keeps the body from rolling."


def _spiral(swim, swims):
    steps = np.diff(swim.path[swim.at(10.0) :: swim.at(1.0)], axis=0)  # of one period
    changes = np.diff(steps, axis=0)
    axis = np.mean(np.cross(changes[:-1], changes[1:]), axis=0)
    axis /= np.linalg.norm(axis)
    across = steps - np.outer(steps @ axis, axis)
    across_size = np.mean(np.linalg.norm(across, axis=1))
    turn = math.acos(np.mean(np.sum(across[1:] * across[:-1], axis=1)) / across_size**2)
    radius, advance = across_size / (2.0 * math.sin(0.5 * turn)), np.mean(steps @ axis) * 2.0 * math.pi / turn
    return (
        f"It is a helix of {radius:.2f} m radius about an axis {math.degrees(math.acos(abs(axis[2]))):.0f} degrees "
        f"from the vertical. It turns by {math.degrees(turn):.0f} degrees in a period, and sinks along the axis by "
        f"{advance:.2f} m in a turn."
    )


def _roll_over(swim, swims):
    end = swim.at(7.1)
    x, y, z, w = swim.run.orientation.T
    roll = np.degrees(np.arctan2(2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y))) % 360.0  # of the straight body
    moved = np.linalg.norm(swim.path[end] - swim.path[0])
    return (
        f"At its end, after 7.1 s, the straight body lies {roll[end]:+.0f} degrees about its own axis, and its centre "
        f"of mass has moved by {moved:.2f} m. Without a restoring moment it then drifts, to "
        f"{roll[-1]:+.0f} degrees at 20 s."
    )


NOTES = {  # what was measured, beside the table
    "turning": _turning,
    "c_start": _c_start,
    "burst_and_coast": _burst_and_coast,
    "diving": _diving,
    "spiral": _spiral,
    "roll_over": _roll_over,
}


def main() -> int:
    PICTURES.mkdir(parents=True, exist_ok=True)
    swims = {name: Swim(name) for name in GAITS}
    for name, swim in swims.items():
        (PICTURES / f"{name}.png").write_bytes(swim.picture())
    rows = {name: swim.row() for name, swim in swims.items()}
    told = [(*row, NOTES[name](swims[name], swims) if name in NOTES else "") for name, row in rows.items()]
    Table((*HEAD, "note"), told).write_csv(PAGE.with_suffix(".csv"))
    short = [(f"[{name}](../images/manoeuvres/{name}.png)", *row[-3:]) for name, row in rows.items()]
    text = markdown.table((HEAD[0], *HEAD[-3:]), short)
    markdown.write_page(PAGE, markdown.with_part(PAGE.read_text(), "table", text))
    print(f"{PAGE.relative_to(ROOT)}: {len(swims)} gaits")
    return 0


if __name__ == "__main__":
    sys.exit(main())
