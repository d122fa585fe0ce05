# SPDX-License-Identifier: Apache-2.0
"""The study of a swimmer behind a cylinder: its street, its measures, its page."""

from pathlib import Path

import numpy as np
import pytest
from eel_dynamics.accuracy.accuracy import Accuracy
from eel_studies.drafting import command, study
from eel_studies.drafting.study import Wake, swim
from eel_studies.points import SwimSettings, base_point, batch_of_points, point_at

from eel_dynamics import Uniform, VortexStreet

PAGE = Path(__file__).resolve().parents[3] / "docs" / "explanation" / "drafting.md"


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(study, "SETTLE", 3)
    monkeypatch.setattr(study, "MEASURED", 2)


def test_the_street_is_von_karman_s():
    """The rows carry each other at half of circulation / spacing, times a tanh; that is the water's mean in between."""
    wake = Wake(speed=0.8, spacing=1.2)
    x = np.linspace(10.0, 11.2, 241)[:-1]
    water = wake.flow(0.3).sample(np.stack([x, 0 * x, 0 * x], axis=1))
    assert water.velocity[:, 0].mean() == pytest.approx(wake.mean, rel=0.02)  # of a street that ends
    assert abs(water.velocity[:, 1].mean()) < 5e-3
    assert wake.circulation / (2 * wake.spacing) * np.tanh(np.pi * study.WIDTH) == pytest.approx(
        study.FOLLOWING * wake.speed, rel=1e-3
    )
    assert wake.diameter * (1 - study.FOLLOWING) / study.STROUHAL / wake.diameter == pytest.approx(4.25)


def test_uniform_water_carries_the_swimmer_along_at_the_same_power(short, monkeypatch):
    monkeypatch.setattr(study, "SETTLE", 14)
    still, carried = swim(None), swim(Uniform((0.3, 0.0, 0.0)))
    assert carried.speed - 0.3 == pytest.approx(still.speed, rel=1e-2)  # it starts against the water
    assert carried.power == pytest.approx(still.power, rel=5e-2)


def test_the_command_writes_table_picture_and_numbers(short, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "SPACINGS", (1.0, 2.0))
    page = tmp_path / "drafting.md"
    page.write_text(PAGE.read_text())
    assert command.main(["--phases", "1", "--page", str(page), "--out", str(tmp_path)]) == 0
    assert "spacing 1 m: cylinder 0.24 m" in capsys.readouterr().out
    text = page.read_text()
    assert (tmp_path / "drafting.png").is_file() and "![Behind a cylinder](drafting.png)" in text
    table = page.with_name("drafting.csv").read_text()
    assert "1,0.24,0.12," in table and "2,0.47,0.24," in table
    assert command.main(["--phases", "0"]) == 2


def test_a_sweep_varies_the_numbers_of_a_flow():
    base = base_point(None, None, Accuracy.of("draft"))
    flow = "vortex_street core=0.3"
    point = point_at({"flow.spacing": 2.0, "period": 0.9}, "straight", {"flow": flow}, base)
    assert point.flow == VortexStreet(core=0.3, spacing=2.0)
    with pytest.raises(ValueError, match="flow has no field 'width_'"):
        point_at({"flow.width_": 2.0}, "straight", {"flow": flow}, base)
    with pytest.raises(ValueError, match="flow must be one built-in flow for spacing to change, got"):
        point_at({"flow.spacing": 2.0}, "straight", {}, base)
    point = point._replace(duration=1.0, sample_period=0.25, stations=2)
    swims = batch_of_points([point, point._replace(flow=None)], SwimSettings(("mean_speed",), False))
    assert not np.allclose(swims.position[0], swims.position[1])
