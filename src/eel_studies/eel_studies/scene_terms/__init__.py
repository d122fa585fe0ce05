# SPDX-License-Identifier: Apache-2.0
"""What each term of the model does to a scene, and the smallest scene within a tolerance: `eel terms`."""
