"""Runs and batches as data: netCDF files, labelled arrays, tables."""
