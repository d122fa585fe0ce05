# SPDX-License-Identifier: Apache-2.0
"""The command `sweep`: simulates a grid of parameters in many threads or processes."""
