# SPDX-License-Identifier: Apache-2.0
"""For the tests of all packages: every session in a ROS domain of its own, and no process left behind.

A pytest plugin: `-p eel_common.ros.testing.fixtures`.
"""

import contextlib
import json
import math
import os
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from eel_common.ros import fastdds_profile
from eel_common.ros.testing.node_process import NodeProcess
from eel_common.ros.testing.ros_domain import reserve_domain

MARKERS = (
    "soak: takes minutes; run by make soak",
    "fault(group, fault, outcome): a row of out/robustness.md, which `make robustness` writes",
    "identity(name): a test whose measured values go into docs/appendix/validation.csv, under that heading",
)

STARTS_IN_TURN = """
import contextlib, importlib, io, json, sys
main = importlib.import_module(sys.argv[1]).main
for words in json.load(open(sys.argv[2])):
    sys.argv = ["node", *words]
    with contextlib.redirect_stderr(io.StringIO()) as said:
        try:
            status = main()
        except SystemExit as end:
            status = end.code
    print(json.dumps([status, said.getvalue()]), flush=True)
"""


def pytest_configure(config: Any) -> None:
    """Register the markers."""
    for marker in MARKERS:
        config.addinivalue_line("markers", marker)


def pytest_itemcollected(item: Any) -> None:
    """`pytest.UsageError` for an id with an address: it differs between processes, and `-n` deals tests out by id."""
    if " at 0x" in item.nodeid:
        raise pytest.UsageError(f"{item.nodeid} has the address of an object: give ids")


@pytest.fixture(scope="session", autouse=True)
def ros_domain(tmp_path_factory: Any) -> Iterator[int]:
    """The number of a ROS domain that nobody else on this machine uses; in the environment for the whole session."""
    domain = reserve_domain()
    fastdds_profile.use_profile()
    os.environ.pop("ROS_LOCALHOST_ONLY", None)
    os.environ.update(domain.environment())
    os.environ["ROS_LOG_DIR"] = str(tmp_path_factory.mktemp("ros_log"))
    yield domain.number
    domain.claim.close()


@pytest.fixture(autouse=True)
def no_progress_on_a_slow_machine(monkeypatch: Any) -> None:
    """The output of a command in this process does not depend on its run time."""
    monkeypatch.setattr("eel_common.command.progress.QUIET", math.inf)


@pytest.fixture
def fresh_domain(monkeypatch: Any) -> Iterator[int]:
    """A domain for one test, which counts messages or publishers; in the environment while the test lasts."""
    domain = reserve_domain()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain.number))
    yield domain.number
    domain.claim.close()


# Fast DDS without shared memory. It obeys FASTDDS_BUILTIN_TRANSPORTS only if no discovery range is set.
OVER_UDP = {
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
    fastdds_profile.VARIABLE: str(Path(__file__).with_name("loopback_udp.xml")),
}


def starter(folder: Path, **settings: str) -> Iterator[Callable[..., NodeProcess]]:
    """Yields start(executable, *arguments) -> NodeProcess, and ends what it started; output goes to `folder`.

    settings: further environment variables.
    """
    started: list[NodeProcess] = []

    def start_node(executable: str, *arguments: str) -> NodeProcess:
        log = folder / f"{Path(executable).name}-{len(started)}.txt"
        node = NodeProcess(executable, *arguments, environment={**os.environ, **settings}, log=log)
        started.append(node)
        return node

    yield start_node
    for node in reversed(started):
        node.end()


@pytest.fixture
def start(tmp_path: Any) -> Any:
    """start(executable, *arguments) -> NodeProcess; all of them are gone when the test ends."""
    yield from starter(tmp_path)


@pytest.fixture
def start_to_kill(tmp_path: Any) -> Any:
    """As `start`, for tests that kill a node while others run.

    A killed node may leave a lock in shared memory. Fast DDS's discovery thread in other nodes then waits for it
    without end, and they discover nobody any more (eProsima/Fast-DDS issues 1144, 5053).
    """
    yield from starter(tmp_path, **OVER_UDP)


@pytest.fixture
def start_in_turn(start: Any, tmp_path: Path) -> Any:
    """start_in_turn(module, [words, ...]) -> [(status, output), ...]: runs the `main` of a node's or command's module
    with each command line, which it must refuse. All in one process, as imports take most of a start."""

    def start_all(module: str, lines: list[list[str]]) -> list[tuple[int, str]]:
        given = tmp_path / "lines.json"
        given.write_text(json.dumps(lines))
        process = start(sys.executable, "-c", STARTS_IN_TURN, module, str(given))
        assert process.wait(90.0) == 0, process.output()
        answers = [tuple(json.loads(line)) for line in process.output().splitlines() if "compiling" not in line]
        assert len(answers) == len(lines)
        return answers

    return start_all


@pytest.fixture(scope="module")
def start_for_module(tmp_path_factory: Any) -> Any:
    """As `start`, for all tests of one module; in a domain of its own."""
    before = os.environ["ROS_DOMAIN_ID"]
    domain = reserve_domain()
    os.environ["ROS_DOMAIN_ID"] = str(domain.number)
    yield from starter(tmp_path_factory.mktemp("nodes"))
    domain.claim.close()
    os.environ["ROS_DOMAIN_ID"] = before


@pytest.fixture
def limit_of_files() -> Any:
    """limit_of_files(size): a context in which no file of this process may exceed `size` [bytes]."""

    @contextlib.contextmanager
    def limited(size: int) -> Iterator[None]:
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    return limited


@pytest.fixture
def small_disk(tmp_path: Any) -> Iterator[Path]:
    """The folder of a file system of 1 MB."""
    folder = tmp_path / "small disk"
    folder.mkdir()
    made = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", folder], capture_output=True, text=True)
    if made.returncode:
        pytest.skip(f"no file system can be mounted here: {made.stderr.strip()}")
    yield folder
    subprocess.run(["umount", "--lazy", folder], check=True)
