# SPDX-License-Identifier: Apache-2.0
"""`source setup.bash`: from any folder, as often as one likes, without breaking the calling shell."""

import os
import subprocess
from pathlib import Path

import pytest
from eel_common.command.suite import commands
from test_packages import EXECUTABLES

ROOT = Path(__file__).resolve().parents[1]
NODES = ("gait_generator", "heading_controller", "pilot", "dynamics", "visualiser", "markers")


def shell(script: str, **environment: str) -> subprocess.CompletedProcess:
    """Run a script in a bash that has nothing of this test's own environment."""
    clean = {"HOME": os.environ.get("HOME", "/"), "PATH": "/usr/local/bin:/usr/bin:/bin", **environment}
    return subprocess.run(["bash", "-c", script], env=clean, cwd="/", capture_output=True, text=True, timeout=60)


def test_brings_python_and_nodes():
    done = shell(
        f"source '{ROOT}/setup.bash' && "
        "python -c 'import eel_core, eel_dynamics, eel_gaits, eel_msgs.msg, eel_viz, rclpy' && "
        "command -v eel " + " ".join(NODES)
    )
    assert done.returncode == 0, done.stderr
    found = done.stdout.splitlines()
    assert [Path(path).name for path in found] == ["eel", *NODES]
    assert all(Path(path).is_relative_to(ROOT / "install") for path in found)


def test_puts_eel_and_the_nodes_alone_on_the_path():
    """`eel NAME` and `ros2 run` reach the others, whose names may be those of a program, such as `identify`."""
    assert sorted(path.name for path in (ROOT / "install/bin").iterdir()) == sorted(["eel", *NODES])
    for package, names in EXECUTABLES.items():
        assert {path.name for path in (ROOT / "install" / package / "lib" / package).iterdir()} == names
        assert {name.removeprefix("eel_") for name in names} - {"eel", *NODES} <= set(commands())


def test_a_program_of_the_system_stays_in_its_place(tmp_path):
    others = {*(name for names in EXECUTABLES.values() for name in names), *commands()} - {"eel", *NODES}
    for name in others:
        (tmp_path / name).write_text("#!/bin/sh\n")
        (tmp_path / name).chmod(0o755)
    script = f"source '{ROOT}/setup.bash'; type -P {' '.join(sorted(others))}"
    found = shell(script, PATH=f"{tmp_path}:/usr/bin:/bin").stdout.splitlines()
    assert found == [str(tmp_path / name) for name in sorted(others)]


def test_twice_is_as_good_as_once():
    names = "PATH PYTHONPATH LD_LIBRARY_PATH AMENT_PREFIX_PATH"
    script = f"source '{ROOT}/setup.bash'; for name in {names}; do echo ${{!name}}; done"
    assert shell(f"source '{ROOT}/setup.bash'; {script}").stdout == shell(script).stdout


@pytest.mark.parametrize("options", ["-eu", "-e", "-u", "+eu"])
def test_leaves_the_shell_as_it_was(options):
    done = shell(
        f'set {options}; before=$-; source \'{ROOT}/setup.bash\'; [ "$before" = "$-" ]; '
        "compgen -v | grep _eel || true; compgen -A function | grep _eel || true; pwd"
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "/\n"


def test_keeps_what_was_there_and_leaves_a_sourced_ros_out():
    done = shell(
        f"source '{ROOT}/setup.bash'; echo $PYTHONPATH; echo $AMENT_PREFIX_PATH; echo $PATH",
        PYTHONPATH="/mine:/opt/ros/jazzy/lib/python3.12/site-packages",
        AMENT_PREFIX_PATH="/opt/ros/jazzy",
        PATH="/opt/ros/jazzy/bin:/usr/bin:/bin",
    )
    modules, prefixes, path = (line.split(":") for line in done.stdout.splitlines())
    assert modules[-1] == "/mine"
    assert path[-2:] == ["/usr/bin", "/bin"]
    assert not any(entry.startswith("/opt/ros") for entry in modules + prefixes + path)
    assert "/opt/ros" in done.stderr


def test_keeps_the_nodes_on_this_machine_unless_the_user_says_otherwise():
    script = f"source '{ROOT}/setup.bash'; echo $ROS_AUTOMATIC_DISCOVERY_RANGE"
    assert shell(script).stdout == "LOCALHOST\n"
    assert shell(script, ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET").stdout == "SUBNET\n"


def test_before_the_build_it_says_what_to_do(tmp_path):
    (tmp_path / "setup.bash").write_text((ROOT / "setup.bash").read_text())
    done = shell(f"source '{tmp_path}/setup.bash'; echo status $?")
    assert done.stdout == "status 1\n"
    assert "make -C" in done.stderr and len(done.stderr.splitlines()) == 1
