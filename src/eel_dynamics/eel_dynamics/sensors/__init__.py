# SPDX-License-Identifier: Apache-2.0
"""Sensors on the swimmer: their readings, with rate, latency, noise and bias. A sensor without a rate is off."""
