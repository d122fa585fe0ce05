# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C while a node or command starts ends it silently; where the shell leaves too little room, one line says so."""

import os
import random
import signal
import time

import pytest
from test_packages import EXECUTABLES

COMMANDS = [name for names in EXECUTABLES.values() for name in sorted(names)]
NODES = ("gait_generator", "heading_controller", "pilot", "dynamics", "visualiser", "markers")
WORDS = {
    "visualiser": ("--ros-args", "-p", "sink:=[save]"),
    "record": ("-o", "bag"),
    "eel_echo": ("odom",),
    "eel": ("simulate",),
    "simulate": ("--duration", "2000", "--accuracy", "reference"),  # longer than the test
}
FIRST = {"record": "rclpy", "render": "PIL"}  # module at whose import it is stopped, where that is not numpy
# Stands still where the module that the variable names is imported, or at the interpreter's start; LIMIT is far above
# what a signal takes to end a process.
STANDSTILL = """
import os, pathlib, sys, time
def stand_still(seconds):
    pathlib.Path(os.environ["STANDS_STILL"]).touch()
    time.sleep(seconds)
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == os.environ["AT"]:
            stand_still(60.0)
sys.meta_path.insert(0, Finder())
if os.environ["AT"] == "site":
    stand_still(1.0)
"""
LIMIT = 30.0  # s


@pytest.fixture
def start_until(start, tmp_path, monkeypatch):
    """start_until(place, executable, *arguments) -> NodeProcess, which stands still there: at the interpreter's start
    (`site`), or at the import of a module."""
    (tmp_path / "sitecustomize.py").write_text(STANDSTILL)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}")
    monkeypatch.chdir(tmp_path)

    def start_there(place, executable, *arguments):
        reached = tmp_path / "reached"
        monkeypatch.setenv("AT", place)
        monkeypatch.setenv("STANDS_STILL", str(reached))
        node = start(executable, *arguments)
        deadline = time.monotonic() + 90.0
        while not reached.exists():
            assert node.status is None and time.monotonic() < deadline, node.output()
            time.sleep(0.01)
        return node

    return start_there


@pytest.mark.fault(
    "ending", "Ctrl-C while any node or command imports its libraries", "it ends at once, silently, as by SIGINT (130)"
)
@pytest.mark.parametrize("executable", COMMANDS)
def test_an_interrupt_during_the_imports_is_silent(executable, start_until):
    node = start_until(FIRST.get(executable, "numpy"), executable, *WORDS.get(executable, ()))
    assert (node.interrupt(timeout=LIMIT), node.output()) == (-signal.SIGINT, "")


@pytest.mark.parametrize(
    ("place", "executable"),
    [("rclpy", "pilot"), ("rclpy", "dynamics"), ("rerun", "visualiser"), ("eel_core", "simulate")],
)
def test_an_interrupt_during_a_later_import_is_silent(place, executable, start_until):
    node = start_until(place, executable, *WORDS.get(executable, ()))
    assert (node.interrupt(timeout=LIMIT), node.output()) == (-signal.SIGINT, "")


@pytest.mark.parametrize("executable", ["dynamics", "simulate"])
def test_an_interrupt_while_python_itself_starts_is_silent(executable, start_until):
    node = start_until("site", executable)
    assert (node.interrupt(timeout=LIMIT), node.output()) == (-signal.SIGINT, "")


@pytest.mark.parametrize("module", ["eel_studies.sweeps.command", "eel_viz.ros.record", "eel_gaits.ros.node"])
def test_an_interrupt_of_a_module_that_python_runs_is_silent(module, start_until):
    node = start_until("rclpy" if "record" in module else "numpy", "python", "-m", module)
    assert (node.interrupt(timeout=LIMIT), node.output()) == (-signal.SIGINT, "")


def test_nodes_and_commands_begin_without_scipy(start):
    """To import its interpolation takes as long as all else of the dynamics node: what needs it imports it then."""
    modules = [f"eel_gaits.ros.{name}" for name in ("node", "heading_controller", "pilot")]
    modules += ["eel_dynamics.ros.node", "eel_dynamics.commands.simulate", "eel_viz.ros.node", "eel_studies", "eel_gym"]
    process = start("python", "-c", f"import {', '.join(modules)}, sys; assert 'scipy' not in sys.modules")
    assert process.wait(90.0) == 0, process.output()


