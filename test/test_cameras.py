# SPDX-License-Identifier: Apache-2.0
"""The cameras of the visualiser keep the swimmer in the picture: every gait, every tenth of a second, every camera.

The projection is written here a second time, from the eye, its target and Rerun's vertical field of view.
"""

import itertools

import numpy as np
import pytest
from eel_gaits.gaits.registry import GAITS
from eel_viz.scene3d import camera
from eel_viz.scene3d.camera import FollowFrame, PathFrame

from eel_dynamics import simulate

DURATION, PERIOD = 20.0, 0.1  # s
ASPECT = 1.3  # width by height of the narrowest view
FIELD_OF_VIEW = 55.0  # degrees, vertical
GAIT_NAMES = sorted(GAITS)


@pytest.fixture(scope="module")
def runs():
    """Backbones (T, M, 3) [m] of all gaits in the world of the messages."""

    def backbones(name):
        run = simulate(GAITS[name](), DURATION, accuracy="draft", sample_period=PERIOD, stations=21, estimate=False)
        return run.backbone

    return {name: backbones(name) for name in GAIT_NAMES}


def in_picture(points, centre, radius):
    """Places (..., 2) in the picture: -1 to 1 from edge to edge, of `points` (..., 3) in a frame."""
    ahead = -np.array(camera.EYE) / np.linalg.norm(camera.EYE)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    seen = (np.asarray(points) - centre) / radius - camera.EYE
    tangent = np.tan(np.radians(FIELD_OF_VIEW) / 2) * (seen @ ahead)
    return np.stack([seen @ right / (ASPECT * tangent), seen @ np.cross(right, ahead) / tangent], axis=-1)


def stamps(count):
    return [round(k * PERIOD * 1e9) for k in range(count)]


@pytest.mark.parametrize("name", GAIT_NAMES)
def test_the_following_camera_shows_the_whole_swimmer_large(runs, name):
    frame, seen = FollowFrame(), []
    for stamp, line in zip(stamps(len(runs[name])), runs[name], strict=True):
        seen.append(in_picture(line, *frame.follow(stamp, line, 1.0)))
    assert np.abs(seen).max() < 0.9  # head, tail and all between
    sizes = np.ptp(seen, axis=1).max(axis=1) / 2  # of the swimmer, in pictures
    assert np.median(sizes) > 0.35 and sizes.min() > 0.1, (np.median(sizes), sizes.min())


@pytest.mark.parametrize("name", GAIT_NAMES)
def test_the_camera_of_the_path_shows_all_places_so_far(runs, name):
    frame = PathFrame()
    for k, line in enumerate(runs[name]):
        seen = in_picture(runs[name][: k + 1], *frame.include(line, 1.0))
        assert np.abs(seen).max() < 0.9
    assert np.ptp(seen.reshape(-1, 2), axis=0).max() / 2 > 0.35


@pytest.mark.parametrize(("one", "other"), list(itertools.pairwise(GAIT_NAMES)))
def test_the_camera_of_two_swimmers_shows_both(runs, one, other):
    frame = FollowFrame()
    for stamp, *lines in zip(stamps(len(runs[one])), runs[one], runs[other], strict=True):
        both = np.concatenate(lines)
        assert np.abs(in_picture(both, *frame.follow(stamp, both, 1.0))).max() < 0.9


def test_a_swimmer_that_leaves_the_picture_is_found_out(runs):
    """A camera that stands where the following one stood at the start: what the check is for."""
    line = runs["straight"]
    still = FollowFrame().follow(0, line[0], 1.0)
    assert np.abs(in_picture(line[-1], *still)).max() > 1.0
