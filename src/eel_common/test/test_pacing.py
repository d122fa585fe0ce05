# SPDX-License-Identifier: Apache-2.0
"""The pace of a run on the steady clock."""

import math

import numpy as np
import pytest
from eel_common.ros.loop.pacing import Pace


def test_pace_gives_due_times():
    pace = Pace(0.01, 2.0)
    pace.restart(5, 100.0)
    assert pace.due(5) == 100.0 and pace.due(9) == pytest.approx(100.02)
    pace.restart(9, 200.0, 0.5)
    assert pace.due(10) == pytest.approx(200.02)


def test_pace_keeps_small_delays():
    pace = Pace(0.01, 1.0)
    pace.restart(0, 0.0)
    assert pace.give_up_delay(1, 0.039) == 0.0 and pace.due(2) == pytest.approx(0.02)  # later samples make up for it
    assert pace.lost(2) == 0.0


@pytest.mark.parametrize("factor", [0.5, 1.0, 20.0])
def test_lost_time_is_regained_at_a_tenth_above_the_pace_and_no_faster(factor):
    pace = Pace(0.01, factor)
    pace.restart(0, 100.0)
    assert pace.give_up_delay(10, pace.due(10) + 1.0) == pytest.approx(1.0)
    due = np.array([pace.due(k) for k in range(10, 4000)])
    punctual = 100.0 + 0.01 / factor * np.arange(10, 4000)
    late = due - punctual
    assert late[0] == pytest.approx(1.0) and pace.lost(10) == pytest.approx(1.0)
    steps = np.diff(due) * factor / 0.01
    regained = late < 1e-9
    assert np.allclose(steps[~regained[1:]], 1.0 / 1.1) and np.allclose(steps[regained[:-1]], 1.0)
    after = round(11.0 * factor / 0.01)  # samples: 11 s of the pace take 10 s
    assert regained.argmax() == pytest.approx(after, abs=1) if after < len(late) else not regained.any()


def test_a_second_delay_adds_to_what_is_not_yet_regained_and_a_restart_forgets_both():
    pace = Pace(0.01, 1.0)
    pace.restart(0, 0.0)
    pace.give_up_delay(0, 1.0)
    assert pace.lost(110) == pytest.approx(0.9)
    pace.give_up_delay(110, pace.due(110) + 0.5)
    assert pace.lost(110) == pytest.approx(1.4) and pace.due(110) == pytest.approx(1.1 + 1.4)
    pace.restart(110, 50.0)
    assert pace.lost(110) == 0.0 and pace.due(111) == pytest.approx(50.01)


def test_of_hours_that_are_lost_ten_seconds_are_regained_and_the_rest_is_given_up():
    pace = Pace(0.01, 1.0)
    pace.restart(0, 0.0)
    pace.give_up_delay(0, 7200.0)
    assert pace.lost(0) == 10.0 and pace.given_up == pytest.approx(7190.0) and pace.due(0) == 7200.0
    pace.give_up_delay(1, pace.due(1) + 1.0)
    assert pace.lost(1) == 10.0 and pace.given_up == pytest.approx(7191.0, abs=0.01)
    pace.restart(5, 9000.0)
    assert pace.given_up == 0.0 and pace.lost(5) == 0.0


def test_no_pace_is_never_late():
    pace = Pace(0.01, 0.0)
    pace.restart(0, 50.0)
    assert pace.due(1000) == -math.inf and pace.give_up_delay(1000, 1e9) == 0.0
