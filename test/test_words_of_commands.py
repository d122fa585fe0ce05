# SPDX-License-Identifier: Apache-2.0
"""What the commands and nodes say, whatever they are given and wherever they say it: one line, and no traceback."""

import os
import subprocess

import pytest
from eel_common.command.suite import commands

LONG = "lang und breit " * 6000  # 90 kB: a single argument can have 128 kB
MODULES = {"eel": "eel_common.command.suite", "gait_generator": "eel_gaits.ros.node"}
MODULES |= {"dynamics": "eel_dynamics.ros.node", "visualiser": "eel_viz.ros.node"}
GIVEN = [  # each with an argument that does not fit, as long as can be
    ["eel", "simulate", LONG],
    ["eel", "simulate", "--duration", LONG],
    ["eel", "simulate", "--stations", "9" * 100_000],
    ["eel", "simulate", "--scene", LONG + "=1"],
    ["eel", "simulate", "--body", LONG],
    ["eel", "simulate", "--out", LONG + ".npz"],
    ["eel", "sweep", "--vary", LONG + "=1", "--out", "sweep.nc"],
    ["eel", "optimise", "--bound", LONG + "=1:2", "--speeds", "0.3"],
    ["eel", "identify", LONG + ".csv", "--first", "body.lateral_drag=1"],
    ["eel", "tradeoff", LONG],
    ["eel", "stability", "--study", LONG],
    ["eel", "replay", LONG],
    ["eel", "render", LONG, "-o", "picture.png"],
    ["eel", "record", "-o", "bag", "--duration", LONG],
    ["eel", "echo", LONG],
    ["eel", LONG],
    ["eel", "compare", "straight", LONG],
    ["eel", "completion", LONG],
    ["gait_generator", LONG],
    ["gait_generator", "--ros-args", "-p", f"gait:={'x' * 90_000}"],
    ["dynamics", "--ros-args", "-p", f"body:={'x' * 90_000}"],
    ["dynamics", "--ros-args", "-p", f"rate:={'x' * 90_000}"],
    ["visualiser", "--ros-args", "-p", f"sink:={'x' * 90_000}"],
]


def said_by(words, tmp_path, **environment):
    return subprocess.run(
        words,
        cwd=tmp_path,
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=120,
    )


@pytest.mark.fault(
    "parameters",
    "an argument or a parameter of 90 kB that does not fit, of any command or node",
    "status 2, and one line of at most 300 characters, after the name of the command, that names it",
)
@pytest.mark.parametrize("program", MODULES)
def test_a_long_argument_is_refused_in_one_line(program, start_in_turn, tmp_path, monkeypatch):
    folder = tmp_path / "empty"
    folder.mkdir()
    monkeypatch.chdir(folder)
    given = [words for words in GIVEN if words[0] == program]
    for words, (status, said) in zip(
        given, start_in_turn(MODULES[program], [words[1:] for words in given]), strict=True
    ):
        (line,) = said.splitlines()
        name = " ".join(words[: 2 if words[1] in commands() else 1])
        assert status == 2 and line.startswith(f"{name}: ") and len(line) < 400, (words[:3], status, line[:2000])
    assert not list(folder.iterdir())


@pytest.mark.fault(
    "names",
    "names with characters that the terminal's encoding lacks (PYTHONIOENCODING=ascii)",
    "written as escapes; nothing ends",
)
@pytest.mark.parametrize("encoding", ["ascii:strict", "latin-1"])
def test_a_terminal_without_the_characters_breaks_nothing(encoding, tmp_path):
    out = tmp_path / "Ærø – δοκιμή.csv"
    done = said_by(["eel", "simulate", "--duration", "0.1", "--out", str(out)], tmp_path, PYTHONIOENCODING=encoding)
    assert done.returncode == 0 and out.exists(), done.stderr.decode()
    assert b"written to" in done.stdout and b"\\u03b4" in done.stdout
    done = said_by(["eel", "simulate", "δοκιμή"], tmp_path, PYTHONIOENCODING=encoding)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1 and b"\\u03b4" in done.stderr


@pytest.mark.parametrize("name", ["eel", "eel simulate", "eel render", "gait_generator", "visualiser"])
def test_help_on_a_terminal_of_ascii(name, tmp_path):
    done = said_by([*name.split(), "--help"], tmp_path, PYTHONIOENCODING="ascii:strict")
    assert done.returncode == 0 and done.stdout.startswith(b"usage: ") and not done.stderr
