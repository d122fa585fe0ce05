# SPDX-License-Identifier: Apache-2.0
"""What the machine lacks is named in one line, with the command that brings it; nothing is made before that."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from eel_command import LEAST_PYTHON

ROOT = Path(__file__).resolve().parents[1]
PYENV = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
OLD_PYTHONS = [path for minor in (8, 9, 10) for path in sorted(PYENV.glob(f"versions/3.{minor}.*/bin/python"))]
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


def test_too_old_a_python(machine, tmp_path):
    python = tmp_path / "python3.10"
    python.write_text("#!/bin/bash\necho 3.10\n")
    python.chmod(0o755)
    line = machine(python=python)
    assert line.endswith(f"PYTHON={python} is not a Python from 3.11 to 3.13 that runs, found: {python} (3.10)")


@pytest.mark.parametrize("version", [(3, 10, 13), (3, 8, 18)])
def test_a_command_refuses_too_old_a_python(version):
    """One that a PYTHONPATH brings to the packages: pip installs nothing in it."""
    old = f"import sys; sys.version_info = {version}; sys.argv = ['eel']; import eel_command"
    done = subprocess.run(
        [sys.executable, "-c", f"{old}; eel_command.main_of.eel_common.command.suite()"], capture_output=True, text=True
    )
    (line,) = done.stderr.splitlines()
    assert done.returncode == 2 and done.stdout == ""
    assert line.startswith(
        f"eel: Python 3.11 or later is needed, and {sys.executable} is {'.'.join(map(str, version))}: "
    )
    assert "make build PYTHON=python3.12" in line and "pip install" in line


def test_pip_refuses_the_same_pythons():
    least = ".".join(map(str, LEAST_PYTHON))
    files = [*ROOT.glob("src/*/setup.py"), *ROOT.glob("src/*/pyproject.toml"), ROOT / "pyproject.toml"]
    said = {path: re.findall(r'(?:python_requires=|requires-python = )"(.*)"', path.read_text()) for path in files}
    assert len(said) == 8 and set(map(tuple, said.values())) == {(f">={least}",)}, said


@pytest.mark.parametrize("python", OLD_PYTHONS or [pytest.param("", marks=pytest.mark.skip(reason="no older Python"))])
def test_an_older_python_reads_what_refuses_it(python):
    done = subprocess.run(
        [python, "-c", "from eel_command import main_of; main_of.eel_common.command.suite()"],
        env={"PYTHONPATH": os.fspath(ROOT / "src/eel_common")},
        capture_output=True,
        text=True,
    )
    (line,) = done.stderr.splitlines()
    assert done.returncode == 2 and "Python 3.11 or later is needed" in line


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
