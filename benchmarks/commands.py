# SPDX-License-Identifier: Apache-2.0
"""What the dynamics node takes of the CPU for a sample: `python benchmarks/run.py commands`.

In lockstep, at 100, 500 and 1,000 Hz, of the ready robot with eight servos, with commands of all joints that another
process sends in answer to each `odom`. Beside it bare messages: a process of rclpy that takes the same commands and
publishes the same `odom`. Contenders take turns; medians. BEFORE=FOLDER, another copy of this repository that is built:
its node takes turns too. `python benchmarks/commands.py controller PID` and `... bare` are processes.
"""

import math
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.ros.qos import keep_all
from lockstep import _node_of
from measuring import Lines, nodes_in_a_domain
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

RATES, TURNS = (100, 500, 1000), 3
FIRST, LAST = 100, 500  # samples that count
JOINTS = [f"joint_{k + 1}" for k in range(8)]
SETTINGS = ("robot:=eight_servos", "real_time_factor:=0", "estimate_error:=false", "wait_for_subscribers:=1")
BARE = "bare messages"


def commands() -> Lines:
    """CPU time of a process for a sample, all its threads, with a command of eight joints each."""
    times: dict[str, list[float]] = {}
    for _ in range(TURNS):
        for name, plant in _plants(os.environ.get("BEFORE", "")).items():
            times.setdefault(name, []).append(_cpu_of(plant))
    bare = np.array(times.pop(BARE))
    yield BARE, 1e6 * float(np.median(bare)), f"us a sample, {_spread(bare)}"
    for name, found in times.items():
        values = np.array(found)
        by = f"{np.median(values / bare):.2f} times bare messages"
        if (other := times.get(f"{name}, before")) is not None:
            by += f"; {np.median(values / np.array(other)):.3f} times before"
        yield name, 1e6 * float(np.median(values)), f"us a sample, {_spread(values)}; {by}"


def _spread(times: np.ndarray) -> str:
    return f"{1e6 * times.min():.0f} to {1e6 * times.max():.0f}"


def _plants(before: str) -> dict[str, Callable[[Any, Any], Any]]:
    """What begins each contender, by its name."""

    def node(rate: int, folder: str, start: Any, begin: Any) -> Any:
        settings = (*SETTINGS, f"rate:={rate}")
        if not folder:
            return start("dynamics", *settings)
        words = " ".join(f"-p {each}" for each in settings)
        return begin("bash", "-c", f". {folder}/setup.bash; exec dynamics --ros-args {words}")

    found: dict[str, Any] = {BARE: lambda start, begin: begin(sys.executable, __file__, "bare")}
    for rate in RATES:
        for folder in dict.fromkeys(("", before)):
            name = f"node at {rate} Hz{', before' if folder else ''}"
            found[name] = lambda start, begin, rate=rate, folder=folder: node(rate, folder, start, begin)
    return found


def _cpu_of(plant: Callable[..., Any]) -> float:
    """CPU time [s] of a sample of the process that `plant` begins."""
    with nodes_in_a_domain() as (start, begin, *_):
        running = plant(start, begin)
        other = begin(sys.executable, __file__, "controller", str(running.process.pid))
        assert other.wait(300.0) == 0, other.output() + running.output()
        return float(other.output().splitlines()[-1])


def cpu_time(pid: int) -> float:
    """CPU time [s] of all threads of a process, to the nanosecond."""
    threads = Path(f"/proc/{pid}/task").iterdir()
    return 1e-9 * sum(int((each / "schedstat").read_text().split()[0]) for each in threads)


def controller(pid: int) -> None:
    """Answer samples on odom, and print the CPU time of `pid` for a sample."""
    node, executor = _node_of("controller")
    publisher = node.create_publisher(JointState, "joint_commands", keep_all())
    command = JointState(name=JOINTS)
    times: list[float] = []  # s
    seen: set[int] = set()  # ns

    def answer(odometry: Odometry) -> None:
        stamp = odometry.header.stamp.sec * 1_000_000_000 + odometry.header.stamp.nanosec
        before = len(seen)
        seen.add(stamp)  # sample 0 is repeated
        if before < len(seen) in (FIRST, LAST):
            times.append(cpu_time(pid))
        command.header.stamp = odometry.header.stamp
        command.position = [0.2 * math.sin(6.0e-9 * stamp - 0.5 * k) for k in range(8)]
        publisher.publish(command)

    node.create_subscription(Odometry, "odom", answer, keep_all())
    while len(seen) < LAST:
        executor.spin_once()
    print((times[-1] - times[0]) / (LAST - FIRST), flush=True)


def bare() -> None:
    """Publish odom in answer to each command."""
    node, executor = _node_of("bare")
    publisher, message, count = node.create_publisher(Odometry, "odom", keep_all()), Odometry(), 0

    def send(command: Any = None) -> None:
        nonlocal count
        count += 1
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(count * 10_000_000, 1_000_000_000)
        publisher.publish(message)

    node.create_subscription(JointState, "joint_commands", send, keep_all())
    while not publisher.get_subscription_count():
        executor.spin_once(0.1)
    time.sleep(0.5)  # both have found each other
    send()
    executor.spin()


if __name__ == "__main__":
    role, *words = sys.argv[1:]
    bare() if role == "bare" else controller(int(words[0]))
