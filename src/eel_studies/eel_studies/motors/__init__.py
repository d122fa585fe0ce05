# SPDX-License-Identifier: Apache-2.0
"""What a gait asks of a robot's motors, and what they make of it."""
