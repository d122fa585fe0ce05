# SPDX-License-Identifier: Apache-2.0
"""What decides grid and steps of a run: a target, the needs of its law, bounds of the steps."""
