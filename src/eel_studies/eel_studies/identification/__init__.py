# SPDX-License-Identifier: Apache-2.0
"""The function and the command `identify`: coefficients of the model, with intervals, from a measured motion."""
