"""The settings that the trade is measured over: points along the body, method and steps in time."""

from dataclasses import replace

from ..accuracy import PRESETS, Accuracy
from ..scene import Scene

RESOLUTIONS = (6.0, 8.0, 10.0, 13.0, 17.0, 24.0, 36.0, 52.0, 72.0, 110.0, 160.0, 240.0)  # points per body length
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)  # relative error per adaptive step
STEPS = (0.1, 0.05, 0.02, 0.01, 0.005)  # s, of the classical method
REFERENCE = Accuracy(name="reference run", resolution=700.0, tolerance=1e-11)
CHECK = Accuracy(name="check of the reference", resolution=500.0, tolerance=1e-10)
ADAPTIVE, CLASSICAL = "5(4), adaptive", "4, fixed step"  # orders of the methods, as the table calls them


def settings(quick: bool = False) -> list[Accuracy]:
    """Every combination of points and steps, and the presets; `quick`: every third of both, for a look."""
    part = slice(None, None, 3) if quick else slice(None)
    rows = [
        Accuracy(name=f"{resolution:g} points, tolerance {tolerance:g}", resolution=resolution, tolerance=tolerance)
        for resolution in RESOLUTIONS[part]
        for tolerance in TOLERANCES[part]
    ]
    rows += [
        Accuracy(name=f"{resolution:g} points, step {step:g} s", resolution=resolution, step=step)
        for resolution in RESOLUTIONS[part]
        for step in STEPS[part]
    ]
    return rows + [replace(Accuracy.of(name).in_scene(Scene()), name=name) for name in PRESETS]


def method_of(accuracy: Accuracy) -> str:
    """Order of the method, as the table calls it."""
    return ADAPTIVE if accuracy.step is None else CLASSICAL
