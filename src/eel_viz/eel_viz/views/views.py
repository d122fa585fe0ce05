# SPDX-License-Identifier: Apache-2.0
"""Single views, as functions without data."""

from dataclasses import dataclass

import rerun as rr
import rerun.blueprint as rrb
from rerun.blueprint.archetypes import EntityBehavior

from eel_viz import entities
from eel_viz.plots import heat_map, profile_plot
from eel_viz.scene3d import camera, colours

NARROW, WIDE = 0.45, 0.2  # of a run's duration: time before its start, for the legend of a narrow or a wide view
USUAL = 10.0  # s: duration of a run that has not ended
LOADS = entities.LOAD, entities.LOAD_ENDS
FRAMES = entities.HEAD, entities.TAIL
WAKE = entities.WAKE, entities.WAKE_LEGEND


@dataclass(frozen=True, kw_only=True)
class Look:
    """What is shown of `frames`, the axes of head and tail, and of the `wake`; and the `duration` of the run [s]."""

    frames: bool = False
    wake: bool = True
    duration: float = USUAL

    @property
    def hidden(self) -> tuple[str, ...]:
        """The entities that are not shown."""
        return (*(() if self.frames else FRAMES), *(() if self.wake else WAKE))


PLAIN = Look()


def following_view(name: str = "Swimmer", *, both: bool = False, look: Look = PLAIN) -> rrb.Spatial3DView:
    """Three dimensions; the camera moves with the swimmer without turning; with `both`, with two swimmers."""
    other_water = entities.WATER if both else entities.BOTH_WATER
    left_out = [
        entities.TRACK,
        entities.STROBES,
        entities.PATH_WATER,
        other_water,
        *([entities.LEGEND] if both else [entities.OTHER]),
    ]
    hidden = _hidden(*look.hidden, *((*LOADS, *WAKE) if both else ()))
    return _three_dimensions(name, entities.BOTH if both else entities.FOLLOW, left_out, hidden)


def path_view(*, look: Look = PLAIN) -> rrb.Spatial3DView:
    """Three dimensions; the camera keeps all places so far in the picture."""
    left_out = [entities.WATER, entities.BOTH_WATER, entities.LEGEND, entities.OTHER]
    hidden = _hidden(*LOADS, *WAKE, *look.hidden)
    overrides = {path: [_past()] for path in (entities.TRACK, entities.STROBES)}
    return _three_dimensions("Path so far", entities.WHOLE_PATH, left_out, overrides | hidden)


def _past() -> rrb.VisibleTimeRanges:
    """All that lies before the cursor."""
    start, end = rrb.TimeRangeBoundary.infinite(), rrb.TimeRangeBoundary.cursor_relative()
    return rrb.VisibleTimeRanges([rrb.VisibleTimeRange(entities.TIMELINE, start=start, end=end)])


def _three_dimensions(name: str, origin: str, left_out: list[str], overrides: dict) -> rrb.Spatial3DView:
    return rrb.Spatial3DView(
        name=name,
        origin=origin,
        contents=[f"{entities.WORLD}/**", *(f"- {path}/**" for path in left_out)],
        background=colours.WATER_BACKGROUND,
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(position=camera.EYE, look_target=(0, 0, 0), eye_up=(0, 0, 1)),
        overrides=overrides,
    )


def profile_view(root: str, name: str) -> rrb.Spatial2DView:
    """One drawing against X."""
    return rrb.Spatial2DView(
        name=name,
        origin=root,
        background=(13, 16, 17),
        visual_bounds=rrb.VisualBounds2D(x_range=profile_plot.BOUNDS_X, y_range=profile_plot.BOUNDS_Y),
    )


def heat_map_view() -> rrb.Spatial2DView:
    """C3 over X and time."""
    return rrb.Spatial2DView(
        name="Torque C3(X, t) [N m]",
        origin=entities.HEAT_MAP,
        background=(13, 16, 17),
        visual_bounds=rrb.VisualBounds2D(x_range=heat_map.BOUNDS_X, y_range=heat_map.BOUNDS_Y),
    )


def speed_view(look: Look) -> rrb.TimeSeriesView:
    """Speed and depth of the head."""
    return series_view("Speed and depth of the head", entities.SPEED, entities.DEPTH, legend=NARROW * look.duration)


def power_view(look: Look) -> rrb.TimeSeriesView:
    """The powers of the ledger."""
    return series_view("Power into body and fluid [W]", entities.POWER, legend=NARROW * look.duration)


def residual_view() -> rrb.TimeSeriesView:
    """The ledger's residual."""
    return series_view("Energy residual [J]", entities.RESIDUAL, legend=0.0)


def run_tabs() -> rrb.Tabs:
    """The run's summary, and the log."""
    return rrb.Tabs(
        rrb.TextDocumentView(name="Run", origin=entities.RUN),
        rrb.TextLogView(name="Log", origin=entities.LOG),
    )


def series_view(name: str, *paths: str, legend: float) -> rrb.TimeSeriesView:
    """Values over time. `legend` [s]: the time before the start, which the legend fills; 0: no legend."""
    start = rrb.TimeRangeBoundary.absolute(seconds=-legend)
    return rrb.TimeSeriesView(
        name=name,
        origin=entities.PLOTS,
        contents=list(paths),
        plot_legend=rrb.PlotLegend(corner="LeftTop", visible=legend > 0.0),
        axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=start, end=rrb.TimeRangeBoundary.infinite())),
    )


def _hidden(*paths: str) -> dict[str, list]:
    return {path: [EntityBehavior(visible=False)] for path in paths}
