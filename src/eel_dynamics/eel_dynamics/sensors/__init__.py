# SPDX-License-Identifier: Apache-2.0
"""Sensors on the swimmer: what they read, with rate, latency, noise and bias. Each is off unless it has a rate."""
