# SPDX-License-Identifier: Apache-2.0
"""`Run.to_rerun`: bit by bit what the visualiser makes of the node's own messages of the same run."""

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from eel_common.version import software
from eel_dynamics.commands.simulate import main
from eel_dynamics.ros.messages import SampleMessages, body_message, diagnostic_array
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_dynamics.runs.storage.plain import law_of
from eel_viz.recording.dispatcher import READERS
from eel_viz.recording.reading import read
from rclpy.serialization import deserialize_message

from eel_dynamics import Body, Run, Scene, simulate
from eel_gaits import falling, straight
from eel_msgs.msg import CurvatureLaw
from eel_viz import entities

PROFILES = ("backbone", "section_orientation", "curvature", "curvature_rate", "torque", "force", "fluid_force")
PROFILES += ("resistive_force", "tail_force", "nose_force", "wake_momentum_rate", "position", "orientation", "twist")


@pytest.fixture(scope="module")
def run():
    return simulate(falling(), duration=1.0, sample_period=0.02, load=True)


def node_messages(run, statuses):
    """Topics and ROS messages, as the node fills and sends them."""
    yield "body", body_message(run, "section")
    yield "curvature_law", CurvatureLaw(name=run.law.name)
    yield "diagnostics", statuses[0]
    swimmer = SimpleNamespace(x=run.x, scene=run.scene, head_errors=None, flow=None, robot=None, fins=())
    sample = SampleMessages(swimmer, DynamicsParameters())
    for k, time in enumerate(run.time):
        sample.set_time(round(time * 1e9))
        energy = SimpleNamespace(**{name: run.energy[name][k] for name in run.energy.keys()})  # noqa: SIM118
        snapshot = SimpleNamespace(energy=energy, **{name: getattr(run, name)[k] for name in PROFILES})
        for topic, kind in sample.kinds.items():
            if topic in READERS:  # those that the visualiser shows
                yield topic, deserialize_message(sample.fill(topic, snapshot), kind)
    yield "diagnostics", statuses[1]


def test_it_is_what_the_visualiser_makes_of_the_nodes_messages(run, tmp_path):
    from compared import contents, differences
    from eel_viz.recording.library import to_rerun

    worst = {
        "energy_residual_worst": float(np.abs(run.energy.residual).max()),
        "closure_torque_relative": float(run.closure_torque.max() / np.abs(run.torque).max()),
    }
    told = {"law": "falling", "accuracy": "standard"}
    statuses = [
        diagnostic_array(0.0, "/simulate", 0, "computed", told),
        diagnostic_array(1.0, "/simulate", 0, "computed", told | worst),
    ]
    run.to_rerun(tmp_path / "run.rrd")
    to_rerun(tmp_path / "messages.rrd", [node_messages(run, statuses)], ["falling standard"])
    assert differences(tmp_path / "run.rrd", tmp_path / "messages.rrd", texts=True) == []
    found = contents(tmp_path / "run.rrd")
    assert len(found) > 200
    assert len(found["/numbers/hydrodynamic_load", "HydrodynamicLoad:force_2"][0]) == 51


def test_numbers_are_those_of_the_run(run, tmp_path):
    from eel_viz.recording.reading import read

    from eel_viz import entities

    run.to_rerun(str(tmp_path / "run.rrd"), skin_rate=10.0, blueprint="torques")
    position = read(tmp_path / "run.rrd", entities.POSITION)
    np.testing.assert_array_equal(position.time, np.round(run.time, 9))
    np.testing.assert_array_equal(position["scalars"], run.position)
    wrench = read(tmp_path / "run.rrd", entities.WRENCH_NUMBERS)
    np.testing.assert_array_equal(wrench["torque_3"], run.torque[:, :, 2])
    np.testing.assert_array_equal(read(tmp_path / "run.rrd", entities.RESIDUAL)["scalars"][:, 0], run.energy.residual)
    assert len(read(tmp_path / "run.rrd", entities.SKIN)["vertex_positions"]) == 11  # 10 Hz
    text = read(tmp_path / "run.rrd", entities.RUN)["text"][-1][0]
    assert "accuracy standard" in text
    assert "worst residual" in text


def properties(path, group):
    found = read(path, f"/__properties/{group}", static=True)
    return {name: rows[-1][0] for name, rows in found.values.items()}


