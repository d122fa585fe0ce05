# SPDX-License-Identifier: Apache-2.0
"""Where the build cannot be done, it names the package that brings what is missing; pip builds it without ROS."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from eel_dynamics import simulate
from eel_gaits import falling

ROOT = Path(__file__).resolve().parents[1]
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


@pytest.mark.soak
def test_no_pybind11(configure):
    said = configure("-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON")
    assert "missing: pybind11" in said and "apt-get install pybind11-dev" in said and "pip install pybind11" in said


def test_no_such_level(configure):
    assert 'EEL_CORE_LEVELS must be of v2;v3;v4;native, got "v2;v5"' in configure("-DEEL_CORE_LEVELS=v2;v5")


@pytest.mark.timeout(400)
@pytest.mark.soak
@pytest.mark.parametrize("what", ["packages", "a checkout"])
def test_pip_installs_the_library_without_ros(tmp_path, what):
    """`pip install ./src/eel_{common,core,gaits,dynamics}` gives `simulate`, `pip install .` gives `eel` too."""
    environment = {name: os.environ[name] for name in ("PATH", "HOME", "LD_LIBRARY_PATH") if name in os.environ}
    environment["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    checkout = tmp_path / what  # a copy: setuptools leaves its own files beside the sources
    shutil.copytree(ROOT / "src", checkout / "src", ignore=shutil.ignore_patterns("*.egg-info", "__pycache__"))
    for name in ("CITATION.cff", "LICENSE", "NOTICES.md", "README.md", "pyproject.toml"):
        shutil.copy(ROOT / name, checkout)
    sources = [checkout]
    if what == "packages":
        sources = [checkout / "src" / name for name in ("eel_common", "eel_core", "eel_gaits", "eel_dynamics")]
    install = [sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index"]
    options = ["--target", tmp_path / "installed"]
    options += ["--config-settings=cmake.build-type=Debug", "--config-settings=cmake.define.EEL_CORE_LEVELS=v2"]
    done = subprocess.run([*install, *options, *sources], env=environment, capture_output=True, text=True, timeout=380)
    assert done.returncode == 0, done.stdout + done.stderr

    swim = f"""
import sys
sys.path.insert(0, {str(tmp_path / "installed")!r})
import eel_core, eel_dynamics
from eel_gaits import falling
assert eel_dynamics.__file__.startswith(sys.path[0]) and eel_core.__file__.startswith(sys.path[0])
run = eel_dynamics.simulate(falling(), 0.5)
assert not any(name in sys.modules for name in ("rclpy", "rerun", "eel_msgs"))
print(eel_core.build_info()["level"], run.position[-1, 0])
"""
    done = subprocess.run(
        [sys.executable, "-I", "-c", swim], env=environment, capture_output=True, text=True, timeout=90
    )
    assert done.returncode == 0, done.stderr
    level, forward = done.stdout.split()
    assert level == "x86-64-v2"
    assert float(forward) == pytest.approx(simulate(falling(), 0.5).position[-1, 0], rel=1e-9)
    command = ["simulate"] if what == "packages" else ["eel", "simulate"]
    command[0] = str(tmp_path / "installed/bin" / command[0])
    environment["PYTHONPATH"] = str(tmp_path / "installed")
    done = subprocess.run(
        [*command, "falling", "--duration", "0.5"], env=environment, capture_output=True, text=True, timeout=90
    )
    assert done.returncode == 0 and "wall time" in done.stdout, done.stderr
