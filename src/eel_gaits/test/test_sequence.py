# SPDX-License-Identifier: Apache-2.0
"""Sequences in Python and from YAML files: what they give, and errors that name file, line and key."""

import numpy as np
import pytest
from eel_common.wording import shown
from eel_gaits.gaits.settings import Settings

from eel_gaits import gait, sequence, sequence_from_file, still, straight, turning

X = np.linspace(0.0, 1.0, 7)
GOOD = """\
name: patrol
blend: 0.5
steps:
  - gait: straight
    set: {wavelength: 0.8}
    duration: 8.0
  - gait: turning
    set: {left_bend: 0.5}
    duration: 4.0
    blend: 1e-1
    scale: 0.8
    delay: 0.3
    mirror: yaw
  - together:
      - gait: straight
      - gait: rolling
        scale: 0.2
    duration: 3
  - repeat: 2
    steps:
      - {gait: straight, duration: 2.0}
      - {gait: still, duration: 1.0}
  - gait: joint_wave
    set: {left_angle: 0.1}
"""


@pytest.fixture
def read(tmp_path):
    """read(text) -> the law of a file with that text."""

    def law(text):
        file = tmp_path / "patrol.yaml"
        file.write_text(text)
        return sequence_from_file(file)

    return law


def check_follows(law, start, other, times):
    for t in times:
        np.testing.assert_allclose(law.curvature(start + t, X), other.curvature(t, X), rtol=0.0, atol=1e-9)


def test_a_file_is_what_its_steps_say(read):
    law = read(GOOD)
    assert law.name == "patrol"
    check_follows(law, 0.0, straight(wavelength=0.8), (0.3, 2.0, 8.0))
    check_follows(law, 8.0, (0.8 * turning(left_bend=0.5)).delayed(0.3).mirrored(), (0.5, 1.7, 4.0))
    check_follows(law, 12.0, straight() + 0.2 * gait("rolling"), (0.6, 3.0))
    check_follows(law, 15.0, straight(), (0.6, 2.0))
    check_follows(law, 17.0, still(), (0.6, 1.0))
    check_follows(law, 18.0, straight(), (0.6, 2.0))
    check_follows(law, 21.0, gait("joint_wave", left_angle=0.1), (0.7, 5.0, 100.0))


