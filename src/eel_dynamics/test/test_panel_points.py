# SPDX-License-Identifier: Apache-2.0
"""How many points a panel has does not hang on the resolution's last bit, which differs between versions of numpy."""

import numpy as np
import pytest
from eel_dynamics.model.body.panels import nearest, panels_of

from eel_dynamics import Accuracy, Body


@pytest.mark.parametrize("resolution", [10.0, 30.0, 50.0])
def test_neighbouring_resolutions_give_the_same_panels(resolution):
    body = Body.boyer2010()
    below, above = np.nextafter(resolution, 0.0), np.nextafter(resolution, np.inf)
    assert panels_of(body, below) == panels_of(body, resolution) == panels_of(body, above)


def test_halves_go_up():
    assert [nearest(count) for count in (0.0, 0.49, 0.5, 0.51, 1.5, 2.5)] == [0, 0, 1, 1, 2, 3]


@pytest.mark.parametrize("body", [Body.boyer2010(), Body.kern2006()], ids=["robot", "eel"])
@pytest.mark.parametrize("wrench", [True, False])
def test_the_last_eight_nodes_are_filled_and_further_points_have_eight_more(body, wrench):
    for resolution in np.geomspace(1.0, 150.0, 60):
        accuracy = Accuracy(name="test", resolution=float(resolution))
        nodes = [
            sum(panel.points for panel in panels_of(body, each.resolution, (), wrench))
            for each in (accuracy, accuracy.with_other_points())
        ]
        assert nodes[0] % 8 == nodes[1] % 8 == 0 and nodes[1] >= nodes[0] + 8


def test_a_body_of_another_size_has_the_same_panels():
    for size in np.geomspace(0.01, 100.0, 41):
        panels, other = panels_of(Body.kern2006(), 15.0), panels_of(Body.kern2006(float(size)), 15.0)
        assert [panel.points for panel in panels] == [panel.points for panel in other]
