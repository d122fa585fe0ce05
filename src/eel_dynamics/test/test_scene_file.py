# SPDX-License-Identifier: Apache-2.0
"""A scene in a file: what is read is what is swum, what is written comes back equal, nodes take it, bad input."""

from dataclasses import replace

import numpy as np
import pytest
import yaml
from eel_dynamics.commands import simulate as command
from eel_dynamics.model.fins.fins import Fin, RollHold
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.runs.scene_file import WORDS, swim_of, words_of
from eel_gaits.gaits.settings import Settings
from swim_client import LIMIT

from eel_dynamics import Accuracy, Body, Gust, Robot, Run, Scene, Shear, Swim, load_scene, save_scene, simulate
from eel_gaits import straight

SCENE = """
gait: straight
period: 0.8
body: kern2006
scene: {planar: true, fluid_density: 900, current: [-0.1, 0, 0]}
accuracy: 1e-3
duration: 2
initial_linear_velocity: [0.2, 0.1, 0]
initial_position: [1, 2, 3]
stations: 11
flow: gust velocity=0.1,0,0 start=0.5 + shear velocity=0.2,0,0 width=2
"""


def scene_in(folder, text=SCENE, name="scene.yaml"):
    path = folder / name
    path.write_text(text)
    return path


def test_what_is_read_is_what_is_swum(tmp_path):
    swim = load_scene(scene_in(tmp_path))
    run = simulate(
        straight(period=0.8), 2.0, body=Body.kern2006(), accuracy=1e-3, stations=11, position=(1, 2, 3),
        scene=Scene(planar=True, fluid_density=900.0, current=(-0.1, 0.0, 0.0)), twist=(0, 0, 0, 0.2, 0.1, 0),
        flow=swim.flow,
    )  # fmt: skip
    assert swim.run() == run and len(swim.flow.parts) == 2
    assert swim.simulation().swimmer.flow == swim.flow


def test_what_is_written_comes_back_equal(tmp_path):
    swim = load_scene(scene_in(tmp_path))
    for each in (swim, swim.with_gait(period=0.5), swim.changed(flow=None, scene=Scene(), duration="settled")):
        save_scene(each, tmp_path / "again.yaml")
        again = load_scene(tmp_path / "again.yaml")
        assert words_of(again) == words_of(each)
        assert again.law == each.law and again.body == each.body and again.accuracy == each.accuracy
        assert all(np.array_equal(ours, theirs) for ours, theirs in zip(again.start, each.start, strict=True))


def test_a_robot_is_a_word(tmp_path):
    swim = swim_of({"gait": "straight", "robot": "eight_servos", "duration": 0.5, "accuracy": 1e-2})
    assert swim.robot == Robot.named("eight_servos") and words_of(swim)["robot"] == "eight_servos"
    assert swim.run() == simulate(straight(), 0.5, robot=swim.robot, accuracy=1e-2)
    with pytest.raises(ValueError, match="robot 'eight_servos' cannot be written"):
        words_of(swim.changed(robot=swim.robot.changed(torque_limit=None)))


def test_fins_are_words():
    fins = "pair station=0.3 area=2e-3 aspect_ratio=3 k_p=1.5 time_constant=0.05"
    swim = swim_of({"gait": "straight", "fins": fins, "duration": 0.3, "accuracy": 1e-2})
    assert swim.fins == Fin.pair(0.3, 2e-3, 3.0, angle=RollHold(k_p=1.5), time_constant=0.05)
    assert swim_of(words_of(swim)).fins == swim.fins
    assert swim.run() == simulate(straight(), 0.3, fins=swim.fins, accuracy=1e-2)


def test_the_words_are_parameters_of_the_nodes(tmp_path):
    """All but the period of samples."""
    save_scene(load_scene(scene_in(tmp_path)), tmp_path / "again.yaml")
    words = yaml.safe_load((tmp_path / "again.yaml").read_text())["/**"]["ros__parameters"]
    named = {name for name in WORDS if name not in ("scene", "sample_period")}
    assert named <= {*vars(DynamicsParameters()), *Settings.known_names()}
    values = DynamicsParameters.among({**words, "flow": ""})
    assert (values.accuracy, values.duration, values.body) == (1e-3, 2.0, "kern2006")
    assert Settings.start(words).law() == straight(period=0.8)
    assert not set(words["scene"]) - set(vars(Scene()))


def test_scene_drives_the_nodes_too(tmp_path, start, client):
    path = tmp_path / "scene.yaml"
    save_scene(swim_of({"gait": "straight", "period": 0.5, "duration": 0.3, "scene": {"planar": True}}), path)
    files = ("--ros-args", "--params-file", str(path))
    swim = client(topics=("head_pose",))
    start("gait_generator", *files)
    node = start("dynamics", *files, "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")
    assert node.wait(LIMIT) == 0, node.output()
    swim.until(lambda: len(swim.received["head_pose"]) == 31, "31 samples")
    assert "not parameters of this node" not in node.output()


def test_cross_flow_is_a_switch_of_the_scene():
    robot = Body.boyer2010()
    bare = robot.changed(lateral_drag=0.0, vertical_drag=0.0, roll_drag=0.0)
    off = simulate(straight(), 1.0, scene=Scene(cross_flow=False), accuracy=1e-3)
    assert np.array_equal(off.position, simulate(straight(), 1.0, body=bare, accuracy=1e-3).position)
    assert off.position[-1, 0] != simulate(straight(), 1.0, accuracy=1e-3).position[-1, 0]


