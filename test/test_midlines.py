# SPDX-License-Identifier: Apache-2.0
"""The command `midlines`: the midlines that a swim makes, laid on those of its file."""

import re

import numpy as np
from eel_studies.midlines.command import laid_on
from eel_studies.midlines.command import main as midlines
from midline_files import kern_midline, write_midlines


def test_the_midlines_that_come_out_are_those_that_went_in(tmp_path, capsys):
    path = write_midlines(tmp_path / "fish.csv", kern_midline, end=2.0)
    assert midlines(["--out", str(tmp_path / "fish.png"), str(path)]) == 0
    told = capsys.readouterr().out
    apart = float(re.search(r"midlines +([0-9.]+)% of the body's length apart", told)[1])
    assert 0.0 < apart < 0.3 and (tmp_path / "fish.png").read_bytes().startswith(b"\x89PNG")
    assert midlines([str(path), "--out", "fish.txt"]) == 2 and "--out must end in" in capsys.readouterr().err


def test_a_rigid_motion_is_removed_and_a_mirror_image_is_not():
    draw = np.random.default_rng(0)
    points = draw.normal(size=(2, 9, 3))
    turn = np.linalg.qr(draw.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    assert np.allclose(laid_on(points @ turn + 0.3, points), points)
    assert np.max(np.abs(laid_on(points * [1.0, 1.0, -1.0], points) - points)) > 0.1
