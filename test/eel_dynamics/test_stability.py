"""The command `stability`: its maps hold what was swum, its page what was measured, and bad input is one line."""

import numpy as np
import pytest
from eel_dynamics.stability import command
from eel_dynamics.stability.explicit import inertias, treat
from eel_dynamics.stability.maps import INACCURATE, STOPPED, TARGET, maps_of, measure

from eel_dynamics import Body


def test_maps_keep_the_target_and_tell_what_stops():
    measured = {item.name: measure(item) for item in maps_of(2)}
    for name in ("gait", "wave", "water", "body"):
        assert measured[name].worst < TARGET and not (measured[name].outcome == STOPPED).any(), name
    step = measured["step"]
    assert (step.outcome[:, 0] != STOPPED).all() and (step.error[:, 0] < TARGET).all()  # a hundredth of a period
    assert set(step.outcome[:, 1]) <= {STOPPED, INACCURATE} and STOPPED in step.outcome[:, 1]  # a whole period
    text = command.report(list(measured.values()))
    assert "energy from nowhere" in text
    page = command.with_maps(f"a\n{command.BEGIN}\nold\n{command.END}\nb", text, list(measured.values()))
    assert text in page and "old" not in page and page.endswith("\nb") and page.startswith("a\n")


def test_an_explicit_added_mass_blows_up_where_water_outweighs_the_body():
    own, water = inertias(Body.boyer2010(), 1000.0, 1000.0)
    assert own[4, 4] == pytest.approx(1.944, rel=1e-3)  # kg
    assert water[4, 4] == pytest.approx(4.998, rel=1e-3)
    assert np.allclose(own, own.T) and np.linalg.eigvalsh(own + water).min() > 0.0
    assert treat(1.0).growth > 1.0 and treat(1.0).explicit > 1e6
    heavy = treat(10.0)
    assert heavy.growth < 1.0 and heavy.explicit == pytest.approx(1.0, abs=1e-3)
    assert all(treat(ratio).condition < 1e4 for ratio in (1e-3, 1.0, 1e3))


def test_bad_input_is_one_line(tmp_path, capsys):
    assert command.main(["--points", "1", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == "stability: points must be >= 2, got 1\n"
