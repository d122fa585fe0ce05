# SPDX-License-Identifier: Apache-2.0
"""Derivatives of the measures of a run with respect to its parameters."""
