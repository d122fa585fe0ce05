"""The command `sweep`: a grid of parameters on many processes."""