@pytest.mark.parametrize(
    "text, named",
    [
        ("gait: straightt", "did you mean 'straight'?"),
        ("gait: straight\nperiode: 1", "unknown word 'periode' (did you mean 'period'?)"),
        ("gait: straight\nperiod: -1", "period must be >= 0.001 s"),
        ("scene: {plane: true}", "scene has no field 'plane' (did you mean 'planar'?)"),
        ("scene: {viscosity: -1}", "scene viscosity must be >= 0 m^2/s, got -1"),
        ("scene: planar", "scene must be a Mapping, got 'planar'"),
        ("body: eel", "body must be one of boyer2010, kern2006, links with its numbers, a file, got 'eel'"),
        ("body: missing.csv", "missing.csv"),
        ("accuracy: exact", "accuracy"),
        ("duration: 0", "duration must be > 0 s, got 0"),
        ("duration: long", "duration must be a number, got 'long'"),
        ("flow: gusty", "flow must be one of"),
        ("flow: gust begin=1", "flow Gust has no field 'begin'"),
        ("flow: {a: 3}", "flow must be a str, got {'a': 3}"),
        ("fins: up station=0.3", "fins must be one of pair, right, left, got 'up'"),
        ("fins: left station=0.3 area=1", "fin aspect_ratio must be given"),
        ("fins: left stations=0.3", "fin has no field 'stations' (did you mean 'station'?)"),
        ("robot: nine_servos", "robot must be one of eight_servos"),
        ("initial_position: [1, 2]", "initial position must be 3 numbers, got 2"),
        ("gait: [straight]", "unknown gait ['straight'], must be one of"),
        ("gait: {straight: 1}", "unknown gait {'straight': 1}, must be one of"),
        ("flow: vortex_street core=1e-300", "core must be 1e-30 to 1e+30 in size, got 1e-300"),
        ("flow: uniform time=0,1", "flow Uniform velocity must be given"),
        ("flow: 'shear + '", "flow must be one of uniform, gust, shear, vortex, vortex_street, wave, a file that ends"),
        ("flow: shear kind=Gust", "must have fields NAME=VALUE, each once, got 'kind=Gust'"),
        ("fins: left station=0.5 area=1e-3 aspect_ratio=5e-324", "fin aspect_ratio must be 1e-30 to 1e+30 in size"),
        ("fins: left station=0.5 area=1e-3 aspect_ratio=1e300", "fin aspect_ratio must be 1e-30 to 1e+30 in size"),
        ("fins: left side=right station=0.5", "must have fields NAME=VALUE, each once, got 'side=right'"),
        ("initial_position: [1e40, 0, 0]", "initial position must be 0 to 1e+30 in size, got 1e+40 at index 0"),
        ("gait: straight\nperiod: 0x", "period must be a number, got '0x'"),
        ("body: links length=1e-300", "body links must have number"),
        ("a: \0", "unacceptable character #x0000"),
        ("- a list", "its content must be a Mapping"),
        ("gait: [", "line 1"),
    ],
)
def test_bad_input_is_one_line_that_names_it(tmp_path, text, named, capsys):
    assert command.main([str(scene_in(tmp_path, text))]) == 2
    said = capsys.readouterr().err
    assert named in said and said.startswith("eel simulate: scene '") and said.count("\n") == 1


def test_options_change_the_scene_of_a_file(tmp_path):
    path, out = scene_in(tmp_path), tmp_path / "run.nc"
    words = "--set period=0.9 --scene planar=on --body kern2006 --duration 1 --accuracy 1e-2"
    assert command.main([str(path), *words.split(), "--out", str(out)]) == 0
    run, swim = Run.load(out), load_scene(path).with_gait(period=0.9)
    assert run.law == swim.law and run.body == Body.kern2006()
    assert run.scene == replace(swim.scene, planar=True)
    assert command.main([str(path), "--set", "periode=1"]) == 2


def test_a_motion_takes_no_place_in_a_scene(tmp_path, capsys):
    assert command.main([str(scene_in(tmp_path)), "--file", "midlines.csv"]) == 2
    assert "has a gait of its own, got 'midlines.csv' too" in capsys.readouterr().err


def test_duration_and_accuracy_of_the_command_come_first(tmp_path, capsys):
    out = tmp_path / "run.npz"
    assert command.main([str(scene_in(tmp_path)), "--duration", "1", "--stations", "5", "--out", str(out)]) == 0
    arrays = np.load(out)
    assert arrays["time"][-1] == 1.0 and arrays["torque"].shape[1] == 5


@pytest.mark.parametrize(
    "changes, named",
    [
        ({"law": straight(period=0.7)}, "law 'straight' cannot be written"),
        ({"gait": None}, "law 'straight' cannot be written"),
        ({"law": None}, "law None cannot be written"),
        ({"body": Body.boyer2010().changed(lateral_drag=1.0)}, "body 'boyer2010' cannot be written"),
        ({"accuracy": Accuracy(name="fine", resolution=30.0)}, "accuracy 'fine' cannot be written"),
    ],
)
def test_what_no_file_can_hold_is_refused(changes, named, tmp_path):
    swim = swim_of({"gait": "straight"})
    assert isinstance(swim, Swim)
    with pytest.raises(ValueError, match=named):
        save_scene(swim.changed(**changes), tmp_path / "scene.yaml")
    with pytest.raises(ValueError, match="swim must be a Swim, got None"):
        save_scene(None, tmp_path / "scene.yaml")
    assert not (tmp_path / "scene.yaml").exists()


def test_flows_come_back():
    for flow in (Gust(hold=2.0), Shear(width=2.0)):
        swim = swim_of({"gait": "straight"}).changed(flow=flow)
        assert swim_of(words_of(swim)).flow == flow
