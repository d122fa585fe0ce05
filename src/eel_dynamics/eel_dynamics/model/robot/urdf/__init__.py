# SPDX-License-Identifier: Apache-2.0
"""Robots and bodies from URDF files: elements, the chain of links, the robot."""
