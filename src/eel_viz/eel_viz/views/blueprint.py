# SPDX-License-Identifier: Apache-2.0
"""The arrangements of a recording, as functions without data. Each fits a window of 1280 by 720 pixels.

A recording carries all of them as tabs: those of `ARRANGEMENTS`, `robot` if the body has joints, `sensors` if
any are published, and `compare` if another run is drawn over this one. The content of a view is logged by the classes
of recording/loggers.py, under a path of entities.py.
"""

from collections.abc import Callable

import rerun as rr
import rerun.blueprint as rrb
from eel_common.quantity import checked_choice
from rerun.blueprint.components import AbsoluteTimeRange

from eel_viz import entities
from eel_viz.settings import BLUEPRINTS
from eel_viz.views.views import (
    PLAIN,
    Look,
    following_view,
    map_view,
    path_view,
    profile_view,
    series_view,
    texts,
)

REPEATED_FROM = 0.4  # of a run: playback repeats the rest, where the swim is settled
POWER_SHOWN = 4.0  # s: window of the shown power, so that its scale fits the swim and not its start
TORQUE_MAP = "Torque C3 over body and time"
LOAD_MAP = "Torque of each motor in time, as a share of its limit, red at it; in N m without limits"
HARDEST = "Hardest-working motor [N m]"


def overview(look: Look) -> rrb.Container:
    """The swimmer, its torque, its power, its speed, and what to look at."""
    return rrb.Horizontal(
        rrb.Vertical(rrb.Tabs(following_view(look), path_view(look)), texts(look), row_shares=[2.3, 1.0]),
        rrb.Vertical(
            map_view(entities.HEAT_MAP, TORQUE_MAP),
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            series_view(look, "Power [W]", entities.POWER, entities.POWER_BESIDES, last=POWER_SHOWN, several=True),
            rrb.Horizontal(
                series_view(look, "Speed of the head [m/s]", entities.SPEED),
                series_view(look, "Depth of the head [m]", entities.DEPTH),
            ),
            row_shares=[0.85, 0.85, 1.9, 0.9],
        ),
        column_shares=[1.15, 1.0],
        name="overview",
    )


def torques(look: Look) -> rrb.Container:
    """The profiles of torque, force and curvature."""
    return rrb.Horizontal(
        rrb.Vertical(following_view(look), map_view(entities.HEAT_MAP, TORQUE_MAP), row_shares=[1.5, 1.0]),
        rrb.Vertical(
            profile_view(entities.TORQUE, "Internal torque C(X)"),
            profile_view(entities.FORCE, "Internal force N(X)"),
            profile_view(entities.CURVATURE, "Curvature K(X)"),
        ),
        name="torques",
    )


def robot(look: Look) -> rrb.Container:
    """The motors: their loads, the one closest to its limit, power and work."""
    return rrb.Horizontal(
        rrb.Vertical(following_view(look), texts(look), row_shares=[2.3, 1.0]),
        rrb.Vertical(
            map_view(entities.LOAD_MAP, LOAD_MAP),
            series_view(look, HARDEST, entities.HARDEST_MOTOR, several=True),
            series_view(look, "Motors at their limits", entities.SATURATED),
            rrb.Horizontal(
                series_view(look, "Power of all motors [W]", entities.MOTOR_POWER, last=POWER_SHOWN),
                series_view(look, "Work of all motors [J]", entities.MOTOR_WORK),
            ),
            row_shares=[1.1, 1.1, 0.7, 1.1],
        ),
        column_shares=[1.15, 1.0],
        name="robot",
    )


