# SPDX-License-Identifier: Apache-2.0
"""Progress is told for what takes over 2 s: as lines that become rare, or as a bar on a terminal."""

import io
import math

import numpy as np
import pytest
from eel_common.command.progress import Forecast, Progress


@pytest.fixture
def told(monkeypatch):
    """What progress(k, 100) writes once a second, k = 1, 2 ... count; on_terminal: whether stderr is one."""

    def written(count: int, on_terminal: bool) -> str:
        stderr = io.StringIO()
        stderr.isatty = lambda: on_terminal
        monkeypatch.setattr("sys.stderr", stderr)
        now = [0.0]
        monkeypatch.setattr("eel_common.command.progress.QUIET", 2.0)
        monkeypatch.setattr("eel_common.command.progress.time", type("Clock", (), {"monotonic": lambda: now[0]}))
        progress = Progress("eel sweep", "points")
        for done in range(1, count + 1):
            now[0] = float(done)
            progress(done, 100)
        return stderr.getvalue()

    return written


def test_what_ends_within_2_s_says_nothing(told):
    assert told(1, False) == told(1, True) == ""


def test_lines_become_rare(told):
    lines = told(100, False).splitlines()
    assert [line.split()[2] for line in lines] == ["2", "4", "8", "16", "32", "64"]
    assert lines[:3] == ["eel sweep: 2 of 100 points", "eel sweep: 4 of 100 points", lines[2]]  # not known yet
    assert lines[2] == "eel sweep: 8 of 100 points, about 92 s left"


def test_a_bar_is_drawn_over_itself_and_ends_its_line(told):
    text = told(100, True)
    assert text.count("\n") == 1 and text.endswith("\n") and text.count("\r") == 99
    assert "[##############################] 100 of 100 points" in text.rpartition("\r")[2]


# Rate of a work at a wall time [s], relative to its whole; what comes before 0 is its set-up.
WORKS = {
    "steady": lambda now: 1.0 / 36.0,
    "slow": lambda now: 1e-4,
    "uneven": lambda now: (1.0 + 0.3 * math.sin(now)) / 60.0,
    "slow at first": lambda now: (0.01 if now < 4.0 else 1.0) / 36.0,
    "slower in the end": lambda now: (2.0 if now < 20.0 else 1.0) / 80.0,
    "faster and faster": lambda now: (1.0 + now / 36.0) / 54.0,
}


@pytest.mark.parametrize("spacing", [0.05, 0.7, 5.0])
@pytest.mark.parametrize("rate", WORKS.values(), ids=WORKS)
def test_a_forecast_is_silent_until_it_is_good_to_a_factor_of_2(rate, spacing):
    """By a made-up clock: the set-up takes 70 s, then there is a word every `spacing` [s]."""
    forecast, now, done, told = Forecast(), 0.0, 0.0, []
    while done < 1.0:
        forecast.add(70.0 + now, done)
        if (left := forecast.left(1.0)) is not None:
            told.append((now, left))
        done += spacing * rate(now + 0.5 * spacing)
        now += spacing
    times, left = np.array(told).T
    assert times[0] <= max(16.0, 3.0 * spacing) and times[0] >= 6.0  # s
    early = now - times > 2.0 * spacing + 4.0  # a word is of the last mark, up to a second ago
    ratio = left[early] / (now - times[early])
    assert ratio.min() >= 0.5 and ratio.max() <= 2.0


def test_a_work_that_begins_anew_is_forecast_anew():
    forecast = Forecast()
    for second in range(20):
        forecast.add(float(second), second % 10)
    assert forecast.left(10.0) == pytest.approx(1.0)
    forecast.add(20.0, 0.0)
    assert forecast.left(10.0) is None
