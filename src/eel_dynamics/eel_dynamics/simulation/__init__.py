"""One swimmer, marched in time and observed: `Simulation`."""
