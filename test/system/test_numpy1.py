"""Ubuntu 24.04's own Python has numpy 1.26: messages, gaits and dynamics are built and run with it here.

A second virtual environment holds that numpy, and sees everything else of the first one.
"""

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("eel_msgs", "eel_gaits", "eel_dynamics")
SWIM = """
import json, sys
import numpy, numba, rclpy
from eel_dynamics import simulate
from eel_gaits import falling
from eel_msgs.msg import Backbone
from rclpy.serialization import deserialize_message, serialize_message

run = simulate(falling(), duration=0.5, accuracy="draft")
message = Backbone(x=run.x, position=run.backbone[-1].ravel())
back = deserialize_message(serialize_message(message), Backbone)
json.dump({
    "numpy": numpy.__version__,
    "built": sys.modules["eel_msgs"].__file__,
    "position": run.position.tolist(),
    "torque": run.torque.tolist(),
    "same": list(back.position) == run.backbone[-1].ravel().tolist(),
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
    pins = ROOT / "test/system/numpy1.txt"
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--require-hashes", "--only-binary", ":all:", "--target", site, "-r", pins]
    done = subprocess.run(install, capture_output=True, text=True, timeout=100)
    if done.returncode:
        pytest.skip(f"numpy 1.26 could not be had (no network?): {done.stderr.strip().splitlines()[-1]}")
    (site / "first_environment.pth").write_text(os.fspath(Path(np.__file__).parents[1]) + "\n")

    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    environment["AMENT_PREFIX_PATH"] = environment["CMAKE_PREFIX_PATH"] = sys.prefix
    environment["PATH"] = f"{python.parent}:{environment['PATH']}"
    colcon = [python, Path(sys.prefix) / "bin/colcon", "--log-base", folder / "log", "build"]
    done = subprocess.run(
        [*colcon, "--base-paths", ROOT / "src", "--packages-select", *PACKAGES, "--build-base", folder / "build",
         "--install-base", folder / "install", "--cmake-args", f"-DPython3_EXECUTABLE={python}"],
        env=environment, capture_output=True, text=True, timeout=100,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    installed = [next((folder / "install" / package).glob("lib/python3.*/site-packages")) for package in PACKAGES]
    environment["PYTHONPATH"] = ":".join(map(str, installed))
    environment["LD_LIBRARY_PATH"] = f"{folder}/install/eel_msgs/lib:{environment['LD_LIBRARY_PATH']}"
    environment["NUMBA_CACHE_DIR"] = str(folder / "numba_cache")
    return python, environment, folder


@pytest.mark.timeout(300)
def test_builds_and_swims_with_numpy_1(numpy1):
    from eel_dynamics import simulate
    from eel_gaits import falling

    python, environment, folder = numpy1
    done = subprocess.run([python, "-c", SWIM], env=environment, cwd=folder, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["numpy"].startswith("1.26.")
    assert Path(result["built"]).is_relative_to(folder / "install")
    assert result["same"]
    here = simulate(falling(), duration=0.5, accuracy="draft")
    np.testing.assert_allclose(result["position"], here.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(result["torque"], here.torque, rtol=0, atol=1e-10)
