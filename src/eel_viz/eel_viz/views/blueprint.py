# SPDX-License-Identifier: Apache-2.0
"""The blueprints of a recording, as functions without data. Each fits a window of 1280 by 720 pixels.

`overview` shows everything at once, `torques` the profiles large, `motion` the path and the velocities, `swimmer` the
swimmer alone, `compare` another run laid over this one. A recording carries all of them as tabs.
"""

import rerun.blueprint as rrb
from eel_base.wording import shown

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
    power_view,
    profile_view,
    residual_view,
    run_tabs,
    series_view,
    speed_view,
)


def arrangement(
    first: str = "overview", *, live: bool = False, compare: bool = False, look: Look = PLAIN
) -> rrb.Blueprint:
    """All arrangements as tabs, `first` in front. `ValueError` for an unknown one.

    live: the time cursor follows the newest data, otherwise it stands at the start. compare: add the comparison with
    another run.
    """
    if first not in BLUEPRINTS:
        raise ValueError(f"blueprint must be one of {', '.join(BLUEPRINTS)}, got {shown(first)}")
    tabs = {
        name: make(look=look)
        for name, make in (("overview", overview), ("torques", torques), ("motion", motion), ("swimmer", swimmer))
    }
    if compare or first == "compare":
        tabs["compare"] = comparison(look=look)
    return rrb.Blueprint(
        rrb.Tabs(*tabs.values(), active_tab=list(tabs).index(first)),
        rrb.TopPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=entities.TIMELINE, play_state="following" if live else "paused"),
        auto_layout=False,
        auto_views=False,
    )


def overview(*, look: Look = PLAIN) -> rrb.Container:
    """The swimmer, its profiles, its power, and the run's state and residual."""
    return rrb.Horizontal(
        rrb.Vertical(
            rrb.Tabs(following_view(look=look), path_view(look=look)),
            rrb.Horizontal(speed_view(look), power_view(look)),
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


def torques(*, look: Look = PLAIN) -> rrb.Container:
    """The profiles of torque, force and curvature."""
    return rrb.Horizontal(
        rrb.Vertical(following_view(look=look), heat_map_view(), row_shares=[1.5, 1.0]),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            profile_view(entities.CURVATURE, "Curvature K(X)"),
        ),
        name="torques",
    )


def motion(*, look: Look = PLAIN) -> rrb.Container:
    """Path, attitude and velocities of the head."""
    return rrb.Horizontal(
        rrb.Vertical(
            path_view(look=look),
            rrb.Horizontal(
                speed_view(look), series_view("Kinetic energy [J]", entities.KINETIC, legend=NARROW * look.duration)
            ),
            row_shares=[2.1, 1.0],
        ),
        rrb.Vertical(
            series_view("Attitude of the head [deg]", entities.ATTITUDE, legend=WIDE * look.duration),
            series_view("Velocity of the head in base_link [m/s]", entities.LINEAR, legend=WIDE * look.duration),
            series_view(
                "Angular velocity of the head in base_link [rad/s]", entities.ANGULAR, legend=WIDE * look.duration
            ),
        ),
        column_shares=[1.3, 1.0],
        name="motion",
    )


def swimmer(*, look: Look = PLAIN) -> rrb.Container:
    """The swimmer alone, for films."""
    return rrb.Horizontal(following_view(look=look), name="swimmer")


def comparison(*, look: Look = PLAIN) -> rrb.Container:
    """Two runs and their difference."""
    return rrb.Horizontal(
        rrb.Vertical(
            following_view("Both swimmers, the other as hoops", both=True, look=look),
            rrb.Horizontal(
                series_view("Heads apart [m]", entities.DISTANCE, legend=0.0),
                series_view(
                    "Speed of both heads [m/s]", entities.SPEED, entities.OTHER_SPEED, legend=2 * NARROW * look.duration
                ),
            ),
            row_shares=[1.9, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.COMPARED_TORQUE, "Internal torque C3(X) of both"),
            profile_view(entities.TORQUE_DIFFERENCE, "Difference of the torques (this - other)"),
            rrb.Horizontal(
                rrb.TextDocumentView(name="Both runs", origin=entities.COMPARE_TEXT),
                series_view("Apart [N m]", entities.TORQUE_DIFFERENCE_MOST, legend=0.0),
                column_shares=[1.7, 1.0],
            ),
            row_shares=[1.0, 1.0, 1.75],
        ),
        column_shares=[1.15, 1.0],
        name="compare",
    )
