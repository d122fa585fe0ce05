# SPDX-License-Identifier: Apache-2.0
"""One swimmer, marched in time and observed: `Simulation`."""
