# SPDX-License-Identifier: Apache-2.0
"""For a node with its own loop: pace, /clock, requests of callbacks, topics without loss, its log."""
