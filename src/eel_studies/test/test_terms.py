# SPDX-License-Identifier: Apache-2.0
"""What the terms of the model do to a scene: those that matter are told from those that do not, on scenes unseen."""

from dataclasses import replace

import numpy as np
import pytest
from eel_dynamics.runs.companion import relative_errors
from eel_dynamics.runs.scene_file import swim_of
from eel_studies.scene_terms.command import main
from eel_studies.scene_terms.terms import TERMS, terms_of, without

from eel_dynamics import Scene, load_scene, simulate
from eel_gaits import straight
from eel_studies import terms


@pytest.fixture(scope="module")
def plain():
    return terms(swim_of({"gait": "straight", "duration": 6}))


def test_effects_are_the_differences_of_two_swims(plain):
    whole, bare = (simulate(straight(), 6.0, accuracy=1e-6, scene=Scene(cross_flow=on)) for on in (True, False))
    effect = plain.effects["cross-flow drag"]
    assert effect.speed == pytest.approx(bare.mean_speed / whole.mean_speed - 1.0, abs=2e-4)
    assert effect.torque == pytest.approx(bare.greatest_torque()[0] / whole.greatest_torque()[0] - 1.0, abs=2e-4)
    assert effect.path == pytest.approx(relative_errors(bare, whole).position, abs=2e-4)
    assert effect.speed < -0.2 and effect.seconds > 0.0


def test_what_matters_stays_and_what_does_not_goes(plain):
    assert plain.left_out == ["third dimension"] and plain.within  # a gait in yaw alone
    assert {name for name, each in plain.effects.items() if each.worst > 0.05} == {
        "inertia of the water", "momentum of the added mass", "wake", "cross-flow drag", "friction",
        "turbulence of the friction",
        "nose",
    }  # fmt: skip
    assert plain.recommended.scene.planar and not plain.swim.scene.planar
    assert plain.recommended.scene.ledger and plain.recommended.duration == plain.duration == 6


def test_only_terms_that_a_scene_has_are_left_out(plain):
    own = {"third dimension", *plain.effects}
    assert not own & {"righting moment", "weight", "mass off the axis", "current", "flow", "rotors", "higher modes"}
    assert own <= set(TERMS)
    dry = swim_of({"gait": "straight", "scene": {"reactive": False, "resistive": False, "planar": True}})
    assert terms_of(dry) == {}


SCENES = {  # words of a scene: the terms that must go, those that must stay
    "a weak gust": ({"gait": "straight", "flow": "gust velocity=0.001,0,0"}, {"flow"}, {"friction"}),
    "a strong gust": ({"gait": "straight", "flow": "gust velocity=0,0.2,0"}, set(), {"flow"}),
    "heavy water": (
        {"gait": "turning", "body": "kern2006", "scene": {"viscosity": 1e-10, "metacentric_height": 0.003}},
        {"friction", "third dimension"}, {"cross-flow drag"},
    ),
    "out of the plane": ({"gait": "helix", "scene": {"friction": "laminar"}}, set(), {"third dimension", "friction"}),
}  # fmt: skip


@pytest.mark.parametrize("words, gone, stay", SCENES.values(), ids=SCENES)
def test_scenes_unseen(words, gone, stay, tmp_path):
    found = terms(swim_of({"duration": 5, **words}), tolerance=0.05)
    assert gone <= set(found.dropped) and not stay & set(found.dropped)
    assert found.within and found.together.worst <= 0.05


def test_terms_of_robots_and_weights():
    swim = swim_of({"gait": "straight", "robot": "eight_servos", "scene": {"planar": True}, "duration": 0.5})
    found = terms(swim, tolerance=0.5)
    own = {"compliance of the robot", "limits of the servos", "rotors"}
    assert own <= set(found.effects) and found.within
    assert "limits of the servos" not in found.dropped  # a robot without them bears no name
    assert all(np.isfinite(each.torque) for each in found.effects.values())
    row = next(row for row in found.table().rows if row[0] == "limits of the servos")
    assert row[-1] == "little, but no file can be without it"
    heavy = swim_of({"gait": "straight", "scene": {"weight": True, "density": 1100}, "duration": 4})
    assert terms(heavy, tolerance=0.05).effects["weight"].path > 0.5  # it sinks
    assert "higher modes" in terms_of(swim_of({"gait": "straight", "robot": "passive_tail"}))


def test_terms_that_are_small_alone_and_great_together_come_back(plain):
    """Without the nose the cost falls by 6 %, with a laminar friction by 21 %."""
    found = terms(plain.swim, tolerance=1.001 * plain.effects["turbulence of the friction"].worst)
    assert found.restored == ["turbulence of the friction"] and "nose" in found.left_out and found.within
    together = without(plain.swim, ["nose", "turbulence of the friction"]).run(accuracy=1e-4)
    whole = plain.swim.run(accuracy=1e-4)
    cost, most = (run.analysis().cost_of_transport for run in (together, whole))
    assert 1.0 - cost / most > found.tolerance


def test_a_term_without_which_the_swim_stops_matters(monkeypatch):
    def stops(swim):
        return swim.changed(scene=replace(swim.scene, wake=False), law=1e9 * swim.law)

    monkeypatch.setitem(TERMS, "made up", stops)
    found = terms(swim_of({"gait": "straight", "duration": 1, "accuracy": 1e-2}), tolerance=0.5)
    assert np.isinf(found.effects["made up"].worst) and "made up" not in found.dropped
    row = next(row for row in found.table().rows if row[0] == "made up")
    assert row[1] == "stops" and row[-1] == "matters"


def test_a_scene_that_has_no_plane_keeps_its_third_dimension():
    words = {"gait": "straight", "duration": 1, "accuracy": 1e-2, "flow": "wave amplitude=0.01 wavelength=5"}
    found = terms(swim_of(words), tolerance=0.5)
    assert np.isinf(found.effects["third dimension"].worst) and "third dimension" not in found.dropped


def test_the_command_writes_a_scene_that_swims_alike(tmp_path, capsys):
    out = tmp_path / "small.yaml"
    assert main(["straight", "--duration", "4", "--tolerance", "0.1", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "third dimension" in said and "Recommended: without" in said and str(out) in said
    small = load_scene(out)
    assert small.scene.planar and small.accuracy.target == 0.01
    run, whole = small.run(), simulate(straight(), 4.0, accuracy=1e-5)
    assert relative_errors(run, whole).position < 0.1
    assert run.mean_speed == pytest.approx(whole.mean_speed, rel=0.1)


@pytest.mark.parametrize(
    "words, named",
    [
        ("strayght", "unknown gait 'strayght'"),
        ("straight --tolerance 0", "tolerance must be >= 1e-07, got 0"),
        ("straight --tolerance 2", "tolerance must be <= 1, got 2"),
        ("straight --out small.txt", "--out must end in .yaml or .yml"),
        ("missing.yaml", "there is no such file"),
        ("straight --scene plane=on", "did you mean 'planar'?"),
        ("straight --set periode=1", "did you mean 'period'?"),
    ],
)
def test_bad_input_is_one_line(words, named, capsys):
    assert main(words.split()) == 2
    said = capsys.readouterr().err
    assert named in said and said.startswith("eel terms: ") and said.count("\n") == 1


def test_a_scene_that_cannot_be_swum_is_said():
    with pytest.raises(ValueError, match="sample_period must be at most the duration"):
        terms(swim_of({"gait": "straight", "sample_period": 20.0}))