def test_a_sequence_in_python_is_the_same():
    law = sequence([(straight(), 3.0), (turning(), 2.0, 1.0), (straight(), 1.0)], blend=0.4, name="three")
    assert law.name == "three"
    check_follows(law, 0.0, straight(), (0.5, 3.0))
    check_follows(law, 3.0, turning(), (1.1, 2.0))
    check_follows(law, 6.0, still(), (0.41, 9.0))  # the last one has an end
    assert sequence([]).terms == ()


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([(straight(), None), (still(), 1.0)], "steps[0]: duration must be given for all steps but the last, got None"),
        ([(straight(), 1.0), ("still", 1.0)], "steps[1]: a step must begin with a Law, got 'still'"),
        ([(straight(), 0.0)], "steps[0]: duration must be > 0, got 0.0"),
        ([(straight(), 1.0), (still(), 1.0, -1.0)], "steps[1]: blend must be > 0, got -1.0"),
    ],
)
def test_a_bad_step_in_python_is_named(rows, message):
    with pytest.raises(ValueError) as caught:
        sequence(rows)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("duration: 8.0", "duration: long", "line 6, key 'duration': duration must be a number, got 'long'"),
        ("duration: 8.0", "durations: 8", "line 6, key 'durations': is unknown, must be one of gait, set, together"),
        ("    duration: 3\n", "", "line 14, key 'duration': must be given for all steps but the last, got none"),
        ("wavelength: 0.8", "wavelength: -1", "line 5, key 'wavelength': wavelength must be >= 0.0001 m, got -1"),
        ("wavelength: 0.8", "wave: 1", "line 5, key 'wave': gait 'straight' has no number 'wave', it has: period"),
        ("gait: turning", "gait: turn", "line 7, key 'gait': unknown gait 'turn' (did you mean 'turning'?)"),
        ("gait: turning", "gait: [turning]", "line 7, key 'gait': unknown gait ['turning'], must be one of"),
        ("left_bend: 0.5", "left_bend: x", "line 8, key 'left_bend': left_bend must be a number, got 'x'"),
        ("left_bend: 0.5", "left_bend: 1e9", "line 8, key 'left_bend': left_bend must be <= 100000 rad/m"),
        ("left_bend: 0.5", "bend_start: 2", "line 8, key 'bend_start': bend_full must be > bend_start (2 s), got 2.0"),
        ("{left_bend: 0.5}", "fast", "line 8, key 'set': must be a mapping of names to numbers, got 'fast'"),
        ("blend: 1e-1", "blend: 0", "line 10, key 'blend': blend must be > 0, got 0"),
        ("scale: 0.8", "scale: .nan", "line 11, key 'scale': scale must be finite, got nan"),
        ("delay: 0.3", "delay: {}", "line 12, key 'delay': delay must be a number, got {}"),
        ("mirror: yaw", "mirror: roll", "line 13, key 'mirror': axis must be one of pitch, yaw, got 'roll'"),
        ("repeat: 2", "repeat: 2.5", "line 19, key 'repeat': must be a whole number up to 1000, got 2.5"),
        ("repeat: 2", "gait: still", "line 19, key 'gait': does not go with steps"),
        ("repeat: 2", "repeat: 1000", "line 3, key 'steps': steps[3]: the law has more than 1000 terms"),
        ("name: patrol", "name: [1]", "line 1, key 'name': name must be a text, got [1"),
        ("steps:\n  - gait: straight", "stepz:\n  - gait: straight", "line 3, key 'stepz': is unknown, must be one of"),
        ("- gait: joint_wave", "- still\n  - gait: joint_wave", "line 3, key 'steps': must hold mappings, such as"),
        ("- gait: joint_wave", "- &a [*a]\n  - gait: still", "line 23: too many levels"),
        ("- gait: joint_wave", "- {gait: a, gait: b}\n  - gait: still", "line 23, key 'gait': comes twice"),
        ("- gait: joint_wave", "- {1: 2}\n  - gait: still", "line 23, key 1: is no text"),
        ("- gait: joint_wave", "- {together: []}\n  - gait: still", "line 23, key 'together': must be a list, got []"),
        ("- gait: joint_wave", "- gait: !!python/name:os.system x\n    a: 1\n  - gait: b", "line 23: could not"),
        ("duration: 2.0}", "duration: 2.0", "line 22: expected ',' or '}', but got '{'"),
    ],
)
def test_an_error_names_file_line_and_key(read, tmp_path, old, new, message):
    assert old in GOOD
    with pytest.raises(ValueError) as caught:
        read(GOOD.replace(old, new, 1))
    assert str(caught.value).startswith(f"{shown(str(tmp_path / 'patrol.yaml'))}, {message}"), str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["", "a text", "[1, 2]", "name: x", "steps: []", "\0", "steps: 3"])
def test_a_file_that_is_no_sequence_is_refused_in_one_line(read, text):
    with pytest.raises(ValueError) as caught:
        read(text)
    assert "patrol.yaml" in str(caught.value) and "\n" not in str(caught.value)


def test_numbers_beside_gaits_together_are_refused_by_their_line(read):
    with pytest.raises(ValueError, match=r"line 3, key 'set': goes with gait"):
        read("steps:\n  - together: [{gait: still}, {gait: straight}]\n    set: {period: 1}\n")


def test_the_settings_of_the_node_take_a_file(tmp_path):
    file = tmp_path / "patrol.yaml"
    file.write_text(GOOD)
    settings = Settings().changed({"gait": "sequence", "file": str(file), "transition": 2})
    assert settings.law().terms == sequence_from_file(file).terms and settings.law().transition == 2.0
    assert settings.numbers() == {"transition": 2.0}
    file.write_text(GOOD.replace("blend: 0.5", "blend: 0"))
    assert settings.law().name == "patrol"  # it was read once
    with pytest.raises(ValueError, match=r"patrol.yaml', line 2, key 'blend': blend must be > 0, got 0"):
        settings.changed({"file": str(file)})
    with pytest.raises(ValueError, match="gait 'sequence' needs the parameter file, got ''"):
        Settings().changed({"gait": "sequence"})
    with pytest.raises(ValueError, match="'/no/such/file': there is no such file"):
        settings.changed({"file": "/no/such/file"})
    assert settings.changed({"gait": "straight"}).law() == straight(transition=2.0)
