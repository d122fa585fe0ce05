# SPDX-License-Identifier: Apache-2.0
"""The pace of a run on the steady clock."""

import math

import pytest
from eel_dynamics.ros.loop.pacing import Pace


def test_pace_gives_due_times():
    pace = Pace(0.01, 2.0)
    pace.restart(5, 100.0)
    assert pace.due(5) == 100.0 and pace.due(9) == pytest.approx(100.02)
    pace.restart(9, 200.0, 0.5)
    assert pace.due(10) == pytest.approx(200.02)


def test_pace_keeps_small_delays_and_gives_up_great_ones():
    pace = Pace(0.01, 1.0)
    pace.restart(0, 0.0)
    assert pace.give_up_delay(1, 0.03) == 0.0 and pace.due(2) == pytest.approx(0.02)  # will be caught up with
    assert pace.give_up_delay(2, 1.02) == pytest.approx(1.0)
    assert pace.lost == pytest.approx(1.0) and pace.due(3) == pytest.approx(1.03)


def test_no_pace_is_never_late():
    pace = Pace(0.01, 0.0)
    pace.restart(0, 50.0)
    assert pace.due(1000) == -math.inf and pace.give_up_delay(1000, 1e9) == 0.0
