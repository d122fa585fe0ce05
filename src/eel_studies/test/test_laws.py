# SPDX-License-Identifier: Apache-2.0
"""Laws of swimming: what of them follows from the theory itself comes out of small cases."""

import numpy as np
import pytest
from eel_studies.laws import laws
from eel_studies.laws.command import main as hold_against


def test_little_is_shed_where_the_swimmer_is_nearly_as_fast_as_its_wave(monkeypatch):
    monkeypatch.setattr(laws, "OF_SLIP", np.array([1e-4, 1e-8]))
    monkeypatch.setattr(laws, "BENDS", (0.1, 1.0))
    found = laws.lighthill()
    for points in found.ours.values():
        slip, kept = points.T
        assert slip[1] > slip[0] and kept[1] > kept[0]
        assert np.all(kept - 0.5 * (1.0 + slip) < 0.01)  # Lighthill's greatest; its next term takes something off
        assert np.all(kept - 0.5 * (1.0 + slip) > -0.15)
    assert len(found.table.rows) == 2


def test_drag_like_the_square_of_the_speed_makes_re_grow_like_sw(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(laws, "VISCOSITIES", np.logspace(-3.0, -6.0, 6))
    monkeypatch.setattr(laws, "LAMINAR", (1e2, 3e4))
    monkeypatch.setattr(laws, "TURBULENT", (3e4, 1e7))
    out = tmp_path / "gazzola.csv"
    assert hold_against(["gazzola", "--out", str(out)]) == 0
    printed = [line for line in capsys.readouterr().out.splitlines() if line.startswith("exponent")]
    assert float(printed[0].split()[-1]) > 1.05 and float(printed[1].split()[-1]) == pytest.approx(1.0, abs=0.06)
    assert out.read_text().startswith(",measured,ours")


def test_a_law_that_there_is_not_is_told(capsys):
    with pytest.raises(SystemExit):
        hold_against(["newton"])
    assert "gazzola" in capsys.readouterr().err
