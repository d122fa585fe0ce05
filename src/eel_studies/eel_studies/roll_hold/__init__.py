# SPDX-License-Identifier: Apache-2.0
"""Fins that hold the roll of a gait: the window of area and gain, and long swims in it."""
