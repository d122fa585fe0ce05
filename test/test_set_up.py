# SPDX-License-Identifier: Apache-2.0
"""Which steps `make build` makes in a new folder, again, after an interruption, in a moved folder, and twice at once.

A Python that only writes down its calls stands in for the real one: every other test runs in what the real one makes.
"""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ALL = ["venv", "pip", "uv", "relocate", "colcon"]
PYTHON = f"""#!/bin/bash
case "$*" in
    -V | -I*) exec "{sys.executable}" "$@" ;;
    "-m venv .venv") step=venv; mkdir -p .venv/bin; cp "$0" .venv/bin/python ;;
    "-m pip "*) step=pip ;;
    *uv_with_pip_settings.py*) step=uv ;;
    *relocate_wheels.py) step=relocate ;;
    *colcon*) step=colcon; mkdir -p install/eel_msgs/lib/eel_msgs; touch install/eel_msgs/lib/eel_msgs/node ;;
esac
echo "$step $*" >> "$CALLS"
[[ "$*" != $FAILS ]] || exit 1
while [[ "$*" == $HOLDS && ! -e "$CALLS.go_on" ]]; do sleep 0.02; done
"""


class Folder:
    """A copy of this folder's tools, with a little of its sources."""

    def __init__(self, path: Path) -> None:
        self.path, self.calls = path / "copy", path / "calls"
        shutil.copytree(ROOT / "tools", self.path / "tools")
        for requirements in ROOT.glob("requirements*.txt"):
            shutil.copy(requirements, self.path)
        self.python = path / "python"
        self.python.write_text(PYTHON)
        self.python.chmod(0o755)
        self.write("src/eel_msgs/msg/Ramp.msg", "float64 start\n")
        self.write("src/eel_core/eel_core/processor.py", "print('v3')\n")
        self.calls.touch()

    def write(self, name: str, text: str) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        (self.path / name).write_text(text)

    def begin(self, *, fails: str = "", holds: str = "") -> subprocess.Popen:
        """Starts tools/build.sh; calls of Python that match the pattern `fails` fail, those like `holds` do not end."""
        environment = {"PATH": "/usr/bin:/bin", "PYTHON": str(self.python), "CALLS": str(self.calls)}
        return subprocess.Popen(
            ["bash", self.path / "tools/build.sh"],
            env=environment | {"FAILS": fails, "HOLDS": holds},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def build(self, *, fails: str = "") -> tuple[int, str, list[str]]:
        """Status and output of tools/build.sh, and the calls of Python that it made."""
        before = len(self.called())
        process = self.begin(fails=fails)
        output, _ = process.communicate(timeout=120)
        return process.returncode, output, self.called()[before:]

    def go_on(self) -> None:
        """What is held ends."""
        Path(f"{self.calls}.go_on").touch()

    def called(self) -> list[str]:
        return self.calls.read_text().splitlines()

    def await_call(self, step: str) -> None:
        deadline = time.monotonic() + 120
        while step not in steps(self.called()):
            assert time.monotonic() < deadline, self.called()
            time.sleep(0.02)


def steps(calls: list[str]) -> list[str]:
    return [call.split()[0] for call in calls]


@pytest.fixture
def folder(tmp_path):
    folder = Folder(tmp_path)
    yield folder
    folder.go_on()  # what a failed test holds


def test_the_first_call_makes_every_step_and_the_second_none(folder):
    status, output, calls = folder.build()
    assert (status, sorted(steps(calls))) == (0, sorted(ALL)), output
    assert steps(calls)[:4] == ALL[:4]
    assert folder.build() == (0, "", [])


def test_everything_that_is_installed_is_pinned_by_hash(folder):
    _, _, calls = folder.build()
    installs = [call for call in calls if call.startswith(("pip", "uv"))]
    assert len(installs) == 2
    assert all("--require-hashes" in call and "--only-binary :all:" in call for call in installs)


def test_where_uv_fails_pip_installs_the_same(folder):
    status, output, calls = folder.build(fails="*uv_with_pip_settings.py*")
    assert status == 0, output
    assert steps(calls)[:5] == ["venv", "pip", "uv", "pip", "relocate"]
    asked = [[word for word in calls[k].split() if word.startswith("requirements")] for k in (2, 3)]
    assert asked[0] == asked[1] == ["requirements.txt", "requirements-ros.txt", "requirements-dev.txt"]
    assert "--require-hashes" in calls[3]
    (line,) = [line for line in output.splitlines() if "uv failed" in line]
    assert "pip takes over" in line


def test_where_nothing_can_be_installed_the_last_line_names_the_log_and_the_next_call_begins_anew(folder):
    status, output, _ = folder.build(fails="*requirements-dev.txt*")
    assert status == 1
    assert ".venv/install.log" in output.splitlines()[-1]
    status, _, calls = folder.build()
    assert (status, sorted(steps(calls))) == (0, sorted(ALL))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    ("during", "holds", "again"), [("uv", "*uv_with*", {*ALL}), ("colcon", "*colcon*", {"colcon"})]
)
def test_an_interrupted_call_is_made_good_by_the_next(folder, number, during, holds, again):
    process = folder.begin(holds=holds)
    folder.await_call(during)
    os.killpg(process.pid, number)
    process.communicate(timeout=120)
    assert process.returncode != 0
    status, output, calls = folder.build()
    assert status == 0, output
    assert set(steps(calls)) == again


def test_a_moved_folder_is_built_anew(folder, tmp_path):
    folder.build()
    folder.path = folder.path.rename(tmp_path / "moved here")
    status, output, calls = folder.build()
    assert (status, sorted(steps(calls))) == (0, sorted(ALL)), output


def test_of_two_calls_at_once_the_second_waits_and_finds_all_done(folder):
    first = folder.begin(holds="*colcon*")
    folder.await_call("colcon")
    second = folder.begin()
    assert "waiting" in second.stdout.readline()
    folder.go_on()
    output, _ = first.communicate(timeout=120)
    assert first.returncode == 0, output
    assert second.communicate(timeout=120)[0] == ""
    assert second.returncode == 0
    assert sorted(steps(folder.called())) == sorted(ALL)


def test_a_changed_message_is_built_and_a_changed_python_file_works_as_it_is(folder):
    folder.build()
    folder.write("src/eel_msgs/msg/Ramp.msg", "float64 end\n")
    assert steps(folder.build()[2]) == ["colcon"]
    folder.write("src/eel_viz/eel_viz/pictures/render.py", "pass\n")
    assert folder.build() == (0, "", [])
