# SPDX-License-Identifier: Apache-2.0
"""The command `stability`: maps of where the simulator is accurate, inaccurate, or stops with a message."""
