# SPDX-License-Identifier: Apache-2.0
"""Robots by the log of their joints: a known swim comes out, with its bands."""

import csv

import numpy as np
import pytest
from eel_studies.replay.band import replay, robot_body, with_factors
from eel_studies.replay.command import main as replay_joints

from eel_dynamics import Scene, simulate
from eel_gaits import Law, Ramp, Term

LINKS, HALF_HEIGHT, HALF_WIDTH = 8, 0.05, 0.02
LENGTH = 0.1 * LINKS
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
    body = robot_body(LENGTH, HALF_HEIGHT, HALF_WIDTH)
    scene = Scene(planar=True, friction="blended")
    known = simulate(WAVE, 5.98, body=body, scene=scene, accuracy=1e-3)
    out = tmp_path / "out.csv"
    arguments = [str(log), "--links", "0.1x8", "--section", f"{HALF_HEIGHT},{HALF_WIDTH}", "--accuracy", "1e-2"]
    assert replay_joints([*arguments, "--samples", "4", "--speed", "0.5", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    speed = float(next(line for line in printed.splitlines() if line.startswith("mean speed")).split()[5])
    assert speed == pytest.approx(known.mean_speed, rel=0.03)
    assert "0.5: " in printed and "lateral_added_mass" in printed
    with out.open() as file:
        rows = list(csv.DictReader(file))
    last = {name: float(value) for name, value in rows[-1].items()}
    assert last["x_low"] <= last["x"] <= last["x_high"] and last["x_low"] < last["x_high"]
    assert {f"torque_{joint}_high" for joint in range(1, LINKS)} <= set(last)


def test_factors_keep_the_mass_and_change_the_drag():
    body = robot_body(1.0, 0.05, 0.04)
    wide = with_factors(body, {"half_width": 1.1, "lateral_drag": 0.5})
    assert wide.mass == pytest.approx(body.mass) and wide.lateral_drag == 0.5 * body.lateral_drag
    assert wide.half_width(0.5) == pytest.approx(1.1 * body.half_width(0.5))


def test_friction_and_added_mass_by_factors_act_as_they_say():
    body, scene = robot_body(LENGTH, HALF_HEIGHT, HALF_WIDTH), Scene(planar=True, friction="laminar")
    still = Law(Term(amplitude=(0.0,), period=1.0))
    glide = {"scene": scene, "accuracy": 1e-3, "twist": (0.0, 0.0, 0.0, 0.5, 0.0, 0.0)}
    lost = [
        0.5 - simulate(still, 0.2, body=body.changed(friction_factor=factor, nose_drag=0.0), **glide).twist[-1, 3]
        for factor in (1.0, 2.0)
    ]
    assert lost[1] == pytest.approx(2.0 * lost[0], rel=0.03)
    high = np.sqrt(2.0) * body.arguments["half_height"]  # an ellipse of twice the added mass, at the same mass
    flat = body.changed(half_height=high, density=body.density / np.sqrt(2.0))
    dry = {"scene": Scene(planar=True, resistive=False, nose=False), "accuracy": 1e-4, "stations": 5}
    heavy = simulate(WAVE, 2.0, body=body.changed(lateral_added_mass=2.0), **dry)
    assert np.allclose(heavy.position, simulate(WAVE, 2.0, body=flat, **dry).position, atol=1e-4)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"--links": "0.1x7"}, "--links must be 8 lengths for 7 joints, got 7"),
        ({"--links": "a"}, "--links must be lengths"),
        ({"--section": "0.05"}, "--section must be half-height,half-width"),
        ({"--vary": "lateral_drag=2"}, "--vary must be NAME=LOW:HIGH"),
        ({"--vary": "colour=1:2"}, "must be one of the body's, got 'colour'"),
        ({"--topic": "joints"}, "--topic belongs to a bag"),
        ({"--body": "boyer2010"}, "one of --body and --section"),
    ],
)
def test_what_does_not_fit_is_told(log, change, words, capsys):
    options = {"--links": "0.1x8", "--section": "0.05,0.02"} | change
    assert replay_joints([str(log), *(word for pair in options.items() for word in pair)]) == 2
    assert words in capsys.readouterr().err


def test_a_number_that_is_no_factor_is_refused(log):
    body = robot_body(LENGTH, HALF_HEIGHT, HALF_WIDTH)
    with pytest.raises(ValueError, match="factors of nose_drag must rise from 0"):
        replay(WAVE, body, np.array([0.1]), Scene(planar=True), uncertain={"nose_drag": (2.0, 1.0)})
