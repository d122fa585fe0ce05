# SPDX-License-Identifier: Apache-2.0
"""Sweeps of gaits that settle: each point swims until its gait has settled. Points that never settle are counted."""

import pytest
from eel_studies.sweeps import command

from eel_dynamics import Unsettled
from eel_studies import sweep

COARSE = {"accuracy": 1e-2, "stations": 5}


def test_a_sweep_swims_each_point_until_it_has_settled():
    data = sweep({"period": [0.5, 1.0]}, **COARSE)
    assert data.attrs["duration"] == "settled" and (data.settled == 1.0).all()
    assert float(data.duration[0]) < float(data.duration[1])
    with pytest.warns(Unsettled, match="2 of 2 points have not settled"):
        short = sweep({"period": [0.5, 1.0]}, duration=2.0, measure="mean_speed", **COARSE)
    assert (short.settled == 0.0).all()
    with pytest.raises(ValueError, match="duration 'settled' needs a gait that repeats"):
        sweep({"scene.viscosity": [1e-6]}, gait="still", **COARSE)


def test_the_command_tells_how_many_points_have_not_settled(tmp_path, capsys):
    words = f"straight --vary period=0.5,0.6 --accuracy 1e-2 --duration 1 --out {tmp_path / 'short.nc'}"
    assert command.main(words.split()) == 0
    assert capsys.readouterr().err.splitlines()[-1] == "eel sweep: warning: 2 of 2 points have not settled"
