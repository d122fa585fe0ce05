# SPDX-License-Identifier: Apache-2.0
"""How the dynamics node starts and ends: parameters that do not fit, signals at any moment."""

import re
import signal
from dataclasses import fields

import pytest
from eel_common.ros.testing.node_process import PROMPT
from eel_dynamics.model.scene import Scene
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.sensors.suite import KINDS
from eel_gaits.ros.messages import law_to_message
from swim_client import LIMIT

from eel_gaits import falling

BAD = {
    "rate of 0": (("rate:=0",), ("rate", "> 0", "got 0")),
    "rate as text": (("rate:=fast",), ("rate", "'fast'")),
    "rate too high": (("rate:=1e9",), ("rate", "<= 10000", "1000000000")),
    "negative factor": (("real_time_factor:=-1",), ("real_time_factor", "-1")),
    "unknown accuracy": (("accuracy:=perfect",), ("accuracy", "perfect")),
    "impossible accuracy": (("accuracy:=-0.5",), ("accuracy", "-0.5")),
    "unknown friction": (("scene.friction:=sticky",), ("friction", "sticky", "printed")),
    "negative density": (("scene.density:=-3.0",), ("density", "-3")),
    "current of two": (("scene.current:=[1.0, 2.0]",), ("current", "3", "[1.0, 2.0]")),
    "unknown body": (("body:=whale",), ("body", "whale", "boyer2010")),
    "missing body file": (("body:=/nowhere/fish.csv",), ("body", "/nowhere/fish.csv")),
    "long quaternion": (("initial_orientation:=[0.0, 0.0, 0.0, 2.0]",), ("initial_orientation", "unit", "2")),
    "joints on three stations": (("yaw_joints:=2", "stations:=3"), ("stations must be 4 or more", "3")),
    "too many joints": (("pitch_joints:=1001",), ("pitch_joints", "1001")),
    "one station": (("stations:=1",), ("stations", "1")),
}


@pytest.mark.fault(
    "parameters",
    "a parameter of the dynamics node out of its bounds, of another type or unknown",
    "one line that names it, what it must be and what it got; status 2",
)
def test_bad_parameters_are_one_line_each_and_status_2(start_in_turn):
    given = [["--ros-args", *(part for each in given for part in ("-p", each))] for given, _ in BAD.values()]
    for (what, (_, words)), (status, said) in zip(
        BAD.items(), start_in_turn("eel_dynamics.ros.node", given), strict=True
    ):
        assert status == 2 and said.startswith("dynamics: ") and said.count("\n") == 1, (what, said)
        assert all(word in said for word in words), (what, said)


def body_file(tmp_path, rows):
    path = tmp_path / "body.csv"
    path.write_text("x,half_width,half_height\n" + "\n".join(",".join(map(str, row)) for row in rows) + "\n")
    return path


@pytest.mark.fault(
    "parameters", "a body file with negative, unsorted or too few values", "one line that names the column; status 2"
)
def test_bad_body_files_are_one_line_each_and_status_2(start_in_turn, tmp_path):
    bodies = {
        "negative": ([(0, 0, 0), (0.3, -0.02, 0.03), (0.6, 0.02, 0.03), (1, 0.01, 0.01)], ("half_width", "-0.02")),
        "unsorted": ([(0, 0, 0), (0.6, 0.02, 0.03), (0.3, 0.02, 0.03), (1, 0.01, 0.01)], ("x", "rise")),
        "short": ([(0, 0, 0), (1, 0.01, 0.01)], ("x", "4 points")),
    }
    lines = []
    for name, (rows, _) in bodies.items():
        (tmp_path / name).mkdir()
        lines.append(["--ros-args", "-p", f"body:={body_file(tmp_path / name, rows)}"])
    for (_, words), (status, said) in zip(bodies.values(), start_in_turn("eel_dynamics.ros.node", lines), strict=True):
        assert status == 2 and said.count("\n") == 1 and all(word in said for word in words), said


