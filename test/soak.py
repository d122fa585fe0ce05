# SPDX-License-Identifier: Apache-2.0
"""A long run of the three nodes as fast as possible, with subscribers, and the memory of each process.

Memory is what a process has for itself in RAM, without what is mapped from files (Linux's `RssAnon`): the pages
of libraries come and go with the machine's own needs.
"""

import csv
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

RATE = 100.0  # Hz
LOOK = 0.5  # s of wall time between two looks at the memory
WINDOWS = 6  # in which looks are taken together
LISTENER = """
import sys
import rclpy
from rclpy.qos import HistoryPolicy, QoSProfile
from eel_viz.bags.definitions import message_class
from eel_common.topics import OWN, SAMPLED, WHERE_ASKED_FOR

rclpy.init()
node = rclpy.create_node("listener")
every = QoSProfile(history=HistoryPolicy.KEEP_ALL)
counts = dict.fromkeys((topic for topic in SAMPLED if topic not in WHERE_ASKED_FOR), 0)
last = {}
for topic in counts:
    def count(data, topic=topic):
        stamp = data[4:12]  # behind the four bytes of the encapsulation; sample 0 is repeated
        counts[topic] += stamp != last.get(topic)
        last[topic] = stamp
    node.create_subscription(message_class(OWN[topic]), topic, count, every, raw=True)
print("listening", flush=True)
executor = rclpy.executors.SingleThreadedExecutor()
executor.add_node(node)
wanted = int(sys.argv[1])
while min(counts.values()) < wanted:
    executor.spin_once(timeout_sec=0.5)
print("received", counts, flush=True)
"""
NODES = ("dynamics", "gait_generator", "visualiser")


@dataclass(frozen=True)
class Soak:
    """What a soak left: `time` (N,) [s of simulation], by node the memory (N,) [MB], and the listener's `counts`."""

    time: np.ndarray
    memory: dict[str, np.ndarray]
    counts: dict[str, int]
    wall: float  # s

    def spread(self, node: str, *, after: float) -> float:
        """Greatest less least memory from simulation time `after` [s] on, as a share of its median: of the medians of
        windows, as single looks may meet a buffer that is about to be given back."""
        late = self.time >= after
        window = np.minimum(WINDOWS * (self.time[late] - after) / (self.time[-1] - after), WINDOWS - 1).astype(int)
        medians = [np.median(self.memory[node][late][window == k]) for k in range(WINDOWS) if np.any(window == k)]
        return float(np.ptp(medians) / np.median(medians))

    def write(self, path: Path) -> None:
        """As .csv, one row a look."""
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["simulation_time_s", *(f"{node}_MB" for node in NODES)])
            rows.writerows(
                [f"{time:.2f}", *(f"{self.memory[node][k]:.3f}" for node in NODES)] for k, time in enumerate(self.time)
            )


def soak(
    start,
    duration: float,
    *,
    limit: float,
    look: float = LOOK,
    memory_limit: str = "32MiB",
    swimmer: tuple[str, ...] = (),
) -> Soak:
    """Swim for `duration` [s of simulation], within `limit` [s]; AssertionError where a node does not end well.

    look [s]: wall time between two looks at the memory. swimmer: parameters of `dynamics`.
    """
    samples = round(duration * RATE) + 1
    listener = start(sys.executable, "-c", LISTENER, str(samples))
    listener.wait_for_output("listening")
    visualiser = start(
        "visualiser", "--ros-args", "-p", "sink:=[serve]", "-p", f"memory_limit:={memory_limit}",
        "-p", "stop_with_publisher:=true",
    )  # fmt: skip
    visualiser.wait_for_output("look at it")
    clock = Clock()
    dynamics = start(
        "dynamics", "--ros-args", "-p", f"duration:={duration}", "-p", f"rate:={RATE}", "-p", "real_time_factor:=0",
        "-p", "wait_for_subscribers:=2", "-p", "subscriber_timeout:=60",
        *(word for parameter in swimmer for word in ("-p", parameter)),
    )  # fmt: skip
    dynamics.wait_for_output("waiting for curvature_law")
    gait, began = start("gait_generator"), time.monotonic()  # the run begins after the first look
    processes = dict(zip(NODES, (dynamics, gait, visualiser), strict=True))
    times, memory = [], {node: [] for node in NODES}
    while dynamics.status is None:
        assert time.monotonic() - began < limit, f"at {clock.time:g} s after {limit:g} s"
        clock.receive(look)
        try:
            looked = {name: anonymous_memory(node.process.pid) for name, node in processes.items()}
        except (OSError, IndexError):  # one has just ended
            break
        times.append(clock.time)
        for name, value in looked.items():
            memory[name].append(value)
    clock.close()
    wall = time.monotonic() - began
    for node in (dynamics, visualiser, listener):
        assert node.wait(120.0) == 0, node.output()
    assert "stuck" not in dynamics.output(), dynamics.output()
    received = listener.output().split("received ")[1].strip()
    counts = {word.split(":")[0].strip(" '{}"): int(word.split(":")[1].strip(" }")) for word in received.split(",")}
    return Soak(np.array(times), {node: np.array(values) for node, values in memory.items()}, counts, wall)


def anonymous_memory(process: int) -> float:
    """[MB] of the process with that number."""
    status = Path(f"/proc/{process}/status").read_text()
    return float(status.split("RssAnon:")[1].split()[0]) / 1e3


class Clock:
    """The newest /clock that has come."""

    def __init__(self):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.qos import QoSProfile, ReliabilityPolicy
        from rosgraph_msgs.msg import Clock as Message

        self.time = 0.0  # s
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=int(os.environ["ROS_DOMAIN_ID"]))
        self._node = rclpy.create_node("soak_clock", context=self._context)
        newest = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._node.create_subscription(Message, "/clock", self._take, newest)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)

    def _take(self, message):
        self.time = message.clock.sec + 1e-9 * message.clock.nanosec

    def receive(self, seconds: float):
        """Waits so long, then takes the newest tick."""
        time.sleep(seconds)
        self._executor.spin_once(timeout_sec=0.1)

    def close(self):
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()
