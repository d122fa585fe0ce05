"""Curvature laws of elongated swimmers, and a ROS 2 node that publishes them. Nothing imported here needs ROS."""

from eel_gaits.law import Law, Ramp, Term
from eel_gaits.spline import natural_spline

__all__ = ["Law", "Ramp", "Term", "natural_spline"]
