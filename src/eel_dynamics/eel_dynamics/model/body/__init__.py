# SPDX-License-Identifier: Apache-2.0
"""The body along X: its half-axes and mass, the panels into which it is cut, the nodes, and integrals over them."""
