# SPDX-License-Identifier: Apache-2.0
"""For the tests of eel_gaits: hypothesis without wall-clock limits, and a ROS client that watches a gait generator."""

import pytest
from hypothesis import settings

settings.register_profile("eel", deadline=None, database=None)
settings.load_profile("eel")


@pytest.fixture
def client(ros_domain):
    """A node that receives laws, ticks /clock and sets parameters; gone when the test ends."""
    from gait_client import GaitClient

    watcher = GaitClient(domain=ros_domain)
    yield watcher
    watcher.close()
