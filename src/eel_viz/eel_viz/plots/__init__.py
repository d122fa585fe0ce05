# SPDX-License-Identifier: Apache-2.0
"""Profiles, maps, curves and text beside the scene."""
