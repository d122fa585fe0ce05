# SPDX-License-Identifier: Apache-2.0
"""Analysis of a run: speed, power, efficiency, actuators, limits of the model, summary."""
