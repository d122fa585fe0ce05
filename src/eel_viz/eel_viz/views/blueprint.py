# SPDX-License-Identifier: Apache-2.0
"""The arrangements of a recording, as functions without data. Each fits a window of 1280 by 720 pixels.

A recording carries all of them as tabs: those of `ARRANGEMENTS`, and `compare` where another run is laid over this one.
"""

from collections.abc import Callable

import rerun.blueprint as rrb
from eel_base.wording import not_one_of

from eel_viz import entities
from eel_viz.settings import BLUEPRINTS
from eel_viz.views.views import (
    NARROW,
    PLAIN,
    WIDE,
    Look,
    following_view,
    heat_map_view,
    path_view,
    profile_view,
    run_tabs,
    series_view,
)


def overview(look: Look) -> rrb.Container:
    """The swimmer, its profiles, its power, and the run's state and residual."""
    return rrb.Horizontal(
        rrb.Vertical(
            rrb.Tabs(following_view(look), path_view(look)),
            rrb.Horizontal(
                series_view("Speed and depth of the head", entities.SPEED, entities.DEPTH, legend=look.room(NARROW)),
                series_view("Power into body and fluid [W]", entities.POWER, legend=look.room(NARROW)),
            ),
            row_shares=[2.3, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            heat_map_view(),
            rrb.Horizontal(run_tabs(), series_view("Energy residual [J]", entities.RESIDUAL), column_shares=[1.1, 1.0]),
            row_shares=[1.15, 1.15, 1.15, 1.15],
        ),
        column_shares=[1.15, 1.0],
        name="overview",
    )


def torques(look: Look) -> rrb.Container:
    """The profiles of torque, force and curvature."""
    return rrb.Horizontal(
        rrb.Vertical(following_view(look), heat_map_view(), row_shares=[1.5, 1.0]),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            profile_view(entities.CURVATURE, "Curvature K(X)"),
        ),
        name="torques",
    )


def motion(look: Look) -> rrb.Container:
    """Path, attitude and velocities of the head."""
    wide = look.room(WIDE)
    return rrb.Horizontal(
        rrb.Vertical(
            path_view(look),
            rrb.Horizontal(
                series_view("Speed and depth of the head", entities.SPEED, entities.DEPTH, legend=look.room(NARROW)),
                series_view("Kinetic energy [J]", entities.KINETIC, legend=look.room(NARROW)),
            ),
            row_shares=[2.1, 1.0],
        ),
        rrb.Vertical(
            series_view("Attitude of the head [deg]", entities.ATTITUDE, legend=wide),
            series_view("Velocity of the head in base_link [m/s]", entities.LINEAR, legend=wide),
            series_view("Angular velocity of the head in base_link [rad/s]", entities.ANGULAR, legend=wide),
        ),
        column_shares=[1.3, 1.0],
        name="motion",
    )


def swimmer(look: Look) -> rrb.Container:
    """The swimmer alone, for films."""
    return rrb.Horizontal(following_view(look), name="swimmer")


def compare(look: Look) -> rrb.Container:
    """Two runs and their difference."""
    speeds = entities.SPEED, entities.OTHER_SPEED
    return rrb.Horizontal(
        rrb.Vertical(
            following_view(look, both=True),
            rrb.Horizontal(
                series_view("Heads apart [m]", entities.DISTANCE),
                series_view("Speed of both heads [m/s]", *speeds, legend=look.room(2 * NARROW)),
            ),
            row_shares=[1.9, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.COMPARED_TORQUE, "Internal torque C3(X) of both"),
            profile_view(entities.TORQUE_DIFFERENCE, "Difference of the torques (this - other)"),
            rrb.Horizontal(
                rrb.TextDocumentView(name="Both runs", origin=entities.COMPARE_TEXT),
                series_view("Apart [N m]", entities.TORQUE_DIFFERENCE_MOST),
                column_shares=[1.7, 1.0],
            ),
            row_shares=[1.0, 1.0, 1.75],
        ),
        column_shares=[1.15, 1.0],
        name="compare",
    )


ARRANGEMENTS: dict[str, Callable[[Look], rrb.Container]] = dict(
    zip(BLUEPRINTS, (overview, torques, motion, swimmer, compare), strict=True)
)


def arrangement(
    first: str = "overview", *, live: bool = False, comparison: bool = False, look: Look = PLAIN
) -> rrb.Blueprint:
    """All arrangements as tabs, `first` in front. `ValueError` for an unknown one.

    live: the time cursor follows the newest data, otherwise it stands at the start. comparison: with another run.
    """
    if first not in ARRANGEMENTS:
        raise ValueError(not_one_of("blueprint", first, ARRANGEMENTS))
    names = [name for name in ARRANGEMENTS if name != "compare" or comparison or first == "compare"]
    return rrb.Blueprint(
        rrb.Tabs(*(ARRANGEMENTS[name](look) for name in names), active_tab=names.index(first)),
        rrb.TopPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=entities.TIMELINE, play_state="following" if live else "paused"),
        auto_layout=False,
        auto_views=False,
    )
