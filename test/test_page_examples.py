# SPDX-License-Identifier: Apache-2.0
"""The examples of README.md and docs: Python runs, and shell lines name commands, options and parameters that exist.

Blocks of a page run one after the other in one name space and one folder. A block below `<!-- listing ... -->` only
shows a file. A block without a language is shell. The commands of `RUN` run; of others the options are looked up, of
nodes the parameters.
"""

import contextlib
import importlib
import io
import re
import shlex
from functools import cache
from pathlib import Path

import pytest
from eel_common.command import suite
from eel_common.command.suite import commands
from eel_common.topics import OWN
from reference_pages import COMMANDS, NODES, ROOT, parameter_names
from test_run_from_bag import write_bag

from eel_dynamics import simulate
from eel_gaits import straight

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r"(?:<!-- (listing)[^\n]*-->\n)?^```([^\n`]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
DEAR = ("bag_to_figure", "gallery", "identify", "index", "motions", "motors", "optimise", "own_controller")
DEAR += ("own_robot", "pilot", "recordings", "scenes", "sensors", "sweeps")  # a second or more; the README stays
RUN = ("eel simulate", "eel identify", "eel ballast")
FOREIGN = ("colcon", "dask", "export", "pip", "python", "python3", "rerun", "rosdep", "source", "sudo", "touch")
FOREIGN += ("ekf_node", "robot_state_publisher", "ros2_control_node", "rviz2", "spawner")  # of ROS 2
INPUTS = ("goal_path", "goal_pose", "current", "joint_commands", "fin_command")  # of the pilot, of the dynamics node
SERVICES = ("reset", "pause", "step", "set_state")


def blocks(page: Path, language: str) -> list[str]:
    """The blocks of a page in that language, listings left out."""
    return [text for listing, name, text in BLOCK.findall(page.read_text()) if name == language and not listing]


def run_python(page: Path) -> dict:
    """The name space that the Python blocks of a page leave."""
    space: dict = {"__name__": "__main__"}
    for number, source in enumerate(blocks(page, "python"), 1):
        exec(compile(source, f"{page.name}, block {number}", "exec"), space)
    return space


def lines_of(block: str) -> list[list[str]]:
    """The words of each command in a block, without comments."""
    block = re.sub(r"\\\n", " ", re.sub(r"\s#.*$", "", block, flags=re.MULTILINE))
    commands = [part.strip() for line in block.splitlines() for part in re.split(r"&&|&", line)]
    return [shlex.split(command) for command in commands if command]


@cache
def main_of(name: str):
    """The function that a command of `eel` calls."""
    return commands()[name.removeprefix("eel ")].load().main


@cache
def help_of(name: str) -> str:
    said = io.StringIO()
    with contextlib.redirect_stdout(said), pytest.raises(SystemExit):
        main_of(name)(["--help"])
    return said.getvalue()


def check(words: list[str]):
    """`AssertionError` where the command names what does not exist."""
    name, *rest = words
    if name == "ros2" and rest[0] == "run":
        name, *rest = rest[2:]
    if name == "eel" and rest:
        name, *rest = f"eel {rest[0]}", *rest[1:]
    if words == ["eel", "--version"]:
        assert suite.main(["--version"]) == 0
    elif name in NODES:
        for given in (rest[k + 1] for k, word in enumerate(rest) if word == "-p"):
            parameter, sign, value = given.partition(":=")
            assert parameter in parameter_names(name) and sign and value, words
    elif name in RUN:
        assert main_of(name)(rest) == 0, words
    elif name in COMMANDS:
        options = [
            word for word in rest[: (rest.index("--ros-args") if "--ros-args" in rest else None)] if word[0] == "-"
        ]
        assert [option for option in options if not re.search(rf"(?<!\S){option}\b", help_of(name))] == [], words
    elif name == "make":
        assert re.search(rf"^{rest[0]}:", (ROOT / "Makefile").read_text(), re.MULTILINE), words
    elif name == "ros2":
        check_ros2(words, *rest)
    else:
        assert name in FOREIGN, words


def check_ros2(words, group, verb, *rest):
    """The ros2 command: topics, parameters and services are the nodes' own."""
    if group == "topic":
        topic = next(word for word in rest if not word.startswith("-"))
        assert topic.removeprefix("/") in (*OWN, *INPUTS), words
    elif (group, verb) == ("param", "set"):
        assert rest[1] in parameter_names(rest[0].removeprefix("/")), words
    elif group == "service":
        _, node, service = rest[0].split("/")
        module, _, kind = rest[1].replace("/", ".").rpartition(".")
        assert node in NODES and service in SERVICES and hasattr(importlib.import_module(module), kind), words
    else:
        assert (group, verb) in (("bag", "record"),), words


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The working folder of a page; figures are drawn without a display."""
    import matplotlib

    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    with matplotlib.rc_context():
        yield tmp_path


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.soak] if page.stem in DEAR else [])
        for page in PAGES
        if blocks(page, "python") or blocks(page, "")
    ],
)
def test_python_of_a_page_runs_and_its_shell_names_what_exists(page, folder):
    """In one folder: some commands read files that the Python before them has written, or the measured files."""
    (folder / "docs").symlink_to(ROOT / "docs")
    if page.stem == "bag_to_figure":
        write_bag(folder / "bag", simulate(straight(period=0.8), 4.0, sample_period=0.02, load=True))
    if page.stem == "scenes":
        (folder / "scene.yaml").write_text(blocks(page, "yaml")[0])
    space = run_python(page)
    if page.stem == "own_controller":
        assert space["heading"] == pytest.approx(0.6, abs=0.1) and space["depth"] == pytest.approx(0.3, abs=0.03)
    for block in blocks(page, ""):
        for words in lines_of(block):
            check(words)


@pytest.mark.parametrize(
    "line",
    [
        "dynamics --ros-args -p exactness:=fine",
        "eel render run.rrd --speeed 2",
        "make nothing",
        "ros2 service call /dynamics/nothing std_srvs/srv/Trigger",
        "ros2 topic echo /nothing",
        "unknown --option",
        "eel unknown",
        "simulate",
    ],
)
def test_a_shell_line_that_is_wrong_is_found(line):
    with pytest.raises(AssertionError):
        check(shlex.split(line))
