# SPDX-License-Identifier: Apache-2.0
"""Publishers for tests of the run loop without ROS."""

from types import SimpleNamespace


def fake_publishers(publish):
    """Publishers with one subscriber, `publish(snapshot, nanoseconds)`, who needs no costly part of a sample."""
    return SimpleNamespace(
        wanted_parts=lambda: {"wrench": False, "load": False},
        publish=publish,
        tick=lambda nanoseconds: None,
        audience=tuple,
        lossless=False,
    )