def test_a_recording_says_what_it_is_of(tmp_path):
    swim = simulate(straight(period=0.5), duration=3.0, accuracy=1e-3, scene=Scene(friction="laminar", density=500.0))
    swim.to_rerun(tmp_path / "swim.rrd", load=False, numbers={"colour": "red", "trial": 3})
    of = partial(properties, tmp_path / "swim.rrd")
    assert of("numbers") == {"colour": "red", "trial": 3.0}
    assert of("swim")["gait"] == "straight" and of("swim")["duration"] == 3.0
    assert of("swim")["version"] == software()
    assert law_of(json.loads(of("law")["json"])) == swim.law and of("law")["period"] == 0.5
    half = pytest.approx(0.5 * Body.boyer2010().mass)  # the mass that swam
    assert of("body")["length"] == 1.0 and of("body")["mass"] == half == dict(messages_of_run(swim))["body"].mass
    assert of("scene")["friction"] == "laminar" and of("scene")["wake"] is True
    assert of("accuracy")["target"] == 1e-3
    assert of("error_estimate")["position"] == swim.error_estimate.position
    assert of("ledger")["actuator_work"] == swim.energy.actuator_work[-1]
    assert of("measures")["cost_of_transport"] == swim.analysis().cost_of_transport
    assert of("diagnostics")["closure_torque_relative"] < 1e-9


def test_entities_of_others_may_be_in_the_named_frames(run, tmp_path):
    run.to_rerun(tmp_path / "run.rrd")
    for path, parent, child in (
        (f"{entities.WORLD}/frames", "tf#/world", "odom"),
        (f"{entities.HEAD}/frame", "tf#/world/eel/head", "base_link"),
    ):
        frame = read(tmp_path / "run.rrd", path, static=True).values
        assert (frame["parent_frame"][0], frame["child_frame"][0]) == ([parent], [child])


def test_a_stream_of_the_caller_s_stays_open(run, tmp_path):
    import rerun as rr
    from eel_viz.recording.reading import read

    from eel_viz import entities

    stream = rr.RecordingStream("mine")
    stream.save(str(tmp_path / "mine.rrd"))
    run.to_rerun(stream)
    stream.log("/mine", rr.TextLog("after it"), static=True)
    stream.flush()
    stream.disconnect()
    assert read(tmp_path / "mine.rrd", "/mine", static=True)["text"][0][0] == "after it"
    np.testing.assert_array_equal(read(tmp_path / "mine.rrd", entities.SPEED).time, np.round(run.time, 9))


def test_two_runs_are_laid_over_each_other(run, tmp_path):
    from eel_viz.recording.reading import read

    from eel_viz import entities

    other = simulate(falling(), duration=1.0, sample_period=0.02, accuracy="draft", stations=26)
    run.to_rerun(tmp_path / "both.rrd", other, blueprint="compare")
    distance = read(tmp_path / "both.rrd", entities.DISTANCE)
    np.testing.assert_array_equal(distance.time, np.round(run.time, 9))
    expected = np.linalg.norm(run.position - other.position, axis=1)
    np.testing.assert_allclose(distance["scalars"][:, 0], expected, rtol=1e-9, atol=1e-12)
    assert expected.max() > 0.0
    text = read(tmp_path / "both.rrd", entities.COMPARE_TEXT)["text"][-1][0]
    assert "falling standard" in text
    assert "falling draft" in text


def test_a_coarse_run_is_recorded_with_50_samples_a_second(tmp_path):
    coarse = simulate(straight(), duration=0.5, sample_period=0.1)
    fine = simulate(straight(), duration=0.5, sample_period=0.02, load=True)
    coarse.to_rerun(tmp_path / "run.rrd")
    position = read(tmp_path / "run.rrd", entities.POSITION)
    np.testing.assert_array_equal(position.time, np.round(fine.time, 9))
    np.testing.assert_allclose(position["scalars"], fine.position, atol=1e-12)
    force = read(tmp_path / "run.rrd", entities.LOAD_NUMBERS)["force_2"]
    np.testing.assert_allclose(force, fine.fluid_force[:, :, 1], atol=1e-9)
    assert properties(tmp_path / "run.rrd", "error_estimate")["position"] == coarse.error_estimate.position
    for how in ({"rate": 0.0}, {"rate": 10.0, "load": False}):
        coarse.to_rerun(tmp_path / "own.rrd", **how)
        assert len(read(tmp_path / "own.rrd", entities.POSITION).time) == 6
    coarse.save(tmp_path / "run.nc")
    late = replace(Run.load(tmp_path / "run.nc"), position=1.5 * coarse.position)  # another swim: as it is
    late.to_rerun(tmp_path / "late.rrd", load=False)
    assert len(read(tmp_path / "late.rrd", entities.POSITION).time) == 6
    with pytest.raises(ValueError, match="rate must be"):
        coarse.to_rerun(tmp_path / "no.rrd", rate=-1.0)


def test_what_a_run_has_not_computed_is_not_shown(tmp_path):
    bare = simulate(straight(), duration=0.1, scene=Scene(internal_wrench=False, ledger=False))
    topics = {topic for topic, _ in messages_of_run(bare)}
    assert topics == {
        "body", "curvature_law", "diagnostics", "head_pose", "head_twist", "odom", "backbone", "curvature"
    }  # fmt: skip
    bare.to_rerun(tmp_path / "bare.rrd")
    assert (tmp_path / "bare.rrd").stat().st_size > 1000


