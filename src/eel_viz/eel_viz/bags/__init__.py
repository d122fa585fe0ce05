# SPDX-License-Identifier: Apache-2.0
"""rosbag2 files: recorded, read, and replayed into recordings; topics on a terminal."""
