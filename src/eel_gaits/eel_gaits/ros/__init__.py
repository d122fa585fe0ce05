# SPDX-License-Identifier: Apache-2.0
"""The nodes `gait_generator` and `heading_controller`, and laws as messages."""
