# SPDX-License-Identifier: Apache-2.0
"""For the tests of all packages: nodes as processes, ROS domains of their own, and the fixtures that use them."""
