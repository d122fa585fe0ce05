# SPDX-License-Identifier: Apache-2.0
"""What the machine lacks is named in one line, with the command that brings it; nothing is made before that."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
NEEDED = """
    bash sh env sed awk cat tee uname find sort xargs sha256sum cut flock rm mkdir touch dirname
"""


@pytest.fixture
def machine(tmp_path):
    """build(lacks=..., python=...) in a copy of this folder's tools, on a machine that has little."""
    commands, copy = tmp_path / "bin", tmp_path / "copy"
    commands.mkdir()
    shutil.copytree(ROOT / "tools", copy / "tools")
    for path in ROOT.glob("requirements*.txt"):
        shutil.copy(path, copy)
    for name in [*NEEDED.split(), "cc", "c++", "make"]:
        (commands / name).symlink_to(shutil.which(name))

    def build(*, lacks=(), python=sys.executable):
        for name in lacks:
            (commands / name).unlink()
        environment = {"PATH": os.fspath(commands), "HOME": os.fspath(tmp_path), "PYTHON": os.fspath(python)}
        done = subprocess.run(
            ["bash", copy / "tools/build.sh"], env=environment, capture_output=True, text=True, timeout=20
        )
        assert done.returncode == 1
        assert not (copy / ".venv").exists()
        (line,) = done.stderr.splitlines()
        return line

    def interpreter(refuses):
        """A Python whose `-c` fails where the text contains `refuses`."""
        path = tmp_path / "python"
        path.write_text(f'#!/bin/bash\ncase "$*" in *{refuses}*) exit 1 ;; esac\nexec "{sys.executable}" "$@"\n')
        path.chmod(0o755)
        return path

    build.interpreter = interpreter
    return build


def test_no_compiler(machine):
    line = machine(lacks=["c++"])
    assert "C++ compiler" in line and "apt-get install build-essential" in line


def test_no_venv(machine):
    line = machine(python=machine.interpreter("ensurepip"))
    assert "venv" in line and f"apt-get install python3.{sys.version_info.minor}-venv" in line


def test_no_headers(machine):
    line = machine(python=machine.interpreter("Python.h"))
    assert "headers" in line and f"apt-get install python3.{sys.version_info.minor}-dev" in line


def test_no_such_python(machine, tmp_path):
    line = machine(python=tmp_path / "nowhere/python")
    assert str(tmp_path / "nowhere/python") in line and "3.11 to 3.13" in line


def test_other_architecture(machine, tmp_path):
    uname = tmp_path / "bin/uname"
    uname.unlink()  # a link to the machine's own
    uname.write_text('#!/bin/bash\n[ "$1" = -m ] && echo aarch64 || echo Linux\n')
    uname.chmod(0o755)
    line = machine()
    assert "x86-64 Linux" in line and "aarch64" in line


@pytest.mark.fault("names", "a build in a folder whose path has a space and an umlaut", "the executables run there")
def test_an_executable_in_a_path_with_a_space_runs(tmp_path):
    root = tmp_path / "ein Bär"
    (root / ".venv/bin").mkdir(parents=True)
    (root / ".venv/bin/python").symlink_to(sys.executable)
    script = root / "swim"
    script.write_text(f'#!"{root}/.venv/bin/python" -x\nimport sys\nprint(sys.argv[1:])\n')  # as setuptools writes it
    script.chmod(0o755)
    function = f"source <(sed -n '/^begin_with_sh()/,/^}}/p' '{ROOT}/tools/build.sh')"
    for _ in range(2):  # the second time changes nothing
        subprocess.run(
            ["bash", "-euc", f'{function}; begin_with_sh "$1"', "-", script],
            env={**os.environ, "root": str(root)},
            check=True,
        )
        done = subprocess.run([script, "a b"], capture_output=True, text=True, timeout=60)
        assert done.stdout == "['a b']\n", done.stderr
