# SPDX-License-Identifier: Apache-2.0
"""What sensors cost: `python benchmarks/run.py sensors`."""

import os
import statistics
import sys
from functools import partial
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "src" / "eel_dynamics" / "test"))
from eel_gaits.ros.messages import law_to_message
from measuring import Lines, cpu_time, median_ratio, nodes_in_a_domain, times_in_turn
from sensor_msgs.msg import Imu as ImuMessage
from swim_client import SwimClient

from eel_dynamics import Imu, Pressure, SensorSuite, Simulation, Velocity
from eel_gaits import falling

RATE, SAMPLES = 200.0, 600  # Hz; of a repeat
IMU = Imu(rate=RATE, stations=(0.4,), accelerometer_noise=0.02, gyroscope_noise=0.001, orientation=True)
KINDS: dict[str, tuple[Any, ...]] = {
    "none": (),
    "an IMU": (IMU,),
    "IMU, pressure, velocity": (IMU, Pressure(rate=RATE, noise=50.0), Velocity(rate=RATE, noise=0.01)),
}
TURNS, BEGIN, END = 5, 1, 4  # of the node; s of simulated time between which it is measured
WORDS = "imu.rate:=200.0", "imu.accelerometer_noise:=0.02", "imu.gyroscope_noise:=0.001", "imu.orientation:=true"


def sensors() -> Lines:
    """CPU time of a sample at 200 Hz with sensors of that rate, by one without, in turn. Library: advance, observe with
    wrench and loads (51 stations), read. Node: all of it in real time, with subscribers of every topic, and of the
    IMU."""
    times = times_in_turn({name: partial(_library, kinds) for name, kinds in KINDS.items()})
    yield "library, a sample without sensors", 1e6 * min(times["none"]) / SAMPLES, "us"
    for name in list(KINDS)[1:]:
        yield f"library with {name}, by none", median_ratio(times[name], times["none"]), "times as long"
    seconds: dict[str, list[float]] = {"none": [], "an IMU": []}
    for _ in range(TURNS):
        seconds["none"].append(_node(()))
        seconds["an IMU"].append(_node(WORDS))
    yield "node, a sample without sensors", 1e6 * statistics.median(seconds["none"]), "us"
    yield "node with an IMU, by none", median_ratio(seconds["an IMU"], seconds["none"]), "times as long"


def _library(kinds: tuple[Any, ...]) -> None:
    swimmer = Simulation(law=falling(), sensors=sorted({station for each in kinds for station in each.stations}))
    suite = SensorSuite(kinds, swimmer)
    for k in range(SAMPLES):
        swimmer.advance(k / RATE)
        suite.read(swimmer.observe())


def _node(words: tuple[str, ...]) -> float:
    """CPU time [s] of a sample of the dynamics node."""
    with nodes_in_a_domain() as (start, _, _, domain):
        os.environ.update(domain.environment())
        client = SwimClient(domain=domain.number)
        try:
            client.listen("imu", ImuMessage)
            node = start("dynamics", "rate:=200.0", "wait_for_subscribers:=1", "estimate_error:=false", *words)
            client.laws.publish(law_to_message(falling()))
            poses, marks = client.received["head_pose"], []
            for second in (BEGIN, END):
                client.until(lambda second=second: poses and poses[-1].header.stamp.sec >= second, f"{second} s")
                stamp = poses[-1].header.stamp
                marks.append((cpu_time(node.process.pid), stamp.sec + 1e-9 * stamp.nanosec))
            (first, begin), (last, end) = marks
            return (last - first) / (RATE * (end - begin))
        finally:
            client.close()
