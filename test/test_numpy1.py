# SPDX-License-Identifier: Apache-2.0
"""Ubuntu 24.04's own Python has numpy 1.26: messages, gaits and dynamics are built and run with it here.

A second virtual environment holds that numpy, and sees everything else of the first one. eel_core is built without
numpy's headers: the one that is installed serves both.
"""

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

import numpy as np
import pytest

import eel_core

ROOT = Path(__file__).resolve().parents[1]
SWIM = """
import json, sys
import numpy
from eel_dynamics import simulate
from eel_gaits import falling

run = simulate(falling(), duration=0.5, accuracy="draft")
json.dump({"numpy": numpy.__version__, "position": run.position.tolist(), "torque": run.torque.tolist()}, sys.stdout)
"""
TALK = """
import json, sys
import numpy
from eel_dynamics.ros import messages
from eel_gaits import falling
from eel_gaits.ros.messages import law_from_message, law_to_message
from eel_msgs.msg import Backbone, CurvatureLaw
from rclpy.serialization import deserialize_message, serialize_message

backbone = Backbone(x=numpy.linspace(0.0, 1.0, 51))
law = deserialize_message(serialize_message(law_to_message(falling())), CurvatureLaw)
json.dump({
    "numpy": numpy.__version__,
    "built": [sys.modules[name].__file__ for name in ("eel_msgs", "eel_gaits", "eel_dynamics")],
    "backbone": deserialize_message(serialize_message(backbone), Backbone) == backbone,
    "law": law_from_message(law) == falling(),
}, sys.stdout)
"""


@pytest.fixture(scope="module")
def numpy1(tmp_path_factory):
    """Environment variables of a build of the packages with numpy 1.26, and its interpreter."""
    if sys.version_info >= (3, 13):
        pytest.skip("numpy 1.26 exists for Python 3.12 and older")
    folder = tmp_path_factory.mktemp("numpy1")
    venv.create(folder / "venv", with_pip=False, symlinks=True)
    python = folder / "venv/bin/python"
    site = next((folder / "venv/lib").glob("python3.*/site-packages"))
    pins = ROOT / "test/numpy1.txt"
    install = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--require-hashes",
        "--only-binary",
        ":all:",
        "--target",
        site,
        "-r",
        pins,
    ]
    done = subprocess.run(install, capture_output=True, text=True, timeout=300)
    if done.returncode:
        pytest.skip(f"numpy 1.26 could not be had (no network?): {done.stderr.strip().splitlines()[-1]}")
    (site / "first_environment.pth").write_text(os.fspath(Path(np.__file__).parents[1]) + "\n")

    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment["AMENT_PREFIX_PATH"] = environment["CMAKE_PREFIX_PATH"] = sys.prefix
    environment["PATH"] = f"{python.parent}:{environment['PATH']}"
    return python, environment, folder


def build(numpy1) -> dict[str, str]:
    """Build the packages with colcon; environment variables in which they are found."""
    python, environment, folder = numpy1
    done = subprocess.run(
        [python, Path(sys.prefix) / "bin/colcon", "--log-base", folder / "log", "build",
         "--build-base", folder / "build", "--install-base", folder / "install",
         "--base-paths", *(ROOT / "src" / f"eel_{name}" for name in ("msgs", "common", "gaits", "dynamics")),
         "--cmake-args", f"-DPython3_EXECUTABLE={python}"],
        env=environment, cwd=folder, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    installed = [os.fspath(path) for path in (folder / "install").glob("*/lib/python3.*/site-packages")]
    libraries = [os.fspath(path) for path in (folder / "install").glob("*/lib")]
    return environment | {
        "PYTHONPATH": ":".join([*installed, os.fspath(Path(eel_core.__file__).parents[1])]),
        "LD_LIBRARY_PATH": ":".join([*libraries, environment["LD_LIBRARY_PATH"]]),
    }


@pytest.mark.soak
@pytest.mark.timeout(900)
def test_builds_swims_and_talks_with_numpy_1(numpy1):
    from eel_dynamics import simulate
    from eel_gaits import falling

    python, _, folder = numpy1
    environment = build(numpy1)

    def run(code: str) -> dict:
        done = subprocess.run(
            [python, "-c", code], env=environment, cwd=folder, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    said = run(TALK)
    assert said["numpy"].startswith("1.26.")
    assert all(Path(path).is_relative_to(folder / "install") for path in said["built"])
    assert said["backbone"] and said["law"]

    swum = run(SWIM)
    assert swum["numpy"].startswith("1.26.")
    here = simulate(falling(), duration=0.5, accuracy="draft")
    np.testing.assert_allclose(swum["position"], here.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(swum["torque"], here.torque, rtol=0, atol=1e-10)
