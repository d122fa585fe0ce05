# SPDX-License-Identifier: Apache-2.0
"""Fins, and fins as texts for commands and nodes."""
