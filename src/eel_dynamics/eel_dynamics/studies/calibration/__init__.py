"""Calibration: measures the table of accuracy, the settings that deliver each target."""
