# SPDX-License-Identifier: Apache-2.0
"""Each arrangement drawn by the real viewer: all views are there, none complains, and the picture is not empty."""

import io
import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
from contrast import contrast_in
from eel_viz.pictures.drawing import drawn
from eel_viz.plots import series
from eel_viz.scene3d import colours
from eel_viz.viewer import CannotRender, _await_listening

from eel_viz import entities

VIEWS = {
    "overview": {"3D": 1, "2D": 2, "TimeSeries": 3, "TextDocument": 2},
    "torques": {"3D": 1, "2D": 4},
    "motion": {"3D": 1, "TimeSeries": 5},
    "swimmer": {"3D": 1},
    "compare": {"3D": 1, "2D": 2, "TimeSeries": 3, "TextDocument": 1},
}


def pixels(png: bytes) -> np.ndarray:
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def test_every_view_is_shown_without_a_complaint(can_draw, tmp_path):
    from made_up_recording import record

    record(tmp_path / "made_up.rrd", 2.0, 50.0, compare="other")
    with drawn(tmp_path / "made_up.rrd", size=(1280, 720)) as drawing:
        for name in VIEWS:
            drawing.arrange(name)
            drawing.png(1.5)
            views = drawing.views()
            assert [(view.name, view.reports) for view in views if view.reports] == []
            assert dict(Counter(view.view_class for view in views)) == VIEWS[name], name


def test_a_picture_shows_the_swimmer_and_changes_with_time(can_draw, tmp_path):
    from made_up_recording import record

    record(tmp_path / "made_up.rrd", 2.0, 50.0)
    with drawn(tmp_path / "made_up.rrd", size=(1280, 720)) as drawing:
        pictures = [pixels(drawing.png(at)) for at in (1.1, 1.6)]
    assert pictures[0].shape == (720, 1280, 3)
    for picture in pictures:
        scene = picture[100:480, :680]
        red, blue = scene[:, :, 0] - scene[:, :, 2], scene[:, :, 2] - scene[:, :, 0]
        assert (red > 40).sum() > 300  # skin and path of the head
        assert (blue > 30).sum() > 3000  # water lines, skin
    assert (np.abs(pictures[0] - pictures[1]).sum(axis=2) > 60).sum() > 2000


def test_curves_grids_and_letters_have_a_contrast_of_3_in_the_picture(can_draw, tmp_path):
    from made_up_recording import record

    record(tmp_path / "made_up.rrd", 2.0, 50.0)
    with drawn(tmp_path / "made_up.rrd", size=(1920, 1080)) as drawing:
        picture = pixels(drawing.png(1.5))
    space, plots = picture[90:640, :1020], picture[90:1040, 1030:]
    seen = {name: contrast_in(plots, colours.curve(colour)) for name, colour in series.SERIES[entities.POWER]}
    seen |= {name: contrast_in(plots, getattr(colours, name)) for name in ("TICK", "LABEL")}
    seen["speed"] = contrast_in(plots, colours.curve(colours.PLAIN))
    seen["lines of the water"] = contrast_in(space, colours.WATER_LINE_MAJOR)
    assert min(seen.values()) >= 3.0, seen


def test_a_bare_picture_is_the_view_alone_in_the_size_that_was_asked_for(can_draw, tmp_path):
    from made_up_recording import record

    record(tmp_path / "made_up.rrd", 2.0, 50.0)
    for size, blueprint in (((800, 450), ""), ((480, 360), "motion")):  # there it is one of six views
        with drawn(tmp_path / "made_up.rrd", size=size, blueprint=blueprint, bare=True) as drawing:
            picture = pixels(drawing.png(1.5))
        assert picture.shape == (size[1], size[0], 3)
        edge = picture[:5].reshape(-1, 3)
        assert (edge[:, 2] > edge[:, 0] + 10).mean() > 0.9  # water, no tabs


def test_a_viewer_that_panics_is_one_line_that_says_what_to_install(tmp_path):
    said = (tmp_path / "said").open("w+b")
    said.write(b"note: something\nError: Failed to get render context\n")
    process = subprocess.Popen([sys.executable, "-c", "raise SystemExit(102)"])
    process.wait()
    with pytest.raises(CannotRender, match=r"status 102 .Error: Failed to get render context.*mesa-vulkan-drivers"):
        _await_listening(process, 1, said)
    said.close()
