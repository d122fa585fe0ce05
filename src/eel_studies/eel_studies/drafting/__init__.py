# SPDX-License-Identifier: Apache-2.0
"""A swimmer behind a cylinder: what its street of vortices does to speed and power."""
