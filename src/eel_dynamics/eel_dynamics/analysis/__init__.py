# SPDX-License-Identifier: Apache-2.0
"""What a run tells: speed, power, efficiency, actuators, limits of the model, summary."""