@pytest.mark.fault("parameters", "a parameter file that is wrong", "one line, status 2, no traceback")
def test_bad_parameter_file_is_one_line_and_status_2(start_in_turn, tmp_path):
    files = {
        "out of range": ("rate: 0.0", ("rate", "> 0")),
        "no switch": ("scene: {planar: maybe}", ("scene.planar", "maybe")),
        "numbers of two kinds": ("scene: {current: [0.5, 0, 0]}", ("yaml",)),
    }
    lines = []
    for name, (text, _) in files.items():
        path = tmp_path / f"{name}.yaml"
        path.write_text(f"dynamics:\n  ros__parameters:\n    {text}\n")
        lines.append(["--ros-args", "--params-file", str(path)])
    for (_, words), (status, said) in zip(files.values(), start_in_turn("eel_dynamics.ros.node", lines), strict=True):
        assert status == 2 and said.startswith("dynamics: ") and said.count("\n") == 1, said
        assert all(word in said for word in words), said


@pytest.mark.fault(
    "names", "words for the dynamics node that are no ROS arguments", "one line, status 2; --help: a usage"
)
@pytest.mark.parametrize(
    ("word", "status", "beginning", "rows"),
    [
        (
            "-h",
            0,
            "usage: dynamics [--ros-args -p NAME:=VALUE ...]\n",
            sum(len(fields(each)) for each in (DynamicsParameters, Scene, *KINDS.values())),
        ),
        ("--rosargs", 2, "dynamics: unknown argument '--rosargs' (parameters come after --ros-args", 0),
    ],
)
def test_words_that_are_no_ros_arguments(start, word, status, beginning, rows):
    node = start("dynamics", word)
    assert node.wait(LIMIT) == status
    assert node.output().startswith(beginning)
    assert len(re.findall(r"^  \w", node.output(), re.MULTILINE)) == rows


@pytest.mark.fault("names", "a parameter of the dynamics node that there is not", "a warning that names it")
def test_overrides_that_are_no_parameters_are_named(start):
    given = ("rate:=50", "foo:=1", "scene.plane:=true", "use_sim_time:=false")
    node = start("dynamics", "--ros-args", *(part for each in given for part in ("-p", each)))
    node.wait_for_output("waiting for curvature_law", LIMIT)
    assert node.output().count("WARN") == 1
    assert (
        "not parameters of this node, ignored: 'foo', 'scene.plane' (did you mean 'scene.planar'?)\n" in node.output()
    )


def test_body_from_a_file_and_numbers_of_every_kind(start, client, tmp_path):
    rows = [(0, 0, 0), (0.2, 0.02, 0.04), (0.6, 0.02, 0.03), (1.0, 0.01, 0.02), (1.2, 0.005, 0.01)]
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    numbers = (
        "-p",
        "rate:=50",
        "-p",
        "scene.current:=[0, 0, 0]",
        "-p",
        "scene.fluid_density:=1025",
        "-p",
        "accuracy:=0.01",
    )
    start("dynamics", "--ros-args", "-p", f"body:={body_file(tmp_path, rows)}", *numbers)
    swim.until_time(0.3)
    assert swim.latest("body").length == 1.2


@pytest.mark.fault(
    "ending", "SIGINT or SIGTERM in mid-run, at real time and as fast as possible", "prompt exit, status 0"
)
@pytest.mark.parametrize(("sent", "factor"), [(signal.SIGINT, 0), (signal.SIGTERM, 1)])
def test_signal_ends_a_run_promptly(start, client, sent, factor):
    swim = client(topics=("head_pose",))
    swim.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", "-p", f"real_time_factor:={factor}")
    swim.until_time(0.3)
    assert node.time_to_end(sent) < PROMPT
    assert node.status == 0 and "Traceback" not in node.output(), node.output()


@pytest.mark.fault("ending", "two signals at once", "status 0, no traceback")
def test_two_signals_are_as_good_as_one(start):
    node = start("dynamics")
    node.wait_for_output("waiting for curvature_law", LIMIT)
    node.process.send_signal(signal.SIGINT)
    node.process.send_signal(signal.SIGTERM)
    assert node.wait(LIMIT) == 0 and "Traceback" not in node.output()
