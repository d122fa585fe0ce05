# SPDX-License-Identifier: Apache-2.0
"""How much fin holds the roll of a gait: the window of area and gain, and what long swims do in it."""
