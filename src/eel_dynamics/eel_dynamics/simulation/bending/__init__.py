# SPDX-License-Identifier: Apache-2.0
"""The march of a robot, with dynamic bending."""
