# SPDX-License-Identifier: Apache-2.0
"""A pilot: from the motion of the head and a goal to the curvature of the body. Nothing here needs ROS."""
