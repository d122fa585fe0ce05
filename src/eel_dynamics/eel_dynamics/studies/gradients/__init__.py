"""Derivatives of what a swim amounts to, by its parameters."""
