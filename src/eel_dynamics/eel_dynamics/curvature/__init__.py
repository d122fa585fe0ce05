# SPDX-License-Identifier: Apache-2.0
"""The curvature law K(t, X) of the body: its tables on a grid, its blends, and a controller's samples."""
