"""The curvature law K(t, X) that the body follows: its needs, its tables on a grid, blends, samples of a controller."""
