# SPDX-License-Identifier: Apache-2.0
"""The pictures of the studies: one style, and files that are the same each time."""
