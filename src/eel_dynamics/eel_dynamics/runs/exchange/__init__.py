# SPDX-License-Identifier: Apache-2.0
"""Runs as messages of the node `dynamics`, and back; the functions of eel_viz that take and give such messages."""
