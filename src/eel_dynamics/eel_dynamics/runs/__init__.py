# SPDX-License-Identifier: Apache-2.0
"""Whole runs: `simulate`, `simulate_batch`, and the command `simulate`."""
