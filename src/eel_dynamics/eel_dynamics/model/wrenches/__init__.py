# SPDX-License-Identifier: Apache-2.0
"""External wrenches, such as tows, tethers and thrusters; and their texts for commands and nodes."""