def test_the_water_s_force_is_shown_unless_it_is_left_out(tmp_path):
    from eel_viz.recording.reading import read

    from eel_viz import entities

    run = simulate(straight(), duration=0.2)
    whole = simulate(straight(), duration=0.2, load=True)
    assert run.fluid_force is None
    run.to_rerun(tmp_path / "run.rrd")
    whole.to_rerun(tmp_path / "whole.rrd")
    for name in ("force_2", "tail_force", "wake_momentum_rate"):
        shown, given = (read(tmp_path / file, entities.LOAD_NUMBERS)[name] for file in ("run.rrd", "whole.rrd"))
        np.testing.assert_array_equal(shown, given)
    run.to_rerun(tmp_path / "bare.rrd", load=False)
    with pytest.raises(ValueError, match="has nothing at"):
        read(tmp_path / "bare.rrd", entities.LOAD_NUMBERS)


def test_simulate_writes_it_too(tmp_path, capsys):
    from eel_viz.recording.reading import read

    from eel_viz import entities

    out = str(tmp_path / "run.rrd")
    assert main(["straight", "--duration", "0.2", "--load", "--out", out]) == 0
    assert read(out, entities.LOAD_NUMBERS)["force_2"].shape == (13, 51)
    assert main(["straight", "--duration", "0.1", "--out", out]) == 0
    assert "exists and will be overwritten" in capsys.readouterr().err
    assert len(read(out, entities.SPEED).time) == 7
    assert main(["straight", "--out", str(tmp_path / "run.txt")]) == 2
    assert "--out must end in .nc, .npz, .csv or .rrd, got" in capsys.readouterr().err


def test_what_cannot_be_is_said(run, tmp_path):
    with pytest.raises(ValueError, match="there is no setting colour; see"):
        run.to_rerun(tmp_path / "run.rrd", colour=1)
    with pytest.raises(ValueError, match="sink cannot be set"):
        run.to_rerun(tmp_path / "run.rrd", sink=("spawn",))
    with pytest.raises(ValueError, match="blueprint must be one of overview"):
        run.to_rerun(tmp_path / "run.rrd", blueprint="mine")
    with pytest.raises(ValueError, match=r"recording '/proc/none.rrd' cannot be written"):
        run.to_rerun("/proc/none.rrd")


@pytest.mark.fault(
    "ending",
    "the disk is full while `eel simulate` or `eel replay` write, or `Run.to_rerun` does",
    "one line with the reason, status 1 (`OSError`); an older file stays as it was, nothing else is left",
)
@pytest.mark.parametrize("form", ["rrd", "npz", "csv"])
def test_a_full_disk_leaves_the_older_file(form, small_disk, capsys):
    out = small_disk / f"run.{form}"
    words = ["falling", "--duration", "0.3", "--sample-period", "0.01", "--load", "--out", str(out)]
    assert main([*words, "--stations", "11"]) == 0
    older = out.read_bytes()
    (small_disk / "other").write_bytes(bytes(2**20 - len(older) - 3 * 4096))
    capsys.readouterr()
    assert main([*words, "--stations", "51"]) == 1
    told = capsys.readouterr()
    assert "cannot be written: No space left on device\n" in told.err and "Traceback" not in told.err
    assert "greatest torque" in told.out and "written to" not in told.out
    assert out.read_bytes() == older and sorted(os.listdir(small_disk)) == ["other", out.name]


@pytest.mark.parametrize("short", [10, 1000, 10_000_000])
def test_a_recording_is_whole_or_not_there(run, short, tmp_path, limit_of_files):
    """Past a limit of the size of files: in the index at the end, in the middle, and at the first bytes.

    The same run takes a little more or less in each file, so that one near the limit may just fit.
    """
    run.to_rerun(tmp_path / "whole.rrd")
    (tmp_path / "run.rrd").write_bytes(b"RRF2 of yesterday")
    whole = (tmp_path / "whole.rrd").stat().st_size
    refused = None
    with limit_of_files(max(whole - short, 0)):
        try:
            run.to_rerun(tmp_path / "run.rrd")
        except OSError as error:
            refused = str(error)
    if refused is None:
        assert short < whole / 2
        assert read(tmp_path / "run.rrd", entities.POSITION).time.size == run.time.size
    else:
        assert re.fullmatch(r"recording '.*/run\.rrd' cannot be written: File too large", refused)
        assert (tmp_path / "run.rrd").read_bytes() == b"RRF2 of yesterday"
    assert sorted(os.listdir(tmp_path)) == ["run.rrd", "whole.rrd"]


def test_the_library_alone_imports_neither_viz_nor_rerun_and_says_what_is_missing(tmp_path):
    code = """
import sys
from eel_dynamics import simulate
from eel_gaits import falling

run = simulate(falling(), duration=0.1)
assert not {"rerun", "eel_viz"} & sys.modules.keys()
sys.modules["eel_viz"] = None
try:
    run.to_rerun("x.rrd")
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=100, cwd=tmp_path)
    assert "to_rerun needs the package eel_viz, with rerun-sdk" in done.stdout, done.stderr
