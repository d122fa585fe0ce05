# SPDX-License-Identifier: Apache-2.0
"""Fins that hold the roll: multipliers with the servo as a state, the window of area and gain, its command."""

import numpy as np
import pytest
from eel_dynamics.model.fins.text import fins_from_text
from eel_dynamics.runs.swim import Swim
from eel_studies.roll_hold.command import main
from eel_studies.roll_hold.study import PAIR, holding, roll_window, swum
from eel_studies.steering.period_map import turned_by

from eel_dynamics import Accuracy, Body, Fin, RollHold, Scene, simulate
from eel_gaits import straight, turning
from eel_studies import periodic_linearisation

COARSE = {"steps": 80, "resolution": 26.0, "estimate": False}
MIDDLE = fins_from_text(PAIR)


@pytest.mark.parametrize(
    ("fins", "periods"),
    [(holding(4e-3, 2.0), 14), (Fin.pair(0.3, 1e-3, 2.5, angle=RollHold(0.5, 0.1), time_constant=0.4), 12)],
    ids=["too much", "a slow servo"],
)
def test_a_disturbance_grows_as_it_does_in_a_swim(fins, periods):
    """The servo's angle is a state: a slow one would give another multiplier without it."""
    found = periodic_linearisation(straight(), fins=fins)
    assert found.error < 1e-3 and len(found.states) == len(found.multipliers) == 10
    run = simulate(
        found.law,
        periods * found.period,
        fins=fins,
        scene=Scene(internal_wrench=False, ledger=False),
        accuracy=Accuracy(name="period", resolution=40.0, step=found.period / 160),
        sample_period=found.period,
        orientation=turned_by(found.start.orientation, np.array([[1e-9, 0.0, 0.0]]))[0],
        twist=found.start.twist,
        estimate=False,
    )
    leaning = np.linalg.norm(run.orientation[:, :2], axis=1)
    assert leaning[-1] / leaning[-2] == pytest.approx(found.growth, rel=1e-3)


def test_fins_at_the_middle_hold_every_gait_and_fins_ahead_none():
    for law in (straight(), straight(period=2.0), straight(period=0.7), turning()):
        assert periodic_linearisation(law, fins=MIDDLE, **COARSE).growth < 0.85
    for area, k_p, growth in ((1e-3, 2.0, 1.29), (4e-3, 2.0, 2.92)):
        found = periodic_linearisation(straight(), fins=holding(area, k_p), **COARSE)
        assert found.growth == pytest.approx(growth, abs=0.02) and "pitch_rate" in found.motion_of(0)
    rolled, sunk, _ = swum(straight(), 40.0, MIDDLE, 0.05)
    assert rolled < 0.04 and sunk < 0.04


def test_weight_below_the_axis_and_fins_both_count():
    """A keel alone does not hold the roll of 1 Hz; with the fins it decays faster than with them alone, or with it."""
    body = Body.boyer2010().changed(centre_of_mass_offset=0.002)
    heavy = periodic_linearisation(straight(), body=body, scene=Scene(weight=True), **COARSE)
    both = periodic_linearisation(straight(), body=body, scene=Scene(weight=True), fins=MIDDLE, **COARSE)
    assert heavy.upright and heavy.growth > 1.2 and both.growth < 0.9
    assert np.count_nonzero(both.neutral) == 1 and "heading" in both.motion_of(int(np.flatnonzero(both.neutral)[0]))


def test_a_window_has_the_growth_of_its_points():
    swim = Swim(straight(), Body.boyer2010(), Scene(), 1e-3, fins=MIDDLE)
    window = roll_window(swim, {"fins.area": (4e-4, 4e-3), "fins.k_p": (1.0, 16.0)}, 3)
    assert window.growth.shape == (3, 3) and 1 <= window.held.sum() <= 8
    area, k_p = window.best.values()
    pair = Fin.pair(0.5, area, 2.5, angle=RollHold(k_p, 0.5), time_constant=0.05)
    assert periodic_linearisation(straight(), fins=pair, **COARSE).growth == pytest.approx(np.nanmin(window.growth))


def test_the_command_tells_growth_and_window(tmp_path, capsys):
    assert main(["straight", "--points", "2", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "growth" in told and "of the window" in told and (tmp_path / "roll_hold.png").stat().st_size > 5_000
    fins = "pair station=0.3 area=0.001 aspect_ratio=2 angle=0.1"
    assert main(["straight", "--fins", fins, "--points", "2", "--out", str(tmp_path)]) == 2
    assert "fins must hold the roll (k_p, k_d)" in capsys.readouterr().err
    assert main(["straight", "--over", "fins.area=1:2", "--out", str(tmp_path)]) == 2
    assert "over must be two numbers" in capsys.readouterr().err


def test_fins_that_follow_a_table_do_not_repeat():
    fins = [Fin(0.5, "left", 1e-3, 2.5, angle=([0.0, 1.0], [0.0, 0.2]))]
    with pytest.raises(ValueError, match="fins must have an angle that stays"):
        periodic_linearisation(straight(), fins=fins)
