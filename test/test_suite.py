# SPDX-License-Identifier: Apache-2.0
"""The command `eel`: its list, its hints, the help of a gait, the completion of a shell."""

import os
import subprocess
import sys

import pytest
from eel_common.command import suite
from eel_common.command.command_line import COMPLETING
from eel_dynamics.commands import simulate as command
from test_packages import EXECUTABLES

NOT_COMMANDS = {"gait_generator", "heading_controller", "pilot", "dynamics", "visualiser", "markers", "eel"}


def error_of(words, capsys) -> str:
    with pytest.raises(SystemExit) as ended:
        suite.main(words)
    assert ended.value.code == 2
    return capsys.readouterr().err


def test_the_list_has_a_line_for_each_command(capsys):
    assert suite.main([]) == 0
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    told = {name: about for name, about in lines if name in suite.commands()}
    own = {name.removeprefix("eel_") for names in EXECUTABLES.values() for name in names - NOT_COMMANDS}
    assert set(told) == own | {"ballast", "compare", "completion", "roll-hold", "urdf"}
    assert all(10 < len(about) < 66 and not about.endswith(".") for about in told.values()), told


def test_the_list_begins_with_simulate_and_has_a_second_column(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    assert suite.main([]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[4:6] == ["swim:", "  simulate    swim a gait, a scene of a file, a sequence"]
    assert lines[6] == 14 * " " + "or a measured motion; print its figures"
    heads = [line for line in lines if line.endswith(":") and not line.startswith(" ")]
    assert heads == ["swim:", "study:", "record and look:", "shell:", "options:"]


def test_the_list_imports_no_command():
    code = "import sys; from eel_common.command import suite; suite.main([])"
    code += "; print('numpy' in sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr == "False\n"


@pytest.mark.parametrize(
    "words, told",
    [
        ("simulat", "eel: no command 'simulat' (did you mean 'simulate'?)"),
        ("simulate --duratoin 4", "eel simulate: no option '--duratoin' (did you mean '--duration'?)"),
        ("sweep --vry period=1", "eel sweep: no option '--vry' (did you mean '--vary'?)"),
        ("simulate --help turnin", "eel simulate: unknown gait 'turnin' (did you mean 'turning'?)"),
    ],
)
def test_a_slip_is_answered_with_the_name_that_was_meant(words, told, capsys):
    said = error_of(words.split(), capsys)
    assert said.startswith(told) and said.count("\n") == 1


def test_a_field_of_the_scene_is_hinted_at(capsys):
    assert command.main(["--scene", "fricton=laminar"]) == 2
    assert "scene has no field 'fricton' (did you mean 'friction'?)" in capsys.readouterr().err


@pytest.mark.parametrize("words", ["--help turning", "turning --help"])
def test_the_help_of_a_gait_has_its_numbers(words, capsys):
    with pytest.raises(SystemExit) as ended:
        suite.main(["simulate", *words.split()])
    said = capsys.readouterr().out
    assert ended.value.code == 0
    assert "period = 1.0: period T of the wave [s]; >= 0.001 s and <= 10000 s" in said and "_bend = " in said


@pytest.mark.parametrize(
    "line, completed",
    [("eel si", {"simulate"}), ("eel simulate --acc", {"--accuracy"}), ("eel simulate turn", {"turning"})],
)
def test_a_shell_completes_commands_options_and_gaits(line, completed, tmp_path):
    pytest.importorskip("argcomplete")
    answer = tmp_path / "answer"
    asked = {COMPLETING: "1", "COMP_LINE": line, "COMP_POINT": str(len(line)), "_ARGCOMPLETE_STDOUT_FILENAME": answer}
    subprocess.run(["eel"], env={**os.environ, **asked}, timeout=60, check=True)
    assert {word.strip() for word in answer.read_text().split("\v")} == completed


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_without_argcomplete_the_commands_are_completed(shell, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "argcomplete", None)
    assert suite.main(["completion", shell]) == 0
    said = capsys.readouterr().out
    assert f"complete -o default -W '{' '.join(suite.commands())}' eel" in said
    assert ("bashcompinit" in said) == (shell == "zsh")
