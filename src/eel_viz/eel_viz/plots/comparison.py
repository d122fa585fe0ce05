"""Two runs laid over each other, and how they differ: another swimmer, accuracy or gait beside the one that is shown.

The other swimmer is drawn as hoops around the first, so that both are seen where they coincide. Differences are this
run's value less the other's, at this run's times and stations (see `pairs`).
"""

from collections.abc import Callable

import numpy as np
import rerun as rr

from eel_viz import entities
from eel_viz.messages import Backbone, Body, Pose, Profiles, Status, Twist
from eel_viz.outlet import Outlet
from eel_viz.plots.pairs import Pairs
from eel_viz.plots.profile_plot import ProfilePlot
from eel_viz.plots.state_text import Summary
from eel_viz.scene3d import colours
from eel_viz.scene3d.skin import Skin

HOOPS, SIDES = 24, 16
LEAST = 1e-6  # N m: first limit of the torque's difference, which then grows
SUMMARY_PERIOD = 500_000_000  # ns

Due = Callable[[str, int, int], bool]


class Comparison:
    """`this` and `other` take the messages of either run, by the methods of `Loggers`.

    `due(what, stamp, period)` says whether something is due at a stamp [ns], `drawings` is the period [ns] of what is
    drawn, `names` are those of the two runs.
    """

    def __init__(self, outlet: Outlet, *, names: tuple[str, str], limit: float, due: Due, drawings: int):
        self._outlet, self._due, self._drawings, self.names = outlet, due, drawings, names
        self._heads, self._torques = Pairs(), Pairs()
        self.this, self.other = This(self), Other(self, outlet, lambda stamp: due("other", stamp, drawings))
        self._both = ProfilePlot(
            outlet,
            entities.COMPARED_TORQUE,
            names=tuple(f"C3 {name}" for name in names[::-1]),  # the other below
            unit="N m",
            limit=limit,
            palette=(colours.AMBER, colours.AXIS[2]),
            widths=(2.6, 1.2),
        )
        self._difference = ProfilePlot(
            outlet,
            entities.TORQUE_DIFFERENCE,
            names=("C1", "C2", "C3"),
            unit="N m",
            limit=LEAST,
        )
        self._farthest = self._worst = self._greatest = 0.0
        for path, name, colour in (
            (entities.OTHER_SPEED, f"{names[1]} [m/s]", colours.AMBER),
            (entities.DISTANCE, "distance [mm]", colours.MAGENTA),
            (entities.TORQUE_DIFFERENCE_MOST, "greatest over X [N m]", colours.MAGENTA),
        ):
            outlet.fixed(path, rr.SeriesLines(names=[name], colors=[colour], widths=[1.5]))

    def heads(self, pairs: list[tuple]) -> None:
        """The distance between the two heads."""
        for stamp, _, this, other in pairs:
            self.this.summary.move(stamp, this)
            self.other.summary.move(stamp, other)
            if self._due("compared", stamp, SUMMARY_PERIOD):
                self._outlet.once(
                    stamp, entities.COMPARE_TEXT, rr.TextDocument(self.text(), media_type="text/markdown")
                )
            distance = float(np.linalg.norm(this - other))
            self._farthest = max(self._farthest, distance)
            self._outlet.scalars(stamp, entities.DISTANCE, [1e3 * distance])

    def torques(self, pairs: list[tuple]) -> None:
        """C3 of both, and the difference of all three."""
        for stamp, x, this, other in pairs:
            self.this.summary.strain(stamp, x, this[:, 2])
            self.other.summary.strain(stamp, x, other[:, 2])
            difference = this - other
            both = np.stack([other[:, 2], this[:, 2]], axis=1)
            self._both.include(x, both)
            self._difference.include(x, difference)
            most = float(np.abs(difference).max())
            self._worst = max(self._worst, most)
            self._greatest = max(self._greatest, float(np.abs(this).max()))
            self._outlet.scalars(stamp, entities.TORQUE_DIFFERENCE_MOST, [most])
            if self._due("compared torque", stamp, self._drawings):
                self._both.draw(stamp, x, both)
                self._difference.draw(stamp, x, difference)
                self._difference.draw_envelope(stamp)

    def text(self) -> str:
        """Markdown: both runs side by side, and how far they are apart."""
        columns = [side.summary.figures() for side in (self.this, self.other)]
        lines = [f"heads apart by at most **{1e3 * self._farthest:.3g} mm**  "]
        if self._greatest:
            share = 100.0 * self._worst / self._greatest
            lines.append(f"torques by at most **{self._worst:.2g} N m**, {share:.2g} % of the greatest")
        lines += ["", f"| | {self.names[0]} | {self.names[1]} |", "|---|---|---|"]
        for key in columns[1] | columns[0]:
            lines.append(f"| {key} | " + " | ".join(column.get(key, "") for column in columns) + " |")
        return "\n".join(lines)


