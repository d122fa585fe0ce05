# SPDX-License-Identifier: Apache-2.0
"""Progress is told for what takes over 2 s: as lines that become rare, or as a bar on a terminal."""

import io

import pytest
from eel_base.command.progress import Progress


@pytest.fixture
def told(monkeypatch):
    """What progress(k, 100) writes once a second, k = 1, 2 ... count; on_terminal: whether stderr is one."""

    def written(count: int, on_terminal: bool) -> str:
        stderr = io.StringIO()
        stderr.isatty = lambda: on_terminal
        monkeypatch.setattr("sys.stderr", stderr)
        now = [0.0]
        monkeypatch.setattr("eel_base.command.progress.QUIET", 2.0)
        monkeypatch.setattr("eel_base.command.progress.time", type("Clock", (), {"monotonic": lambda: now[0]}))
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
    assert lines[1] == "eel sweep: 4 of 100 points, about 128 s left"  # 3 points in 4 s, the first was there before


def test_a_bar_is_drawn_over_itself_and_ends_its_line(told):
    text = told(100, True)
    assert text.count("\n") == 1 and text.endswith("\n") and text.count("\r") == 99
    assert "[##############################] 100 of 100 points" in text.rpartition("\r")[2]
