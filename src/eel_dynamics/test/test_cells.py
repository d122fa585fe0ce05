# SPDX-License-Identifier: Apache-2.0
"""Runs, batches, bodies and laws in the cells of a notebook: a picture and numbers; pictures alone by `plot`."""

import base64
import io
import sys

import numpy as np
import pytest
from eel_common.cell import cell_of

from eel_dynamics import Body, Scene, simulate, simulate_batch
from eel_gaits import Law, Term, falling, straight

image = pytest.importorskip("PIL.Image")
pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def run():
    return simulate(falling(), duration=2.0, accuracy="draft", estimate=False)


def shown(thing):
    """Colours of the picture (h, w, 3), and the text of the cell."""
    html = thing._repr_html_()
    assert len(html) < 150_000, "a notebook of many cells stays small"
    picture = base64.b64decode(html.split("base64,")[1].split("'")[0])
    return np.asarray(image.open(io.BytesIO(picture)).convert("RGB")), html.split(">", 2)[2]


def test_a_run_shows_its_path_speed_and_torque(run):
    pixels, text = shown(run)
    assert pixels.shape[1] > 700 and len(np.unique(pixels.reshape(-1, 3), axis=0)) > 100
    assert f"head&#x27;s path         {run.path_length:.4f} m" in text
    figure = run.plot()
    above, speed, torque = figure.axes[:3]
    np.testing.assert_array_equal(above.lines[-1].get_xdata(), run.position[:, 0])
    np.testing.assert_array_equal(speed.lines[0].get_ydata(), np.linalg.norm(run.twist[:, 3:], axis=1))
    np.testing.assert_array_equal(np.ravel(torque.collections[0].get_array()), run.torque[:, :, 2].T.ravel())


def test_a_run_without_a_wrench_shows_two_panels():
    bare = simulate(straight(), duration=0.2, scene=Scene(internal_wrench=False, ledger=False))
    assert len(bare.plot().axes) == 2 and "<img" in bare._repr_html_()


def test_a_batch_shows_its_paths_and_a_table_of_the_first():
    batch = simulate_batch([straight(period=0.5 + 0.1 * k) for k in range(12)], 0.5, accuracy="draft", estimate=False)
    _, text = shown(batch)
    assert "... and 2 more" in text and f"{batch.position[3, -1, 0]:+8.3f}" in text
    assert len(batch.plot().axes[0].lines) == 12


def test_a_body_shows_its_outlines_and_its_mass():
    body = Body.boyer2010()
    _, text = shown(body)
    assert "length 1 m, mass 1.944 kg, mean density 1000 kg/m^3" in text and "width at most" in text
    heavy = shown(body.changed(mass_per_length=2.0))[1]
    assert f"mass 2 kg, mean density {2.0 / body.volume:.4g} kg/m^3" in heavy
    assert max(
        np.max(line.get_ydata()) for line in body.plot().axes[0].lines if len(line.get_ydata()) > 2
    ) == pytest.approx(
        max(body.half_width(np.linspace(0, 1, 999)).max(), body.half_height(np.linspace(0, 1, 999)).max()), rel=1e-3
    )


def test_a_law_shows_its_curvature_over_a_period_after_its_ramps():
    law = falling()
    _, text = shown(law)
    assert "yaw   amplitude (1, 0.5, 2), wavelength 1 m, period 1 s" in text and len(law.plot().axes) == 1
    law = Law(Term(axis="yaw", amplitude=(1.0, 2.0), wavelength=0.5, period=0.4))
    lines = law.plot(length=2.0).axes[0].lines
    x = lines[0].get_xdata()
    assert x[-1] == 2.0
    for k, line in enumerate(lines):
        np.testing.assert_allclose(line.get_ydata(), law.curvature(0.4 * k / len(lines), x)[0][:, 2])
    assert "<img" in Law()._repr_html_()


def test_without_matplotlib_a_cell_has_its_numbers_and_plot_says_what_is_missing(run, monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert "<img" not in run._repr_html_() and "path" in run._repr_html_()
    with pytest.raises(ImportError, match="a picture needs matplotlib"):
        run.plot()


def test_the_text_of_a_cell_cannot_be_markup():
    def fails():
        raise ValueError

    assert cell_of(fails, "<b>") == "<pre style='line-height:1.3'>&lt;b&gt;</pre>"
