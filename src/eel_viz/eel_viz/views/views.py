# SPDX-License-Identifier: Apache-2.0
"""Single views, as functions without data. A new curve or view begins in entities.py."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import rerun as rr
import rerun.blueprint as rrb
from rerun.blueprint.archetypes import EntityBehavior
from rerun.encodings import EntityPath

from eel_viz import entities
from eel_viz.plots import heat_map, profile_plot
from eel_viz.scene3d import camera, colours

MARGIN = 0.05  # of a run's duration: margin after its end, for the last label of the axis
LOADS = entities.LOAD, entities.LOAD_ENDS
FRAMES = entities.HEAD, entities.TAIL
WAKE = entities.WAKE, entities.WAKE_LEGEND


@dataclass(frozen=True, kw_only=True)
class Look:
    """Options of a view: `frames`, the axes of head and tail; the `wake`; and the `end` of the run [s], 0: unknown.

    fins, joints: whether the body has any; sensors: whether any are published.
    """

    frames: bool = False
    wake: bool = True
    end: float = 0.0
    fins: bool = False
    joints: bool = False
    sensors: bool = False

    @property
    def hidden(self) -> tuple[str, ...]:
        """The hidden entities."""
        return (entities.BACKBONE, *(() if self.frames else FRAMES), *(() if self.wake else WAKE))


PLAIN = Look()


def following_view(look: Look, *, both: bool = False) -> rrb.Spatial3DView:
    """A 3D view. The camera moves with the swimmer, or with `both` swimmers, without turning."""
    not_here = (entities.WATER, entities.LEGEND) if both else (entities.BOTH_WATER, entities.OTHER)
    return _three_dimensions(
        "Both swimmers, the other as hoops" if both else "Swimmer",
        entities.BOTH if both else entities.FOLLOW,
        left_out=(entities.TRACK, entities.STROBES, entities.PATH_WATER, *not_here),
        hidden=(*look.hidden, *((*LOADS, *WAKE) if both else ())),
    )


def path_view(look: Look) -> rrb.Spatial3DView:
    """A 3D view. The camera keeps the whole path so far in the picture."""
    return _three_dimensions(
        "Path so far",
        entities.WHOLE_PATH,
        left_out=(entities.WATER, entities.BOTH_WATER, entities.LEGEND, entities.OTHER, entities.NOTES),
        hidden=(*LOADS, *WAKE, *look.hidden),
        with_past=(entities.TRACK, entities.STROBES),
    )


def _three_dimensions(
    name: str, origin: str, *, left_out: Sequence[str], hidden: Sequence[str], with_past: Sequence[str] = ()
) -> rrb.Spatial3DView:
    """A view from the frame `origin`. with_past: entities shown with everything before the time cursor."""
    start, end = rrb.TimeRangeBoundary.infinite(), rrb.TimeRangeBoundary.cursor_relative()
    past = rrb.VisibleTimeRanges([rrb.VisibleTimeRange(entities.TIMELINE, start=start, end=end)])
    overrides: dict[str | EntityPath, Any] = {path: [past] for path in with_past}
    overrides |= {path: [EntityBehavior(visible=False)] for path in hidden}
    return rrb.Spatial3DView(
        name=name,
        origin=origin,
        contents=[f"{entities.WORLD}/**", *(f"- {path}/**" for path in left_out)],
        background=colours.WATER_BACKGROUND,
        line_grid=rrb.LineGrid3D(visible=False),
        # otherwise the viewer changes it as soon as an entity is logged in a named frame
        spatial_information=rrb.SpatialInformation(target_frame=f"tf#{origin}"),
        eye_controls=rrb.EyeControls3D(position=camera.EYE, look_target=(0, 0, 0), eye_up=(0, 0, 1)),
        overrides=overrides,
    )


def profile_view(root: str, name: str) -> rrb.Spatial2DView:
    """One drawing against X."""
    return _drawing(root, name, profile_plot.BOUNDS_X, profile_plot.BOUNDS_Y)


def map_view(root: str, name: str) -> rrb.Spatial2DView:
    """One map over X, or over the motors, and time."""
    return _drawing(root, name, heat_map.BOUNDS_X, heat_map.BOUNDS_Y)


def _drawing(root: str, name: str, x: tuple[float, float], y: tuple[float, float]) -> rrb.Spatial2DView:
    bounds = rrb.VisualBounds2D(x_range=x, y_range=y)
    return rrb.Spatial2DView(name=name, origin=root, background=colours.PLOT_BACKGROUND, visual_bounds=bounds)


def texts(look: Look) -> rrb.Container:
    """What to look at; and as tabs the run's summary, the log, and the energy residual."""
    return rrb.Horizontal(
        rrb.TextDocumentView(name="What to look at", origin=entities.LOOK),
        rrb.Tabs(
            rrb.TextDocumentView(name="Run", origin=entities.RUN),
            rrb.TextLogView(name="Log", origin=entities.LOG),
            series_view(look, "Energy residual [J]", entities.RESIDUAL),
        ),
    )


def series_view(look: Look, name: str, *paths: str, last: float = 0.0, several: bool = False) -> rrb.TimeSeriesView:
    """Values over time, of the whole run or of the `last` seconds before the cursor, in the colours of the theme.

    several: curves, which the viewer's legend names.
    """
    start = end = rrb.TimeRangeBoundary.infinite()
    if last:
        start, end = (rrb.TimeRangeBoundary.cursor_relative(seconds=seconds) for seconds in (-last, 0.0))
    elif look.end:
        end = rrb.TimeRangeBoundary.absolute(seconds=(1.0 + MARGIN) * look.end)
    return rrb.TimeSeriesView(
        name=name,
        origin=entities.PLOTS,
        contents=list(paths),
        plot_legend=rrb.PlotLegend(visible=several, corner="LeftTop"),
        axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=start, end=end)),
        time_ranges=rrb.VisibleTimeRange(entities.TIMELINE, start=start, end=end) if last else None,
    )
