# SPDX-License-Identifier: Apache-2.0
"""What a tick of a controller in the loop costs: `python benchmarks/run.py lockstep`.

A controller at 50 Hz answers each sample on `odom` with one instant of curvature, 20 ms ahead; the run is as fast as
possible. In turn, in the same minutes: the library alone (the controller's numbers, `add_samples`, `advance`,
`observe`), bare messages (the same two topics, between the controller's process and one that simulates nothing), and
the dynamics node. Medians of several turns: two processes do not share the cores in the same way each time.
`python benchmarks/lockstep.py controller` and `... echo` are the two processes.
"""

import array
import math
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from eel_common.ros.qos import keep_all
from measuring import Lines, nodes_in_a_domain
from nav_msgs.msg import Odometry

from eel_dynamics import Simulation
from eel_msgs.msg import CurvatureSamples

TICK, POINTS = 20_000_000, 21  # ns; along the body
FIRST, LAST = 50, 800  # ticks that are measured
TURNS = 15
X = array.array("d", [k / (POINTS - 1) for k in range(POINTS)])
FLAT = array.array("d", bytes(8 * POINTS))
PERIOD = 1.0  # s


def lockstep() -> Lines:
    """A tick of the falling eel's scene under a controller's samples: library, messages, and both in the node."""
    node = ("real_time_factor:=0", "rate:=50", "estimate_error:=false")
    plants = {
        "messages": lambda start, begin: begin(sys.executable, __file__, "echo"),
        "node": lambda start, begin: start("dynamics", *node),
    }
    times: dict[str, list[float]] = {"library": [], "messages": [], "node": []}
    for _ in range(TURNS):
        times["library"].append(_library())
        for name, plant in plants.items():
            times[name].append(_over_topics(plant))
    library, messages, whole = (1e6 * float(np.median(times[name])) for name in times)
    yield "the library alone", library, "us a tick"
    yield "bare messages, there and back", messages, "us a tick"
    yield "the dynamics node", whole, f"us a tick, {TICK / 1e3 / whole:.1f} times real time"
    ratios = [node / (library + messages) for library, messages, node in zip(*times.values(), strict=True)]
    yield "node over the sum, by turns", float(np.median(ratios)), f"times; {min(ratios):.2f} to {max(ratios):.2f}"


def rows(time: int) -> tuple[array.array, array.array, array.array]:
    """Curvature in yaw, its rate and its acceleration at `time` [ns], along the body."""
    w = 2.0 * math.pi / PERIOD
    s, c = math.sin(w * time / 1e9), math.cos(w * time / 1e9)
    bend, rate, acceleration = (array.array("d", [v] * POINTS) for v in (2.0 * s, 2.0 * w * c, -2.0 * w * w * s))
    return bend, rate, acceleration


def _library() -> float:
    """Seconds a tick."""
    simulation = Simulation()
    began = 0.0
    for tick in range(LAST + 1):
        if tick == FIRST:
            began = time.perf_counter()
        simulation.add_samples(tick * TICK / 1e9, np.asarray(X), FLAT, FLAT, FLAT, *rows(tick * TICK))
        if tick:
            simulation.advance(tick * TICK / 1e9)
            simulation.observe(wrench=False, load=False)
    return (time.perf_counter() - began) / (LAST - FIRST)


def _over_topics(plant: Callable[..., Any]) -> float:
    """Seconds a tick of the process `plant` under a controller in another."""
    with nodes_in_a_domain() as (start, begin, *_):
        running = plant(start, begin)
        controlling = begin(sys.executable, __file__, "controller")
        assert controlling.wait(120.0) == 0, controlling.output() + running.output()
        return float(controlling.output().splitlines()[-1])


def _node_of(name: str) -> tuple[Any, Any]:
    """A node, and the executor that spins it."""
    import rclpy

    rclpy.init()
    node, executor = rclpy.create_node(name), rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    return node, executor


def controller():
    """Answer samples on odom until the last tick, and print the seconds of a tick."""
    node, executor = _node_of("controller")
    publisher = node.create_publisher(CurvatureSamples, "curvature_samples", keep_all())
    begun, done = [], []

    def answer(odometry):
        stamp = odometry.header.stamp.sec * 1_000_000_000 + odometry.header.stamp.nanosec
        begun.extend([time.perf_counter()] if stamp == FIRST * TICK else [])
        done.extend([time.perf_counter()] if stamp == LAST * TICK else [])
        yaw = dict(zip(("yaw", "yaw_rate", "yaw_accel"), rows(stamp + TICK), strict=True))
        message = CurvatureSamples(x=X, pitch=FLAT, pitch_rate=FLAT, pitch_accel=FLAT, **yaw)
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp + TICK, 1_000_000_000)
        publisher.publish(message)

    node.create_subscription(Odometry, "odom", answer, keep_all())
    while not done:
        executor.spin_once()
    print((done[0] - begun[0]) / (LAST - FIRST), flush=True)


def echo():
    """Answer each sample of curvature with the odometry of its time, and begin with that of time 0."""
    node, executor = _node_of("echo")
    publisher, message = node.create_publisher(Odometry, "odom", keep_all()), Odometry()

    def answer(samples):
        message.header.stamp = samples.header.stamp
        publisher.publish(message)

    node.create_subscription(CurvatureSamples, "curvature_samples", answer, keep_all())
    start = node.create_timer(0.1, lambda: None if message.header.stamp.nanosec else publisher.publish(message))
    while not message.header.stamp.nanosec:
        executor.spin_once()
    node.destroy_timer(start)
    executor.spin()


if __name__ == "__main__":
    {"controller": controller, "echo": echo}[sys.argv[1]]()
