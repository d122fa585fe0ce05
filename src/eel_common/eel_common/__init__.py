# SPDX-License-Identifier: Apache-2.0
"""Shared by all packages: numbers with bounds, values in messages, one-line errors, input and output files."""
