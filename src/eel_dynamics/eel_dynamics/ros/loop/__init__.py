# SPDX-License-Identifier: Apache-2.0
"""The node's run loop: pacing, waiting, requests and laws."""
