"""Profiles, maps, curves and text beside the scene."""
