# SPDX-License-Identifier: Apache-2.0
"""`readings_from_bag`: what the sensors of a node read, from a bag of its messages."""

import numpy as np
import pytest
from eel_common.topics import OWN
from eel_dynamics.ros.messages import SampleMessages
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.sensors import SensorMessages
from eel_viz.bags.definitions import definition, type_hash
from rosbags.rosbag2 import StoragePlugin, Writer

from eel_dynamics import Imu, Pressure, Simulation, Velocity, readings_from_bag, simulate
from eel_gaits import falling

IMU = {"rate": 50.0, "orientation": True, "accelerometer_noise": 0.1, "seed": 2}
PRESSURE, VELOCITY = {"rate": 20.0, "noise": 50.0}, {"rate": 10.0, "latency": 0.05}


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    """Of 0.5 s, whose sample 0 was published twice."""
    path = tmp_path_factory.mktemp("bags") / "bag"
    swimmer = Simulation(law=falling(), sensors=[0.0])
    settings = Imu(**IMU), Pressure(**PRESSURE), Velocity(**VELOCITY)
    parameters, connections = DynamicsParameters(), {}
    messages = SensorMessages(settings, swimmer, parameters, SampleMessages(swimmer, parameters))
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for k in (0, *range(51)):
            swimmer.advance(0.01 * k)
            for topic, data in messages.due(swimmer.observe(wrench=False, load=False), 10_000_000 * k):
                if topic not in connections:
                    kind = OWN[topic]
                    about = {"msgdef": definition(kind), "rihs01": type_hash(kind)}
                    connections[topic] = writer.add_connection(f"/{topic}", kind, **about)
                writer.write(connections[topic], 10_000_000 * k, data)
    return path


def test_they_are_those_of_the_run(bag):
    found, run = readings_from_bag(bag), simulate(falling(), 0.5, sample_period=0.01, estimate=False)
    assert set(found) == {"imu", "pressure", "depth", "velocity"}
    imu, read = found["imu"], run.imu(**IMU)
    for name in ("time", "specific_force", "angular_velocity", "orientation"):
        np.testing.assert_allclose(getattr(imu, name), getattr(read, name), rtol=0.0, atol=1e-11)
    pressure = run.pressure(**PRESSURE)
    np.testing.assert_allclose(found["pressure"], [pressure.time, pressure.pressure], rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(found["depth"], [pressure.time, pressure.depth], rtol=0.0, atol=1e-11)
    velocity = run.velocity(**VELOCITY)
    assert len(found["velocity"].time) == len(velocity.time) - 1  # the last is due after the end
    np.testing.assert_allclose(found["velocity"].velocity, velocity.velocity[:-1], rtol=0.0, atol=1e-11)


def test_a_bag_of_nothing_is_refused(tmp_path):
    with pytest.raises(ValueError, match="bag"):
        readings_from_bag(tmp_path / "nowhere")
