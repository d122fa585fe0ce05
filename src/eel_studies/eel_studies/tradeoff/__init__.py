# SPDX-License-Identifier: Apache-2.0
"""The command `tradeoff`: measures and draws the cost of accuracy, and the error of simpler models, for a gait."""
