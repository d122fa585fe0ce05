# SPDX-License-Identifier: Apache-2.0
"""Robots: joints with motors, passive tails, muscles; robots by name and from files."""
