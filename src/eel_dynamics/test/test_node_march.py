# SPDX-License-Identifier: Apache-2.0
"""A sample that takes long: the node answers requests meanwhile, says that it hangs, and ends at once."""

import math

import pytest
from eel_gaits.ros.messages import law_to_message

from eel_gaits import Law, Term, falling

WITHOUT_LIMIT = ("--ros-args", "-p", "most_evaluations:=1.0e15")


def quick(period):
    """A law that takes ten steps or more by `period` [s]."""
    return Law(Term(amplitude=(5.0, 1.0), wavelength=1.0, period=period, phase=math.pi / 2), name="quick")


@pytest.mark.fault(
    "laws",
    "a law whose period is so short that it takes more than `most_evaluations` (1e-5 s, 1e-9 s)",
    "refused with the number; the law in force stays",
)
def test_a_law_that_costs_too_much_is_refused(start, client):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics")
    swim.until_time(0.2)
    for period in (1e-5, 1e-9):
        swim.laws.publish(law_to_message(quick(period)))
        said = f"law 'quick' refused: law 'quick' has a period of {period:g} s, which takes {10 / period:.3g} eval"
        swim.until(lambda said=said: said in node.output(), "refusal")
    swim.until_time(0.5)
    swim.until(lambda: swim.diagnosis()[2]["law"] == "falling" and swim.is_well(), "the law in force")


@pytest.mark.fault(
    "laws",
    "a sample that takes minutes",
    "ERROR in /diagnostics after 3 s; pause, reset, another law and signals take effect meanwhile",
)
def test_a_sample_that_takes_minutes_holds_nothing_up(start, client):
    """Ten milliseconds of a law with a period of a tenth of a nanosecond, twice."""
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(quick(1e-10)))
    node = start("dynamics", *WITHOUT_LIMIT)
    swim.until(lambda: swim.received["/diagnostics"] and swim.diagnosis()[0] == 2, "ERROR in the diagnostics")
    assert "no sample for" in swim.diagnosis()[1] and "after t = 0 s" in swim.diagnosis()[1]
    assert swim.pause(True).success
    swim.until(lambda: swim.diagnosis()[1] == "paused at t = 0 s", "the pause in the diagnostics")
    assert swim.pause(False).success and swim.reset().success
    swim.laws.publish(law_to_message(falling()))
    swim.until(lambda: "law 'falling' adopted" in node.output(), "another law")
    assert swim.reset().success
    swim.until_time(0.5)
    swim.until(swim.is_well, "good diagnostics")
    swim.laws.publish(law_to_message(quick(1e-10)))
    swim.until(lambda: swim.diagnosis()[0] == 2 and "no sample for" in swim.diagnosis()[1], "ERROR again")
    assert node.output().count("no sample for") == 2
    assert node.time_to_end() < 2.0
    assert node.status == 0 and "Traceback" not in node.output()
