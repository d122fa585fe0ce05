"""The blueprints of a recording, as functions without data. Each fits a window of 1280 by 720 pixels.

`overview` shows everything at once, `torques` the profiles large, `motion` the path and the velocities, `compare`
another run laid over this one. A recording carries all of them as tabs.
"""

import rerun.blueprint as rrb
from eel_gaits.wording import shown
from rerun.blueprint.archetypes import EntityBehavior

from eel_viz import entities
from eel_viz.plots import heat_map, profile_plot
from eel_viz.scene3d import camera, colours
from eel_viz.settings import BLUEPRINTS

_PAST = rrb.VisibleTimeRanges(
    [
        rrb.VisibleTimeRange(
            entities.TIMELINE,
            start=rrb.TimeRangeBoundary.infinite(),
            end=rrb.TimeRangeBoundary.cursor_relative(),
        )
    ]
)


def arrangement(
    first: str = "overview", *, live: bool = False, compare: bool = False, frames: bool = False
) -> rrb.Blueprint:
    """All arrangements as tabs, `first` in front. `ValueError` for an unknown one.

    live: the time cursor follows the newest data, otherwise it stands at the start. compare: add the comparison with
    another run. frames: show the axes of head and tail.
    """
    if first not in BLUEPRINTS:
        raise ValueError(f"blueprint must be one of {', '.join(BLUEPRINTS)}, got {shown(first)}")
    tabs = {
        name: make(frames=frames) for name, make in (("overview", overview), ("torques", torques), ("motion", motion))
    }
    if compare or first == "compare":
        tabs["compare"] = comparison(frames=frames)
    return rrb.Blueprint(
        rrb.Tabs(*tabs.values(), active_tab=list(tabs).index(first)),
        rrb.TopPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=entities.TIMELINE, play_state="following" if live else "paused"),
        auto_layout=False,
        auto_views=False,
    )


def overview(*, frames: bool = False) -> rrb.Container:
    """The swimmer, its profiles, its power, and the run's state and residual."""
    return rrb.Horizontal(
        rrb.Vertical(
            rrb.Tabs(following_view(frames=frames), standing_view(frames=frames)),
            rrb.Horizontal(speed_view(), power_view()),
            row_shares=[2.3, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            heat_map_view(),
            rrb.Horizontal(run_tabs(), residual_view(), column_shares=[1.1, 1.0]),
            row_shares=[1.15, 1.15, 1.15, 1.15],
        ),
        column_shares=[1.15, 1.0],
        name="overview",
    )


def torques(*, frames: bool = False) -> rrb.Container:
    """The profiles of torque, force and curvature."""
    return rrb.Horizontal(
        rrb.Vertical(following_view(frames=frames), heat_map_view(), row_shares=[1.5, 1.0]),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            profile_view(entities.CURVATURE, "Curvature K(X)"),
        ),
        name="torques",
    )


def motion(*, frames: bool = False) -> rrb.Container:
    """Path, attitude and velocities of the head."""
    return rrb.Horizontal(
        rrb.Vertical(
            standing_view(frames=frames),
            rrb.Horizontal(speed_view(), _series("Kinetic energy [J]", entities.KINETIC)),
            row_shares=[2.1, 1.0],
        ),
        rrb.Vertical(
            _series("Attitude of the head [deg]", entities.ATTITUDE),
            _series("Velocity of the head in base_link [m/s]", entities.LINEAR),
            _series("Angular velocity of the head in base_link [rad/s]", entities.ANGULAR),
        ),
        column_shares=[1.3, 1.0],
        name="motion",
    )


def comparison(*, frames: bool = False) -> rrb.Container:
    """Two runs and their difference."""
    return rrb.Horizontal(
        rrb.Vertical(
            following_view("Both swimmers, the other as hoops", both=True, arrows=False, frames=frames),
            rrb.Horizontal(
                _series("Heads apart [mm]", entities.DISTANCE, legend=False),
                _series("Speed of both heads [m/s]", entities.SPEED, entities.OTHER_SPEED),
            ),
            row_shares=[1.9, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.COMPARED_TORQUE, "Internal torque C3(X) of both"),
            profile_view(entities.TORQUE_DIFFERENCE, "Difference of the torques (this - other)"),
            rrb.Horizontal(
                rrb.TextDocumentView(name="Both runs", origin=entities.COMPARE_TEXT),
                _series("Torques apart [N m]", entities.TORQUE_DIFFERENCE_MOST, legend=False),
                column_shares=[1.7, 1.0],
            ),
            row_shares=[1.0, 1.0, 1.75],
        ),
        column_shares=[1.15, 1.0],
        name="compare",
    )


def following_view(
    name: str = "Swimmer, coloured by C3, and the fluid's force",
    *,
    both: bool = False,
    arrows: bool = True,
    frames: bool = False,
) -> rrb.Spatial3DView:
    """Three dimensions; the camera moves with the swimmer without turning."""
    return rrb.Spatial3DView(
        name=name,
        origin=entities.FOLLOW,
        contents=[f"{entities.WORLD}/**", f"- {entities.TRACK}", *([] if both else [f"- {entities.OTHER}/**"])],
        background=colours.WATER_BACKGROUND,
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(position=camera.EYE, look_target=camera.TARGET, eye_up=(0, 0, 1)),
        overrides=_hidden(
            *(() if frames else (entities.HEAD, entities.TAIL)),
            *(() if arrows else (entities.LOAD, entities.LOAD_ENDS)),
        ),
    )


def standing_view(*, frames: bool = False) -> rrb.Spatial3DView:
    """Three dimensions; the camera stands still above the start."""
    return rrb.Spatial3DView(
        name="Path, from a still camera",
        origin=entities.WORLD,
        contents=[f"{entities.WORLD}/**", f"- {entities.LEGEND}/**", f"- {entities.OTHER}/**"],
        background=colours.WATER_BACKGROUND,
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(position=(-0.3, -2.9, 0.9), look_target=(1.55, -0.3, -0.85), eye_up=(0, 0, 1)),
        overrides={
            entities.TRACK: [_PAST],
            **_hidden(entities.LOAD, entities.LOAD_ENDS, *(() if frames else (entities.HEAD, entities.TAIL))),
        },
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


def speed_view() -> rrb.TimeSeriesView:
    """Speed and depth of the head."""
    return _series("Speed and depth of the head", entities.SPEED, entities.DEPTH)


def power_view() -> rrb.TimeSeriesView:
    """The powers of the ledger."""
    return _series("Power into body and fluid [W]", entities.POWER)


def residual_view() -> rrb.TimeSeriesView:
    """The ledger's residual."""
    return _series("Energy residual [J]", entities.RESIDUAL, legend=False)


def run_tabs() -> rrb.Tabs:
    """The run's summary, and the log."""
    return rrb.Tabs(
        rrb.TextDocumentView(name="Run", origin=entities.RUN),
        rrb.TextLogView(name="Log", origin=entities.LOG),
    )


def _series(name: str, *paths: str, legend: bool = True) -> rrb.TimeSeriesView:
    corner = rrb.PlotLegend(corner="LeftTop", visible=legend)
    return rrb.TimeSeriesView(name=name, origin=entities.PLOTS, contents=list(paths), plot_legend=corner)


def _hidden(*paths: str) -> dict[str, list]:
    return {path: [EntityBehavior(visible=False)] for path in paths}
