# SPDX-License-Identifier: Apache-2.0
"""What a node with a loop of its own needs: its pace, /clock, requests of callbacks, topics without loss, its log."""
