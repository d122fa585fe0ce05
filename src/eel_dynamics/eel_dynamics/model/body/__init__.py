# SPDX-License-Identifier: Apache-2.0
"""The body along X: its half-axes and mass, the panels it is cut into, the nodes, and integrals over them."""
