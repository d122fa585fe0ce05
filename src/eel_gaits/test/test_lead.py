# SPDX-License-Identifier: Apache-2.0
"""The instants of a controller in the loop."""

import pytest
from eel_gaits.ros.lead import MOST_SKIPPED, Lead


def test_a_run_begins_at_0_and_each_instant_comes_once_up_to_the_lead():
    lead = Lead(period=0.02, lead=0.05)
    assert lead.begins(0.0) and lead.begin(0.0) == 0.0
    assert lead.after(0.0) == pytest.approx([0.02, 0.04])
    assert not lead.begins(0.01) and lead.after(0.01) == pytest.approx([0.06])
    assert lead.after(0.02) == []
    assert lead.after(0.05) == pytest.approx([0.08, 0.1])


def test_a_controller_that_joins_a_run_begins_ahead_of_it():
    lead = Lead(period=0.01, lead=0.1)
    assert lead.begins(12.34) and lead.begin(12.34) == pytest.approx(12.44)
    assert lead.after(12.34) == [] and lead.after(12.36) == pytest.approx([12.45, 12.46])


def test_a_lead_below_the_period_still_gives_an_instant_ahead():
    lead = Lead(period=0.1, lead=0.02)
    lead.begin(0.0)
    assert [lead.after(0.1 * k) for k in range(4)] == [[pytest.approx(0.1 * (k + 1))] for k in range(4)]


def test_a_stamp_that_goes_back_and_a_long_gap_begin_a_run_and_a_short_gap_does_not():
    """However far the stamp lies ahead, its instants are few."""
    lead = Lead(period=0.01, lead=0.05)
    lead.begin(0.0)
    lead.after(0.0)
    assert not lead.begins(5.0) and len(lead.after(5.0)) == 500 and lead.begins(4.0)
    far = 5.05 + 0.01 * (MOST_SKIPPED + 1)
    assert lead.begins(far) and lead.begins(2.0**31)
    lead.begin(2.0**31)
    assert lead.after(2.0**31) == []


def test_instants_do_not_drift():
    lead = Lead(period=0.01, lead=0.01)
    lead.begin(0.0)
    stamps = [round(1e9 * each) for k in range(100_000) for each in lead.after(k / 100)]
    assert stamps == [10_000_000 * k for k in range(1, 100_001)]
