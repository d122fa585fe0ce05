# SPDX-License-Identifier: Apache-2.0
"""Nodes that are killed and come back while the others run, resets seen by all, and systems side by side."""

import signal
import time
from pathlib import Path

import numpy as np
import pytest
from eel_common.files.output_file import part_of
from eel_common.ros.testing.ros_domain import reserve_domain
from eel_viz.recording.reading import read
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_gaits import falling, straight
from eel_viz import entities

SLOWLY = ("-p", "real_time_factor:=2", "-p", "rate:=25", "-p", "wait_for_subscribers:=1")


def seconds(message) -> float:
    return nanoseconds(message.header.stamp) / 1e9


def visualise(start, recording):
    node = start("visualiser", "--ros-args", "-p", "sink:=[save]", "-p", f"recording:={recording}")
    node.wait_for_output("saving to", LIMIT)
    return node


def so_far(recording) -> Path:
    """The file that the recording is in until it is complete, and then its own."""
    part = part_of(recording)
    return part if part.exists() else recording


def times(recording) -> np.ndarray:
    """Of the samples that are in the file so far [s]."""
    try:
        return read(so_far(recording), entities.POSITION).time
    except ValueError:
        return np.zeros(0)


def missing(recording) -> list[str]:
    """What is not in the file yet: samples, body and law come in any order, the latched ones up to seconds late."""
    try:
        logged = [list(row) for row in read(so_far(recording), entities.LOG)["text"]]
        found = {
            "samples": times(recording).size > 0,
            "law": ["law 'falling' published"] in logged,
            "body": masses(recording).size > 0,
        }
    except ValueError as error:
        return [str(error)]
    return [name for name, there in found.items() if not there]


def masses(recording) -> np.ndarray:
    """Of the body, each that was sent [kg]."""
    return np.unique(read(so_far(recording), entities.BODY_NUMBERS, static=True)["mass"])


@pytest.mark.fault(
    "nodes",
    "the gait generator killed (SIGKILL) and started again",
    "the swim goes on with its law; the same law again is no change",
)
@pytest.mark.fault(
    "nodes",
    "the visualiser killed and started again in mid-run",
    "the swim does not notice; the old one opens as `first.part.rrd`, the new one goes on, with body and law",
)
@pytest.mark.fault(
    "time", "a reset while everyone subscribes", "all follow: samples from 0 again, a second recording, the same law"
)
@pytest.mark.fault(
    "nodes",
    "the dynamics node killed and started again, and a visualiser that comes later still",
    "it finds the law on the network and swims from 0; a third recording; the late one has body, law and what follows",
)
@pytest.mark.timeout(240)
@pytest.mark.soak
def test_nodes_die_and_come_back(start_to_kill, fresh_domain, tmp_path):
    start = start_to_kill
    swim = SwimClient(domain=fresh_domain, topics=("curvature",))
    received = swim.received["curvature"]

    def on(more):
        """Spins until the simulation is so much further [s]; its time then."""
        target = (seconds(received[-1]) if received else 0.0) + more
        swim.until_time(target, "curvature")
        return target

    def from_the_start(begin):
        """Keep what comes from the first sample on, which may come before `begin` has returned."""
        received.clear()
        begun = begin()
        swim.until(lambda: any(seconds(message) < 0.3 for message in received), "samples from the start")
        del received[: next(k for k, message in enumerate(received) if seconds(message) < 0.3)]
        return begun

    def recorded(name):
        deadline = time.monotonic() + LIMIT
        while not so_far(tmp_path / name).exists() or missing(tmp_path / name):
            assert time.monotonic() < deadline, f"not in {name}: {missing(tmp_path / name)}"
            swim.spin(1.0)  # a look takes as long as a second of a node's work

    gait = start("gait_generator")
    first = visualise(start, tmp_path / "first.rrd")
    dynamics = start("dynamics", "--ros-args", *SLOWLY)
    on(2.0)
    recorded("first.rrd")

    gait.process.send_signal(signal.SIGKILL)
    gait.wait(LIMIT)
    on(1.0)
    start("gait_generator").wait_for_output("published on", LIMIT)
    on(1.0)
    assert dynamics.output().count("adopted") == 1, dynamics.output()

    first.process.send_signal(signal.SIGKILL)
    first.wait(LIMIT)
    assert times(tmp_path / "first.rrd").size
    on(0.5)
    second = visualise(start, tmp_path / "second.rrd")
    recorded("second.rrd")
    for message in received[::20]:
        assert np.allclose(message.yaw, falling().curvature(seconds(message), np.array(message.x))[0][:, 2], atol=1e-9)

    assert from_the_start(swim.reset).success
    recorded("second-2.rrd")
    on(1.0)
    dynamics.process.send_signal(signal.SIGKILL)
    dynamics.wait(LIMIT)
    again = from_the_start(lambda: start("dynamics", "--ros-args", *SLOWLY[:-1], "wait_for_subscribers:=2"))
    on(0.5)
    late = visualise(start, tmp_path / "late.rrd")
    recorded("late.rrd")
    recorded("second-3.rrd")
    for message in received[::20]:
        assert np.allclose(message.yaw, falling().curvature(seconds(message), np.array(message.x))[0][:, 2], atol=1e-9)
    swim.close()
    for node in (second, late, again):
        assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()
    assert second.output().count("a new recording begins") == 2, second.output()

    runs = [times(tmp_path / name) for name in ("second.rrd", "second-2.rrd", "second-3.rrd", "late.rrd")]
    assert runs[0][0] > 2.0 and runs[1][0] < 0.3 and runs[2][0] < 2.0 and runs[3][0] > 0.1
    for name in ("second.rrd", "second-3.rrd", "late.rrd"):
        assert masses(tmp_path / name).size == 1 and not missing(tmp_path / name), name


