# SPDX-License-Identifier: Apache-2.0
"""The pilot of `eel_gaits` in the loop with a simulation, in one process: random courses and their figures."""
