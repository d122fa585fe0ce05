# SPDX-License-Identifier: Apache-2.0
"""Files that are read, with bounds, and files that are written, whole or not at all."""
