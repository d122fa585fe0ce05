# SPDX-License-Identifier: Apache-2.0
"""The words of a node's command line: a usage, one line of refusal, or none of them."""

import sys

import pytest
from eel_common.ros.command_line import handle_arguments

ROWS = [("depth", "of the water [m]", 2.0), ("lid", "closed", False), ("label", "text on it", "")]


@pytest.fixture
def answer(capsys):
    """answer(*words): the status, and what was written to stderr, as name and text of each line."""

    def answer_these(*words):
        status = handle_arguments("tank", "Holds water.", ROWS, ["tank", *words])
        output, lines = capsys.readouterr()
        sys.stdout.write(output)
        return status, [tuple(line.split(": ", 1)) for line in lines.splitlines()]

    return answer_these


@pytest.mark.parametrize("words", [(), ("--ros-args", "-p", "depth:=1.0"), ("--ros-args", "-r", "a:=b", "--")])
def test_ros_arguments_need_no_answer(answer, words, capsys):
    assert answer(*words) == (None, []) and capsys.readouterr().out == ""


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help_lists_the_parameters_with_their_defaults(answer, word, capsys):
    assert answer("--ros-args", "-p", "depth:=1.0", "--", word) == (0, [])
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "usage: tank [--ros-args -p NAME:=VALUE ...]" and lines[2] == "Holds water."
    assert [line.split(None, 1) for line in lines[-3:]] == [
        ["depth", "of the water [m] (default 2.0)"],
        ["lid", "closed (default false)"],
        ["label", "text on it (default empty)"],
    ]


def test_another_word_is_refused_and_shown_in_short(answer):
    for word, shown in (("--depth", "'--depth'"), ("x\ny", r"'x\ny'")):
        status, ((name, text),) = answer(word)
        assert status == 2 and name == "tank" and text.startswith(f"unknown argument {shown} (parameters come after")
    _, ((_, text),) = answer("long " * 1000)
    assert len(text) < 200


def test_bad_ros_arguments_are_refused(answer):
    status, ((_, text),) = answer("--ros-args", "-p", "depth")
    assert status == 2 and "depth" in text


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("depth:=1.0",), "unknown ROS arguments 'depth:=1.0' ("),
        (("-p", "depth:=1.0", "lid:=true", "--lid"), "unknown ROS arguments 'lid:=true', '--lid' ("),
        (("-p", "depth=1.0"), "Couldn't parse parameter override rule: '-p depth=1.0'. Error: "),
        (("--params-file", "none.yaml"), "Couldn't parse params file: '--params-file none.yaml'. Error: "),
    ],
)
def test_ros_arguments_are_refused_in_the_users_terms(answer, words, told):
    status, ((_, text),) = answer("--ros-args", *words)
    assert status == 2 and told in text and text.endswith(" (parameters come as -p NAME:=VALUE)")
    assert ".c:" not in text and "/src/" not in text
