"""Where the build cannot be done, it names the package that brings what is missing; pip builds it without ROS."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src/eel_core"


@pytest.fixture
def configure(tmp_path):
    """configure(*arguments, **environment): what CMake says of the package's build; it must fail."""

    def run(*arguments: str, **environment: str) -> str:
        command = [
            "cmake",
            "-S",
            SOURCE,
            "-B",
            tmp_path / "build",
            f"-DPython3_EXECUTABLE={sys.executable}",
            *arguments,
        ]
        done = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, timeout=220)
        assert done.returncode != 0
        return " ".join(done.stderr.split())

    return run


def test_no_compiler(configure):
    assert "missing: a C++ compiler. On Debian or Ubuntu: sudo apt-get install g++" in configure(CXX="/nowhere/c++")


def test_compiler_without_cxx20(configure, tmp_path):
    compiler = tmp_path / "c++"
    compiler.write_text('#!/bin/bash\ncase "$*" in *std=*20*|*std=*2a*) exit 1 ;; esac\nexec c++ "$@"\n')
    compiler.chmod(0o755)
    said = configure(CXX=str(compiler))
    assert "missing: C++20" in said and "apt-get install g++" in said


def test_no_pybind11(configure):
    said = configure("-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON")
    assert "missing: pybind11" in said and "apt-get install pybind11-dev" in said and "pip install pybind11" in said


def test_no_such_level(configure):
    assert 'EEL_CORE_LEVELS must be of v2;v3;v4;native, got "v2;v5"' in configure("-DEEL_CORE_LEVELS=v2;v5")


@pytest.mark.timeout(400)  # compiles two modules
def test_pip_installs_it_without_ros(tmp_path):
    """With a module for each level; the one for this processor is imported."""
    environment = {name: os.environ[name] for name in ("PATH", "HOME", "LD_LIBRARY_PATH") if name in os.environ}
    environment["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    install = [sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index"]
    options = ["--target", tmp_path, "-C", "cmake.build-type=Debug", "-C", "cmake.define.EEL_CORE_LEVELS=v2;v3"]
    options += ["-C", f"build-dir={tmp_path}/build"]
    done = subprocess.run([*install, *options, SOURCE], env=environment, capture_output=True, text=True, timeout=380)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {path.name.split(".")[0] for path in (tmp_path / "eel_core").glob("_core_*")} == {"_core_v2", "_core_v3"}

    show = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import eel_core; print(eel_core.build_info()['level'])"
    for level in ("", "v2"):
        done = subprocess.run(
            [sys.executable, "-I", "-c", show],
            env={**environment, "EEL_CORE_LEVEL": level},
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert done.returncode == 0, done.stderr
        assert done.stdout.strip() == "x86-64-v2" if level else done.stdout.startswith("x86-64-v")
