"""The command `sweep`: simulates a grid of parameters on many processes."""
