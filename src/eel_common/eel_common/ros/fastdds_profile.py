# SPDX-License-Identifier: Apache-2.0
"""Fast DDS profile with which nodes find each other within 0.1 s, and resend lost packets within 50 ms.

Discovery: nodes that start together miss each other's first announcements. By default they announce themselves five
times in half a second, and then every 3 s. So they often found each other only after 3 s.

Lost packets: a run as fast as possible publishes thousands of messages a second. Packets are lost when a subscriber's
process is not scheduled for some milliseconds. The reliable protocol resends them, but by default it checks for losses
only every 3 s. After several losses the wait at the end of a run (5 s) was too short, and messages were missing, in 1
of 6 runs on a busy machine.
"""

import os
from pathlib import Path

VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"  # read only by Fast DDS, the default middleware
PROFILE = Path(__file__).with_name("fastdds.xml")


def use_profile() -> None:
    """Set the profile for this process, unless the user has set one; call this before `rclpy.init`."""
    if os.environ.get("FASTDDS_DEFAULT_PROFILES_FILE"):
        return
    os.environ.setdefault(VARIABLE, str(PROFILE))
