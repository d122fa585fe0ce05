# SPDX-License-Identifier: Apache-2.0
"""External wrenches in files, batches and texts, and which are refused."""

import numpy as np
import pytest
from eel_dynamics.model.wrenches.text import text_of_wrenches, wrenches_from_text
from random_robots import drawn
from test_blunt_robots import differences
from wrench_cases import RIPPLE

from eel_dynamics import (
    ExternalWrench,
    Run,
    Scene,
    Simulation,
    load_scene,
    save_scene,
    simulate,
    simulate_batch,
)
from eel_gaits import straight

TABLE = ExternalWrench(0.5, time=(0.2, 0.2, 0.4), force=((0, 0, 0), (1, 0, 0), (0, 1, 0)), torque=(0, 0, 0.01))


def test_runs_are_saved_swum_again_and_alike_in_batches(tmp_path):
    options = {"accuracy": 1e-3, "estimate": False, "sample_period": 0.1, "stations": 11}
    each = [None, [TABLE], [ExternalWrench(1.0, (0.2, 0.0, 0.0), frame="world")]]
    alone = [simulate(straight(), 0.5, wrenches=wrenches, **options) for wrenches in each]
    batch = simulate_batch(straight(), 0.5, wrenches=each, **options)
    for one, many in zip(alone, batch, strict=True):
        assert differences(one, many) == [] and one.wrenches == many.wrenches
    alone[1].save(tmp_path / "run.nc")
    kept = Run.load(tmp_path / "run.nc")
    assert kept == alone[1] and kept.wrenches == (TABLE,)
    own = {name: getattr(kept, name) for name in ("body", "scene", "flow", "robot", "fins", "wrenches")}
    assert differences(simulate(kept.law, 0.5, **own, **options), kept) == []
    batch.save(tmp_path / "batch.nc")
    assert type(batch).load(tmp_path / "batch.nc") == batch
    with pytest.raises(ValueError, match=r"external wrench at 1 m has no text: it is a function"):
        simulate(straight(), 0.2, wrenches=[ExternalWrench(1.0, **RIPPLE)], **options).save(tmp_path / "none.nc")


def test_the_text_of_wrenches_is_read_again(tmp_path):
    text = "section station=0 force=2,0,0 + world station=1 force=0,0,1;0,0,3 time=0,5 + section station=0.5"
    wrenches = wrenches_from_text(text)
    assert wrenches == (
        ExternalWrench(0.0, (2.0, 0.0, 0.0)),
        ExternalWrench(1.0, ((0, 0, 1), (0, 0, 3)), frame="world", time=(0, 5)),
        ExternalWrench(0.5),
    )
    once = ExternalWrench(0.2, force=((1.0, 2.0, 3.0),), time=(1.0,))
    for each in (wrenches, (TABLE,), (once,), ()):
        assert wrenches_from_text(text_of_wrenches(each)) == each
    path = tmp_path / "swim.yaml"
    path.write_text(f"/**: {{ros__parameters: {{gait: straight, wrenches: '{text}'}}}}")
    swim = load_scene(path)
    assert swim.wrenches == wrenches == swim.simulation().wrenches
    save_scene(swim, tmp_path / "again.yaml")
    assert load_scene(tmp_path / "again.yaml").wrenches == wrenches


NOT = [
    ({"station": -0.1}, "external wrench station must be >= 0 m, got -0.1"),
    ({"station": np.nan}, "external wrench station must be finite"),
    ({"force": (1.0, np.nan, 0.0)}, "external wrench force must be finite, got nan at index 1"),
    ({"torque": (1.0, 0.0)}, "external wrench torque must be 3 numbers"),
    ({"force": "up"}, "external wrench force must be real numbers"),
    ({"frame": "head"}, "external wrench frame must be one of section, world, got 'head'"),
    ({"force": ((1, 2, 3), (4, 5, 6))}, "external wrench force must have a row for each time, 0, got 2"),
    ({"time": (0, 1), "force": ((1, 2, 3),)}, "external wrench force must have a row for each time, 2, got 1"),
    ({"time": (1, 0), "force": ((1, 2, 3), (4, 5, 6))}, "external wrench time must be 1 to 100000 instants that do"),
    ({"time": (0, 1)}, "external wrench time goes with rows of force or torque, got neither"),
    ({"time": (1, 1, 1), "force": np.ones((3, 3))}, "external wrench time may have an instant twice, got 1 s thrice"),
    ({"time": (0, 1), "force": ((1, 2, 3), (4, 5, np.inf))}, r"external wrench force\[1\] must be finite"),
]


@pytest.mark.parametrize(("fields", "message"), NOT)
def test_a_wrench_that_does_not_fit_is_refused(fields, message):
    with pytest.raises(ValueError, match=message):
        ExternalWrench(**{"station": 0.5} | fields)


def test_a_wrench_off_the_body_or_the_plane_is_refused():
    plane = Scene(planar=True)
    for how, wrenches, message in (
        ({}, [ExternalWrench(1.2)], "external wrench station must lie on the body, 0 to 1 m, got 1.2 m"),
        ({"scene": plane}, [ExternalWrench(0.5, (0, 0, 1))], "force must be along x and y alone in a planar scene"),
        ({"scene": plane}, [ExternalWrench(0.5, torque=(0, 1, 0))], "torque must be along z alone in a planar scene"),
        ({}, ExternalWrench(0.5), "wrenches must be a list of ExternalWrench"),
        ({}, [0.5], "external wrench must be a ExternalWrench, got 0.5"),
    ):
        with pytest.raises(ValueError, match=message):
            Simulation(law=straight(), wrenches=wrenches, **how)
    simulation = Simulation(law=straight(), scene=plane)
    before = simulation.observe().whole
    for arguments, message in (
        ((2.0, (1, 0, 0)), "station must lie on the body"),
        ((0.5, (1, 0, 1)), "force must be along x and y alone"),
        ((0.5, (1, np.nan, 0)), "force must be finite"),
        ((0.5, lambda t: (1, 0, 0)), "applied force and torque must be three numbers, got a function"),
    ):
        with pytest.raises(ValueError, match=message):
            simulation.apply_wrench(*arguments)
    assert np.array_equal(simulation.observe().whole, before)


@pytest.mark.parametrize("robot", [None, drawn(3).robot])
def test_a_function_that_gives_no_wrench_ends_the_march_where_it_is(robot):
    bad = ExternalWrench(0.5, force=lambda t: (1.0, 0.0) if t > 0.25 else (1.0, 0.0, 0.0))
    simulation = Simulation(law=straight(), robot=robot, wrenches=[bad], accuracy="draft")
    simulation.advance(0.2)
    with pytest.raises(ValueError, match=r"external wrench force at 0\.\d+ s must be 3 numbers, got 2"):
        simulation.advance(1.0)
    assert 0.2 <= simulation.time < 0.3
