# SPDX-License-Identifier: Apache-2.0
"""Frame ids below a namespace."""

import pytest
from eel_common.ros.headers import frame_in


@pytest.mark.parametrize(
    ("namespace", "expected"), [("/", "odom"), ("", "odom"), ("/eel1", "eel1/odom"), ("/tank/eel1", "tank/eel1/odom")]
)
def test_a_frame_lies_below_its_namespace_without_a_leading_slash(namespace, expected):
    assert frame_in(namespace, "odom") == expected
