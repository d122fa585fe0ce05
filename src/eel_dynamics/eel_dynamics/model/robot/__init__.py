# SPDX-License-Identifier: Apache-2.0
"""Bodies that bend by themselves: joints with motors, passive tails, muscles; robots by name and from files."""
