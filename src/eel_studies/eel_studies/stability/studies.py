# SPDX-License-Identifier: Apache-2.0
"""The studies by name. Each returns a text in Markdown and pictures."""

from collections.abc import Callable
from dataclasses import dataclass, field

from eel_studies.stability import condition, drift, plane
from eel_studies.stability.drawing import draw, draw_condition
from eel_studies.stability.maps import maps_of, measure
from eel_studies.stability.report import report


@dataclass(frozen=True)
class Study:
    """The result of a study: `text` in Markdown; `pictures` by name: title, and a function that draws into a figure."""

    text: str
    pictures: dict[str, tuple[str, Callable]] = field(default_factory=dict)


def maps(points: int) -> Study:
    """Maps of runs over two parameters, with `points` values of each: accurate, inaccurate, or stopped."""
    found = [measure(item) for item in maps_of(points)]
    return Study(report(found), _pictures(draw, found))


def conditions(points: int) -> Study:
    """Maps of the condition number of the 6 x 6 matrix, with `points` values of each parameter; singular bodies."""
    found = condition.maps_of(points)
    return Study(condition.table(found), _pictures(draw_condition, found))


def drifts(points: int) -> Study:
    """Drift over 100,000 periods; `points` has no effect."""
    return Study(drift.table([drift.drift_of(name, *each) for name, each in drift.swimmers().items()]))


def planes(points: int) -> Study:
    """Growth of round-off out of the plane of a planar law; `points` has no effect."""
    return Study(plane.table())


STUDIES = {"maps": maps, "condition": conditions, "drift": drifts, "plane": planes}


def _pictures(draw_one: Callable, found) -> dict[str, tuple[str, Callable]]:
    return {each.map.name: (each.map.title, lambda figure, each=each: draw_one(figure, each)) for each in found}
