# SPDX-License-Identifier: Apache-2.0
"""Whole runs: `simulate`, the class `Run`, its error, its files and its messages."""
