# SPDX-License-Identifier: Apache-2.0
"""Runs and batches as data: netCDF files, labelled arrays, tables."""
