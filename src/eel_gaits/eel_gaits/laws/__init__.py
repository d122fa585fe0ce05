# SPDX-License-Identifier: Apache-2.0
"""Curvature laws: their terms, and the splines of amplitudes."""
