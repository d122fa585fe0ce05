# SPDX-License-Identifier: Apache-2.0
"""Every arrangement, drawn of real gaits by the real viewer: the swimmer is in the picture, and no view is empty.

The soak draws each arrangement of one gait, and each of every gait, and leaves the pictures in out/pictures_of_gaits.
"""

import io
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from eel_gaits.gaits.registry import GAITS
from eel_viz.pictures.drawing import drawn
from eel_viz.recording.reading import read
from eel_viz.scene3d import camera
from eel_viz.settings import BLUEPRINTS
from eel_viz.viewer import CannotRender
from PIL import Image

from eel_dynamics import simulate
from eel_viz import entities

OUT = Path(__file__).resolve().parents[1] / "out" / "pictures_of_gaits"
RECORDING, SIZE = "run.rrd", (1280, 720)
DURATION, MOMENT = 8.0, 6.4  # s
FRAMES = {"motion": entities.WHOLE_PATH, "compare": entities.BOTH}  # of an arrangement's camera; else the following one
COVERED = 0.7  # of the midline: the rest lies behind a label, or is as dark as the water
LEAST_SPREAD = 3.0  # of a view's brightness, 0 to 255


@pytest.fixture
def pictures(tmp_path):
    """pictures(gait, other): yields each arrangement's name, its picture, and its views with what draws each."""

    def drawn_pictures(gait, other):
        run, compared = (
            simulate(GAITS[name](), DURATION, accuracy="draft", sample_period=0.04, load=True, estimate=False)
            for name in (gait, other)
        )
        run.to_rerun(tmp_path / RECORDING, compare=compared)
        try:
            with drawn(tmp_path / RECORDING, size=SIZE) as drawing:
                for name in BLUEPRINTS:
                    if name in ("robot", "sensors"):  # of bodies with joints, or sensors, alone
                        continue
                    drawing.arrange(name)
                    png = drawing.png(MOMENT)
                    yield name, png, [(view, partial(drawing.screenshot, view.view_id)) for view in drawing.views()]
        except CannotRender as reason:
            if "Vulkan" not in str(reason):
                raise
            pytest.skip(f"no picture: {reason}")

    return drawn_pictures


def pixels(png):
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(float)


def midline_in_view(path, arrangement, shape):
    """Rows and columns (n, 2) of the midline in the first view of the arrangement, whose picture has this `shape`."""
    now = round(MOMENT * 1e9)
    frame, line = read(path, FRAMES.get(arrangement, entities.FOLLOW)), read(path, entities.BACKBONE)
    last, at = (int(np.searchsorted(each.stamps, now, side="right")) - 1 for each in (frame, line))
    points = np.array(line["strips"][at][0])
    right, up = camera.in_picture((points - frame["translation"][last]) / frame["scale"][last]).T
    focal = shape[0] / 2 / camera.EDGE
    return np.stack([shape[0] / 2 - focal * up, shape[1] / 2 + focal * right], axis=1).round().astype(int)


def covered(picture, places):
    """Share of the `places` (n, 2) in the `picture` (H, W, 3) that show something else than water: blue, half green."""
    inside = (places >= 0).all(axis=1) & (places < picture.shape[:2]).all(axis=1)
    red, green, blue = picture[tuple(places[inside].T)].T
    more = blue - red
    water = (more >= 12.0) & (green - red >= 0.40 * more) & (green - red <= 0.75 * more)
    return float((~water).sum() / len(places))


def check_swimmer(path, name, picture):
    """The swimmer is where the camera of the arrangement's first view must have it."""
    share = covered(picture, midline_in_view(path, name, picture.shape))
    assert share > COVERED, (name, share)


@pytest.mark.soak
def test_every_arrangement_shows_the_swimmer(pictures, tmp_path):
    """And what finds it there does not find it in a picture that is turned upside down."""
    for name, png, views in pictures("turning", "helix"):
        assert [(view.name, view.reports) for view, _ in views if view.reports] == []
        assert pixels(png).std() > LEAST_SPREAD, name
        picture = pixels(views[0][1]())
        check_swimmer(tmp_path / RECORDING, name, picture)
        with pytest.raises(AssertionError):
            check_swimmer(tmp_path / RECORDING, name, picture[::-1, ::-1])


@pytest.mark.soak
@pytest.mark.timeout(900)
@pytest.mark.parametrize("gait", sorted(GAITS))
def test_every_arrangement_of_every_gait_shows_the_swimmer(pictures, tmp_path, gait):
    OUT.mkdir(parents=True, exist_ok=True)
    for name, png, views in pictures(gait, "falling"):
        (OUT / f"{gait}_{name}.png").write_bytes(png)
        assert [(view.name, view.reports) for view, _ in views if view.reports] == []
        check_swimmer(tmp_path / RECORDING, name, pixels(views[0][1]()))
        for view, draw in views[1:]:
            assert pixels(draw()).std() > LEAST_SPREAD, (name, view.name)
