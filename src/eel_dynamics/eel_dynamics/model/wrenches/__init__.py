# SPDX-License-Identifier: Apache-2.0
"""Wrenches from outside: tows, tethers, thrusters; and the same as texts for commands and nodes."""
