# SPDX-License-Identifier: Apache-2.0
"""Robots by the log of their joints: a known swim comes out of `eel simulate --joints`."""

import re
from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.commands.simulate import main

from eel_dynamics import Body, Run, Scene, simulate
from eel_gaits import Law, Ramp, Term

LINKS, HALF_HEIGHT, HALF_WIDTH = 8, 0.05, 0.02
LENGTH = 0.1 * LINKS
BODY = Body.of_links(LENGTH, LINKS, HALF_WIDTH, HALF_HEIGHT, joints="flush")
WAVE = Law(
    Term(
        amplitude=(0.0, 3.0, 3.0, 0.0),
        knots=(0.0, 0.25, 0.6, LENGTH),
        wavelength=0.8,
        period=0.8,
        envelope=(Ramp(0.0, 0.8, 1.0),),
    )
)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A log of joint angles of the wave: of the curvature over the parts around the joints."""
    path, time = tmp_path_factory.mktemp("log") / "log.csv", np.arange(0.0, 6.0, 0.02)
    fine = np.linspace(0.0, LENGTH, 801)
    rows = []
    for t in time:
        bend = np.interp(
            np.linspace(0.05, LENGTH - 0.05, LINKS), fine, np.cumsum(WAVE.curvature(t, fine)[0][:, 2]) * 1e-3
        )
        rows.append(f"{t:.2f}," + ",".join(f"{angle:.5f}" for angle in np.diff(bend)))
    path.write_text("\n".join(["time," + ",".join(f"yaw_{j}" for j in range(1, LINKS)), *rows]) + "\n")
    return path


def test_a_chain_of_links_swims_as_the_body_that_it_stands_for(log, tmp_path, capsys):
    known = simulate(WAVE, 5.98, body=BODY, scene=Scene(planar=True, friction="blended"), accuracy=1e-3)
    out = tmp_path / "out.nc"
    arguments = ["--joints", str(log), "--links", "0.1x8", "--section", f"{HALF_HEIGHT},{HALF_WIDTH}", "--mass", "2.5"]
    arguments += ["--joint-drag", "flush"]
    arguments += ["--scene", "planar=on", "--scene", "friction=blended", "--accuracy", "1e-2", "--out", str(out)]
    assert main(arguments) == 0
    printed = capsys.readouterr().out
    assert "angles of 7 joints of 'log.csv'" in printed and "8 links, 0.8 m, 2.5 kg" in printed
    run = Run.load(out)
    assert run.mean_speed == pytest.approx(known.mean_speed, rel=0.05)
    assert run.body.mass == pytest.approx(2.5) and f"{run.time[-1]:g}" == "5.98"
    assert float(re.search(r"torque of a joint   greatest ([0-9.]+) N m, RMS", printed)[1]) > 0.0


def test_friction_and_added_mass_by_factors_act_as_they_say():
    body = BODY.changed(round_added_mass=1.0, lateral_drag=1.98, vertical_drag=1.0)
    scene = Scene(planar=True, friction="laminar")
    still = Law(Term(amplitude=(0.0,), period=1.0))
    glide = {"scene": scene, "accuracy": 1e-3, "twist": (0.0, 0.0, 0.0, 0.5, 0.0, 0.0)}
    bare = body.changed(nose_drag=0.0, base_drag=0.0)
    lost = [
        0.5 - simulate(still, 0.2, body=bare.changed(friction_factor=factor), **glide).twist[-1, 3]
        for factor in (1.0, 2.0)
    ]
    assert lost[1] == pytest.approx(2.0 * lost[0], rel=0.03)
    high = replace(body.arguments["half_height"], size=np.sqrt(2.0) * HALF_HEIGHT)  # twice the added mass
    flat = body.changed(half_height=high, density=body.density / np.sqrt(2.0))
    dry = {"scene": Scene(planar=True, resistive=False, nose=False), "accuracy": 1e-4, "stations": 5}
    heavy = simulate(WAVE, 2.0, body=body.changed(lateral_added_mass=2.0), **dry)
    assert np.allclose(heavy.position, simulate(WAVE, 2.0, body=flat, **dry).position, atol=1e-4)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"--links": "0.1x7"}, "--links must be 8 lengths for 7 joints, got 7"),
        ({"--links": "0.1x1000000000000000000"}, "--links must be 8 lengths for 7 joints, got 1000000000000000000"),
        ({"--links": "0.1x9,0.1x-1"}, "--links must be lengths"),
        ({"--links": "a"}, "--links must be lengths"),
        ({"--section": "0.05"}, "--section must be half-height,half-width"),
        ({"--topic": "joints"}, "--topic belongs to a bag"),
        ({"--body": "boyer2010"}, "one of --body and --section"),
        ({"--units": "gon"}, "gon"),
        ({"--joint-drag": "loose"}, "joints must be flush, or the drag coefficient of a link by itself, 0"),
        ({"--time": "9"}, "the time must name columns among the 8 of the file, each once, got '9'"),
        ({"--clock": "1000"}, "rad/s (RMS) in steps of 20 s: time in s?"),
        ({"--clock": "0"}, "--clock must be > 0, got 0"),
        ({"--rate": "5"}, "belong to --midlines, which is not given"),
        ({"--sequence": "patrol.yaml"}, "--joints takes the place of a gait, got '--sequence' too"),
    ],
)
def test_what_does_not_fit_is_told(log, change, words, capsys):
    options = {"--joints": str(log), "--links": "0.1x8", "--section": "0.05,0.02", "--joint-drag": "0"} | change
    assert main([word for pair in options.items() for word in pair]) == 2
    assert words in capsys.readouterr().err


def test_options_of_a_log_need_one(capsys):
    assert main(["straight", "--links", "0.1x8"]) == 2
    assert "belong to --joints, which is not given" in capsys.readouterr().err
    assert main(["straight", "--time", "t"]) == 2
    assert "--time belongs to --midlines, --joints or --file" in capsys.readouterr().err
