# SPDX-License-Identifier: Apache-2.0
"""The function and the command `identify`: coefficients of the model from a measured motion, with their intervals."""
