# SPDX-License-Identifier: Apache-2.0
"""Many swimmers at once, over threads."""