def test_as_a_library_a_package_leaves_the_handler_of_signals_alone(start):
    code = "import signal, eel_gaits, eel_dynamics, eel_viz; "
    code += "assert signal.getsignal(signal.SIGINT) is signal.default_int_handler"
    process = start("python", "-c", code)
    assert process.wait(90.0) == 0, process.output()


def ends_silently(start, executable, moment) -> bool:
    """Whether a signal at the `moment` [s] after the start ends it well. By then a node may have logged, and a command
    have said in one line how far it is or what it lacks (status 2)."""
    node = start(executable, *WORDS.get(executable, ()))
    time.sleep(moment)  # the moment of the signal is what is tried here
    status = node.interrupt(timeout=LIMIT)
    own = "[INFO]" if executable in NODES else ("eel ", "[INFO]")
    good = (0, -signal.SIGINT) if executable in NODES else (0, 2, -signal.SIGINT)
    return status in good and all(line.startswith(own) for line in node.output().splitlines())


@pytest.mark.parametrize("executable", NODES)
def test_an_interrupt_at_a_moment_of_the_start_is_silent(executable, start, fresh_domain, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for moment in (0.1, 0.4, 0.8):
        assert ends_silently(start, executable, moment), moment


@pytest.mark.soak
@pytest.mark.timeout(600)
@pytest.mark.parametrize("executable", COMMANDS)
def test_an_interrupt_at_25_moments_of_the_start_is_silent(executable, start, fresh_domain, tmp_path, monkeypatch):
    moments = random.Random(executable)
    for k in range(25):
        folder = tmp_path / str(k)  # of bag and recording
        folder.mkdir()
        monkeypatch.chdir(folder)
        moment = moments.uniform(0.0, 2.5)
        assert ends_silently(start, executable, moment), moment


@pytest.mark.fault("ending", "Ctrl-C in `eel sweep` while it works", "status 130, one line: the same command goes on")
def test_an_interrupt_in_mid_sweep_says_how_it_goes_on(start, tmp_path):
    words = ("straight", "--vary", "period=0.5:2:2000", "--duration", "20", "--bare", "--out", str(tmp_path / "s.nc"))
    sweep = start("sweep", *words)
    deadline = time.monotonic() + 90.0
    while not list(tmp_path.glob("s.nc.parts/*")):
        assert sweep.status is None and time.monotonic() < deadline, sweep.output()
        time.sleep(0.02)
    assert sweep.interrupt() == 130
    assert sweep.output().splitlines()[-1] == "eel sweep: interrupted; the same command goes on from here"
    assert "Traceback" not in sweep.output()


@pytest.mark.fault(
    "parameters",
    "a shell that leaves too little room (`ulimit -n 16`, `ulimit -v 400000`), for any node or command",
    "status 2, one line with limit and need",
)
@pytest.mark.parametrize("limit", ["-n 16", "-v 400000"])
@pytest.mark.parametrize("executable", ["dynamics", "visualiser", "eel simulate"])
def test_too_little_room_is_one_line(executable, limit, start):
    node = start("bash", "-c", f"ulimit {limit}; exec {executable}")
    assert node.wait(90.0) == 2
    (line,) = node.output().splitlines()
    assert line.startswith(f"{executable.split()[0]}: at least ") and f"(ulimit {limit.split()[0]})" in line


def test_the_least_number_of_open_files_suffices(start, fresh_domain, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    nodes = [
        start("bash", "-c", 'ulimit -n 64; exec "$@"', "-", executable, *WORDS.get(executable, ()))
        for executable in ("gait_generator", "dynamics", "visualiser")
    ]
    nodes[1].wait_for_output("adopted")
    nodes[2].wait_for_output("saving to")
    for node in nodes:
        assert node.interrupt() == 0 and "Error" not in node.output(), node.output()
