# SPDX-License-Identifier: Apache-2.0
"""The node's log and its content of /diagnostics."""

import pytest
from eel_common.ros.loop.diagnostics import ERROR, OK, WARN, Report
from eel_common.ros.testing.log import Log


def test_lasting_condition_is_logged_once_and_shown_while_it_lasts():
    log = Log()
    report = Report(log)
    for _ in range(3):
        report.begin("laws", "two publishers")
    assert log.lines == [("warning", "two publishers")] and report.state() == (WARN, ["two publishers"])
    report.end("laws", "one again")
    report.end("laws", "one again")
    assert log.lines[1:] == [("info", "one again")] and report.state() == (OK, [])


def test_event_is_logged_at_most_once_a_second():
    now = [0.0]
    log = Log()
    report = Report(log, lambda: now[0])
    for step in range(25):
        now[0] = 0.1 * step
        report.event("late", f"late at {step}")
    assert [text for _, text in log.lines] == ["late at 0", "late at 10", "late at 20"]
    assert report.state() == (WARN, ["late at 24"])
    now[0] = 10.0
    assert report.state() == (OK, [])


def test_differing_events_are_all_logged_if_asked():
    log = Log()
    report = Report(log, lambda: 0.0)
    for text in ("one", "one", "two"):
        report.event("law", text, ERROR, differing=True)
    assert log.lines == [("error", "one"), ("error", "two")]
    assert report.state()[0] == ERROR


@pytest.mark.parametrize("differing", [False, True])
def test_the_same_event_is_logged_once_while_it_lasts(differing):
    now, log = [0.0], Log()
    report = Report(log, lambda: now[0])
    for step in range(100):
        now[0] = 0.1 * step
        report.event("command", "neck is no joint", ERROR, differing)
    assert log.lines == [("error", "neck is no joint")] and report.state() == (ERROR, ["neck is no joint"])
    now[0] += 1.0
    report.event("command", "neck is no joint", ERROR, differing)
    assert len(log.lines) == 2
    for _ in range(15):  # another one that could not be told at once is told
        now[0] += 0.1
        report.event("command", "hip is no joint", ERROR, differing)
    assert [text for _, text in log.lines] == ["neck is no joint"] * 2 + ["hip is no joint"]


def test_texts_that_come_in_turn_are_logged_once_each_while_they_come():
    now, log = [0.0], Log()
    report = Report(log, lambda: now[0])
    for _ in range(500):
        now[0] += 0.01
        for text in ("neck is no joint", "inf is no angle"):
            report.event("command", text, ERROR, differing=True)
    assert [text for _, text in log.lines] == ["neck is no joint", "inf is no angle"]
    now[0] += 2.0
    report.event("command", "inf is no angle", ERROR, differing=True)
    assert len(log.lines) == 3
