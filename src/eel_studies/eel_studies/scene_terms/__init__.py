# SPDX-License-Identifier: Apache-2.0
"""The effect of each term of the model on a scene, and the smallest scene within a tolerance: `eel terms`."""