class Side:
    """One of the two runs: what both have."""

    def __init__(self, comparison: Comparison) -> None:
        self._comparison = comparison
        self.summary = Summary()

    def law(self, stamp: int, name: str) -> None:
        """The law's name."""
        self.summary.law = name

    def diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """The statuses' values."""
        for status in statuses:
            self.summary.status(stamp, status.message, status.values)

    def head_pose(self, stamp: int, pose: Pose) -> None:
        """The head's place."""
        self._comparison.heads(self._pair(self._comparison._heads, stamp, pose.position))

    def internal_wrench(self, stamp: int, wrench: Profiles) -> None:
        """The torques."""
        torque = wrench.together("torque_1", "torque_2", "torque_3")
        self._comparison.torques(self._pair(self._comparison._torques, stamp, torque, wrench.x))

    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        raise NotImplementedError


class This(Side):
    """The run that the rest of the recording shows."""

    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        return pairs.this(*sample)


class Other(Side):
    """The other run: drawn here, since nothing else shows it."""

    def __init__(self, comparison: Comparison, outlet: Outlet, due: Callable[[int], bool]) -> None:
        super().__init__(comparison)
        self._outlet, self._due = outlet, due
        self._skin: Skin | None = None
        shade, thin = [colours.AMBER], [rr.Radius.ui_points(0.8)]
        for path in (entities.OTHER_HOOPS, entities.OTHER_BACKBONE):
            outlet.fixed(path, rr.LineStrips3D.from_fields(colors=shade, radii=thin))

    def _pair(self, pairs: Pairs, *sample) -> list[tuple]:
        return pairs.other(*sample)

    def body(self, body: Body) -> None:
        """The sections, which the hoops show."""
        self.summary.body = body
        self._skin = Skin(body.x, body.half_width, body.half_height, rings=HOOPS, sides=SIDES)

    def head_twist(self, stamp: int, twist: Twist) -> None:
        """The speed."""
        self._outlet.scalars(stamp, entities.OTHER_SPEED, [np.linalg.norm(twist.linear)])

    def backbone(self, stamp: int, backbone: Backbone) -> None:
        """Line and hoops."""
        if not self._due(stamp):
            return
        line = backbone.position[None].astype(np.float32)
        self._outlet.row(stamp, entities.OTHER_BACKBONE, rr.LineStrips3D, strips=line)
        if self._skin is not None:
            vertices, _ = self._skin.place(backbone.x, backbone.position, backbone.orientation)
            rings = vertices.reshape(HOOPS, SIDES, 3)[3:]  # those at the nose are too dense
            self._outlet.row(
                stamp, entities.OTHER_HOOPS, rr.LineStrips3D, strips=np.concatenate([rings, rings[:, :1]], axis=1)
            )

    def odom(self, stamp: int, pose: Pose, twist: Twist) -> None:
        """Nothing: the same as head_pose and head_twist."""

    def curvature(self, stamp: int, curvature: Profiles) -> None:
        """Nothing is compared."""

    def hydrodynamic_load(self, stamp: int, load) -> None:
        """Nothing is compared."""

    def energy(self, stamp: int, energy: dict[str, float]) -> None:
        """The residual, in the summary."""
