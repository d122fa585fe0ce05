# SPDX-License-Identifier: Apache-2.0
"""Quality of service: what fits and matches is what the middleware says is compatible."""

from itertools import product

import pytest
from eel_common.ros.qos import fitting, keep_all, latched, matches
from rclpy.qos import HistoryPolicy, QoSCompatibility, qos_check_compatible

ALL = [keep_all(reliable=reliable, latched=latched) for reliable, latched in product((True, False), repeat=2)]


@pytest.mark.parametrize("profile", ALL)
@pytest.mark.parametrize("offer", [*ALL, latched(1)])
def test_matching_is_what_the_middleware_says(profile, offer):
    compatible = qos_check_compatible(offer, profile)[0] != QoSCompatibility.ERROR
    assert matches(profile, offer) == compatible


@pytest.mark.parametrize("offers", [[offer] for offer in ALL] + [list(pair) for pair in product(ALL, repeat=2)])
def test_the_fitting_profile_matches_all_offers_and_asks_for_as_much_as_it_can(offers):
    best = fitting(offers)
    assert all(matches(best, offer) for offer in offers) and best.history == HistoryPolicy.KEEP_ALL
    able = [profile for profile in ALL if all(matches(profile, offer) for offer in offers)]
    assert all(matches(profile, best) for profile in able), "none that matches asks for more"