def motion(look: Look) -> rrb.Container:
    """Path, attitude and velocities of the head."""
    return rrb.Horizontal(
        rrb.Vertical(
            path_view(look),
            rrb.Horizontal(
                series_view(look, "Speed of the head [m/s]", entities.SPEED),
                series_view(look, "Energy [J]", entities.KINETIC, entities.STORED, several=True),
            ),
            row_shares=[2.1, 1.0],
        ),
        rrb.Vertical(
            series_view(look, "Attitude of the head [deg]", entities.ATTITUDE, several=True),
            series_view(look, "Velocity of the head in base_link [m/s]", entities.LINEAR, several=True),
            series_view(look, "Angular velocity in base_link [rad/s]", entities.ANGULAR, several=True),
            *([series_view(look, "Angles of the fins [deg]", entities.FIN_ANGLES, several=True)] if look.fins else []),
        ),
        column_shares=[1.3, 1.0],
        name="motion",
    )


def sensors(look: Look) -> rrb.Container:
    """What sensors read, beside the depth of the head."""
    return rrb.Horizontal(
        rrb.Vertical(
            series_view(look, "Specific force at the IMU [m/s²]", entities.FORCE_READ, several=True),
            series_view(look, "Angular velocity at the IMU [rad/s]", entities.TURNING_READ, several=True),
            series_view(look, "Velocity by the log [m/s]", entities.VELOCITY_READ, several=True),
        ),
        rrb.Vertical(
            following_view(look),
            series_view(look, "Depth of the head [m]", entities.DEPTH, entities.DEPTH_READ, several=True),
            series_view(look, "Pressure [Pa]", entities.PRESSURE_READ),
        ),
        name="sensors",
    )


def swimmer(look: Look) -> rrb.Container:
    """Only the swimmer, for films."""
    return rrb.Horizontal(following_view(look), name="swimmer")


def compare(look: Look) -> rrb.Container:
    """Two runs and their difference."""
    speeds = entities.SPEED, entities.OTHER_SPEED
    return rrb.Horizontal(
        rrb.Vertical(
            following_view(look, both=True),
            rrb.Horizontal(
                series_view(look, "Heads apart [m]", entities.DISTANCE),
                series_view(look, "Speeds [m/s]", *speeds, several=True),
            ),
            row_shares=[1.9, 1.0],
        ),
        rrb.Vertical(
            profile_view(entities.COMPARED_TORQUE, "Internal torque C3(X) of both"),
            profile_view(entities.TORQUE_DIFFERENCE, "Difference of the torques (this - other)"),
            rrb.Horizontal(
                rrb.TextDocumentView(name="Both runs", origin=entities.COMPARE_TEXT),
                series_view(look, "Apart [N m]", entities.TORQUE_DIFFERENCE_MOST),
                column_shares=[1.7, 1.0],
            ),
            row_shares=[1.0, 1.0, 1.75],
        ),
        column_shares=[1.15, 1.0],
        name="compare",
    )


ARRANGEMENTS: dict[str, Callable[[Look], rrb.Container]] = dict(
    zip(BLUEPRINTS, (overview, torques, motion, robot, sensors, swimmer, compare), strict=True)
)


def arrangement(
    first: str = "overview", *, live: bool = False, comparison: bool = False, look: Look = PLAIN
) -> rrb.Blueprint:
    """All arrangements as tabs, `first` in front. `ValueError` for an unknown one.

    live: the time cursor follows the newest data; otherwise it plays and repeats the swim, or all of a run of unknown
    end. comparison: with another run.
    """
    checked_choice("blueprint", first, ARRANGEMENTS)
    asked_for = {"compare": comparison, "robot": look.joints, "sensors": look.sensors}
    names = [name for name in ARRANGEMENTS if name == first or asked_for.get(name, True)]
    swim = (rr.encodings.TimeInt(seconds=seconds) for seconds in (REPEATED_FROM * look.end, look.end))
    return rrb.Blueprint(
        rrb.Tabs(*(ARRANGEMENTS[name](look) for name in names), active_tab=names.index(first)),
        rrb.TopPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(
            state="collapsed",
            timeline=entities.TIMELINE,
            play_state="following" if live else "playing",
            loop_mode="off" if live else "selection" if look.end else "all",
            time_selection=AbsoluteTimeRange(*swim) if look.end else None,
        ),
        auto_layout=False,
        auto_views=False,
    )
