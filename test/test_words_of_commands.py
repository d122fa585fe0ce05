# SPDX-License-Identifier: Apache-2.0
"""What the commands and nodes say, whatever they are given and wherever they say it: one line, and no traceback."""

import os
import subprocess

import pytest
from eel_base.command.suite import commands

LONG = "lang und breit " * 6000  # 90 kB: a single argument can have 128 kB
GIVEN = {  # each with an argument that does not fit, as long as can be
    "simulate gait": ["eel", "simulate", LONG],
    "simulate number": ["eel", "simulate", "--duration", LONG],
    "simulate digits": ["eel", "simulate", "--stations", "9" * 100_000],
    "simulate scene": ["eel", "simulate", "--scene", LONG + "=1"],
    "simulate body": ["eel", "simulate", "--body", LONG],
    "simulate out": ["eel", "simulate", "--out", LONG + ".npz"],
    "sweep": ["eel", "sweep", "--vary", LONG + "=1", "--out", "sweep.nc"],
    "optimise": ["eel", "optimise", "--bound", LONG + "=1:2", "--speeds", "0.3"],
    "identify": ["eel", "identify", LONG + ".csv", "--first", "body.lateral_drag=1"],
    "tradeoff": ["eel", "tradeoff", LONG],
    "stability": ["eel", "stability", "--study", LONG],
    "steering": ["eel", "steering", "--points", LONG],
    "drafting": ["eel", "drafting", "--phases", LONG],
    "figures": ["eel", "figures", LONG],
    "replay": ["eel", "replay", LONG],
    "render": ["eel", "render", LONG, "-o", "picture.png"],
    "record": ["eel", "record", "-o", "bag", "--duration", LONG],
    "echo": ["eel", "echo", LONG],
    "eel": ["eel", LONG],
    "compare": ["eel", "compare", "straight", LONG],
    "completion": ["eel", "completion", LONG],
    "midlines": ["eel", "midlines", LONG],
    "gait_generator": ["gait_generator", LONG],
    "gait": ["gait_generator", "--ros-args", "-p", f"gait:={'x' * 90_000}"],
    "dynamics": ["dynamics", "--ros-args", "-p", f"body:={'x' * 90_000}"],
    "dynamics of a number": ["dynamics", "--ros-args", "-p", f"rate:={'x' * 90_000}"],
    "visualiser": ["visualiser", "--ros-args", "-p", f"sink:={'x' * 90_000}"],
}


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
@pytest.mark.parametrize("what", GIVEN)
def test_a_long_argument_is_refused_in_one_line(what, tmp_path):
    done = said_by(GIVEN[what], tmp_path)
    (line,) = done.stderr.decode().splitlines()
    name = " ".join(GIVEN[what][: 2 if GIVEN[what][1] in commands() else 1])
    assert done.returncode == 2 and line.startswith(f"{name}: ") and len(line) < 400, (done.returncode, line[:2000])
    assert not done.stdout and not list(tmp_path.iterdir())


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


@pytest.mark.parametrize("name", ["eel", "simulate", "render", "gait_generator", "visualiser"])
def test_help_on_a_terminal_of_ascii(name, tmp_path):
    done = said_by([*name.split(), "--help"], tmp_path, PYTHONIOENCODING="ascii:strict")
    assert done.returncode == 0 and done.stdout.startswith(b"usage: ") and not done.stderr
