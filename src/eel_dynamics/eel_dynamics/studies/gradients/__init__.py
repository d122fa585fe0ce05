# SPDX-License-Identifier: Apache-2.0
"""Derivatives of what a swim amounts to, by its parameters."""
