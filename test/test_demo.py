# SPDX-License-Identifier: Apache-2.0
"""What makes the demo fail: the ledger and the closure of the run whose messages came."""

from types import SimpleNamespace

import numpy as np
import plain_picture
import pytest
from demo import DemoError, diagnostics, failures
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_dynamics.runs.exchange.recorded_run import fields_of_messages
from eel_gaits.ros.messages import law_to_message
from matplotlib.figure import Figure

from eel_dynamics import Run, simulate
from eel_gaits import falling


@pytest.fixture(scope="module")
def run():
    return simulate(falling(), 3.0, sample_period=0.02, estimate=False)


def recorded(run, residual=1e-4):
    """The run of the messages, with a ledger that is off by so much of the work."""
    messages = [each for each in messages_of_run(run) if each[0] != "curvature_law"]
    for topic, message in messages:
        if topic == "energy":
            message.residual = residual * run.energy.actuator_work[-1]
    messages.append(("curvature_law", law_to_message(run.law)))
    return Run(**fields_of_messages(messages, None, None))


def told(run, closure=1e-14):
    """Diagnostics of a closure that is off by so much of the greatest values."""
    sizes = {name: closure * np.linalg.norm(getattr(run, name), axis=2).max() for name in ("force", "torque")}
    values = {"samples_published": len(run.time)} | {f"closure_{name}": size for name, size in sizes.items()}
    pairs = [SimpleNamespace(key=key, value=str(value)) for key, value in values.items()]
    return diagnostics([("diagnostics", SimpleNamespace(status=[SimpleNamespace(values=pairs)]))])


def test_a_sound_run_has_no_failure(run):
    assert failures(recorded(run), told(run)) == []


@pytest.mark.parametrize("residual", [1.1e-3, np.nan])
def test_a_ledger_that_does_not_close_is_a_failure(run, residual):
    assert "residual" in failures(recorded(run, residual), told(run))[0]


@pytest.mark.parametrize("closure", [1.1e-10, np.nan])
def test_a_wrench_that_does_not_close_is_a_failure(run, closure):
    assert [each.split(",")[0] for each in failures(recorded(run), told(run, closure))] == [
        "closure of the force",
        "closure of the torque",
    ]


def test_the_picture_without_a_viewer_has_two_views_with_body_and_path(run, tmp_path):
    run.to_rerun(tmp_path / "run.rrd")
    figure = Figure(figsize=plain_picture.SIZE)
    plain_picture.draw_body(figure, tmp_path / "run.rrd")
    for axes, (name, along, up) in zip(figure.axes, (("from the side", 0, 2), ("from above", 0, 1)), strict=True):
        assert axes.get_title(loc="left").startswith(name)
        np.testing.assert_allclose(axes.lines[0].get_xydata(), run.position[:, [along, up]])
        (bodies,) = axes.collections
        corners = np.concatenate([path.vertices for path in bodies.get_paths()])
        assert np.ptp(corners[:, 0]) > 0.9 and axes.get_aspect() == 1.0
    assert [text.get_text() for text in figure.axes[0].texts] == [f"head, {each} s" for each in (1.2, 1.7, 2.4, 2.9)]
    plain_picture.draw_plain(tmp_path / "run.rrd", tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 50_000


def test_missing_diagnostics_are_an_error():
    with pytest.raises(DemoError, match="diagnostics"):
        diagnostics([])
