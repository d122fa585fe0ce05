"""How many points a panel has does not hang on the resolution's last bit, which differs between versions of numpy."""

import numpy as np
import pytest
from eel_dynamics.sections import nearest, panels_of

from eel_dynamics import Body


@pytest.mark.parametrize("resolution", [10.0, 30.0, 50.0])
def test_neighbouring_resolutions_give_the_same_panels(resolution):
    body = Body.boyer2010()
    below, above = np.nextafter(resolution, 0.0), np.nextafter(resolution, np.inf)
    assert panels_of(body, below) == panels_of(body, resolution) == panels_of(body, above)


def test_halves_go_up():
    assert [nearest(count) for count in (0.0, 0.49, 0.5, 0.51, 1.5, 2.5)] == [0, 0, 1, 1, 2, 3]
