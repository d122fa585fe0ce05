# SPDX-License-Identifier: Apache-2.0
"""The demands of a gait on a robot's motors, and how well the motors meet them."""
