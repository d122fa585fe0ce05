"""Whole runs: `simulate`, `simulate_batch`, and the command `simulate`."""
