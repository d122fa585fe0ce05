# SPDX-License-Identifier: Apache-2.0
"""How grid and steps of a run follow from its target, its law, and bounds of the steps."""