@pytest.mark.fault(
    "nodes",
    "the same while the visualiser stands still (SIGSTOP) until the second one's time has passed the first one's",
    "another publisher: a third recording, of the second node alone",
)
@pytest.mark.soak
def test_a_dynamics_node_that_is_found_late_begins_a_new_recording(start_to_kill, fresh_domain, tmp_path):
    start = start_to_kill
    swim = SwimClient(domain=fresh_domain, topics=("curvature",))
    received = swim.received["curvature"]
    start("gait_generator")
    node = visualise(start, tmp_path / "run.rrd")
    first = start("dynamics", "--ros-args", "-p", "real_time_factor:=2", "-p", "wait_for_subscribers:=2")
    swim.until(lambda: received and seconds(received[-1]) > 1.0, "a second of the first run")
    deadline = time.monotonic() + LIMIT
    while not times(tmp_path / "run.rrd").size:
        assert time.monotonic() < deadline, node.output()
        swim.spin(0.3)
    node.process.send_signal(signal.SIGSTOP)
    try:
        first.process.send_signal(signal.SIGKILL)
        first.wait(LIMIT)
        second = start("dynamics", "--ros-args", "-p", "real_time_factor:=2", "-p", "wait_for_subscribers:=1")
        swim.until(lambda: any(np.diff([seconds(message) for message in received]) < 0.0), "the second run")
        begun = int(np.argmax(np.diff([seconds(message) for message in received]) < 0.0)) + 1
        last = seconds(received[begun - 1])
        del received[:begun]
        swim.until_time(last + 3.0, "curvature")
    finally:
        node.process.send_signal(signal.SIGCONT)
    node.wait_for_output("a new recording begins", LIMIT)
    swim.until_time(seconds(received[-1]) + 1.0, "curvature")
    swim.close()
    for each in (second, node):
        assert each.interrupt() == 0, each.output()
    assert "another node publishes" in node.output() and node.output().count("a new recording begins") == 1
    both = times(tmp_path / "run.rrd"), times(tmp_path / "run-2.rrd")
    assert both[0][-1] <= last + 0.5 and both[1][0] > last
    for recorded in both:
        assert np.all(np.diff(recorded) > 0.0)
    assert np.unique(read(tmp_path / "run-2.rrd", entities.BODY_NUMBERS, static=True)["mass"]).size == 1


@pytest.mark.fault("neighbours", "two whole systems in two ROS domains, with the same names", "no cross-talk at all")
def test_two_systems_in_two_domains(start, fresh_domain, monkeypatch, request):
    other = reserve_domain()
    request.addfinalizer(other.claim.close)
    clients, nodes = {}, {}
    for name, number in (("falling", fresh_domain), ("straight", other.number)):
        clients[name] = SwimClient(domain=number, topics=("curvature", "head_pose"), clock=True)
        request.addfinalizer(clients[name].close)
        monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
        start("gait_generator", "--ros-args", "-p", f"gait:={name}")
        nodes[name] = start(
            "dynamics", "--ros-args", "-p", "duration:=3", "-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1"
        )
    for (name, client), law in zip(clients.items(), (falling(), straight()), strict=True):
        client.until(
            lambda client=client: min(len(client.received[topic]) for topic in ("curvature", "head_pose")) >= 301,
            f"301 samples of {name}",
        )
        assert nodes[name].wait(LIMIT) == 0, nodes[name].output()
        assert [nanoseconds(message.header.stamp) for message in client.received["head_pose"]] == [
            k * 10_000_000 for k in range(301)
        ]
        for message in client.received["curvature"][::50]:
            expected = law.curvature(seconds(message), np.array(message.x))[0]
            assert np.allclose(message.yaw, expected[:, 2], atol=1e-9)
            assert np.allclose(message.pitch, expected[:, 1], atol=1e-9)
        ticks = [nanoseconds(message.clock) for message in client.received["/clock"]]
        assert ticks == sorted(ticks)
        assert {message.status[0].name for message in client.received["/diagnostics"]} == {"/dynamics"}
        assert "already" not in nodes[name].output()  # of /clock
        client.until(  # it may be found after the samples that it brought about
            lambda client=client: client.node.count_publishers("curvature_law") >= 2,
            f"the gait generator of {name}",
        )
        assert client.node.count_publishers("curvature_law") == 2  # the gait generator's and this test's own
