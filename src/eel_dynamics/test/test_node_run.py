# SPDX-License-Identifier: Apache-2.0
"""A run as fast as possible, over DDS: every sample once, equal to what the library computes, and a good end."""

import math

import numpy as np
import pytest
from eel_gaits.ros.messages import law_to_message
from scipy.interpolate import CubicSpline
from swim_client import LIMIT, SAMPLES, is_finite, nanoseconds

from eel_dynamics import Simulation
from eel_gaits import Law, Term, falling

POWERS = ("actuator", "wake", "nose", "drag")
FLAT_OUT = ("-p", "real_time_factor:=0", "-p", "wait_for_subscribers:=1")


@pytest.mark.identity("Energy ledger")
def test_ten_seconds_are_1001_samples_on_every_topic(start, client, measured):
    listener = client(clock=True)
    node = start("dynamics", "--ros-args", *FLAT_OUT, "-p", "duration:=10", "-p", "subscriber_timeout:=60")
    listener.until(lambda: listener.received["/clock"], "clock before the start")  # else its first ticks may be missed
    listener.laws.publish(law_to_message(falling()))
    listener.until(
        lambda: all(len(listener.received[topic]) >= 1001 for topic in SAMPLES), "1001 samples on every topic"
    )
    assert node.wait(LIMIT) == 0, node.output()
    listener.until(lambda: nanoseconds(listener.received["/clock"][-1].clock) == 10**10, "the last tick")
    listener.until(lambda: listener.diagnosis()[1] == "finished", "the last diagnostics")
    stamps = [round(k * 1e9 / 100) for k in range(1001)]
    for topic in SAMPLES:
        assert [nanoseconds(message.header.stamp) for message in listener.received[topic]] == stamps, topic
    ticks = [nanoseconds(message.clock) for message in listener.received["/clock"]]
    assert ticks == sorted(ticks) and set(ticks) == set(stamps)
    assert len(listener.received["body"]) == 1
    assert "WARN" not in node.output() and "ERROR" not in node.output()

    simulation = Simulation(law=falling())
    for k in range(0, 1001, 50):
        simulation.advance(k / 100)
        snapshot = simulation.observe()
        pose, wrench = listener.received["head_pose"][k].pose, listener.received["internal_wrench"][k]
        position = np.array([pose.position.x, pose.position.y, pose.position.z])
        assert np.allclose(position, snapshot.position, rtol=0, atol=1e-12)
        assert np.allclose(wrench.torque_3, snapshot.torque[:, 2], rtol=0, atol=1e-11)

    field = lambda name: np.array([getattr(message, name) for message in listener.received["energy"]])  # noqa: E731
    kinetic, powers = field("kinetic_body") + field("kinetic_fluid"), sum(field(f"{name}_power") for name in POWERS)
    work = np.trapezoid(np.abs(field("actuator_power")), dx=0.01)
    measured("residual that the live node publishes (by the actuators' work)", np.abs(field("residual")) / work, 1e-3)
    # the same once more from the published powers, by a spline through 100 Hz: kinks of V|V| in time
    again = kinetic - kinetic[0] - CubicSpline(np.array(stamps) / 1e9, powers).antiderivative()(np.array(stamps) / 1e9)
    measured("that residual against the published energies and powers", np.abs(again - field("residual")) / work, 1e-5)

    level, text, values = listener.diagnosis()
    assert (level, text) == (0, "finished")
    assert values["law"] == "falling" and values["accuracy"] == "standard" and values["samples_published"] == "1001"
    assert float(values["time"]) == 10.0 and float(values["real_time_factor"]) > 0.0
    assert float(values["actuator_work"]) == pytest.approx(snapshot.actuator_work, rel=1e-6)
    assert abs(float(values["energy_residual"])) < 1e-3 * float(values["actuator_work"])
    assert 0.0 <= float(values["closure_force_relative"]) < 1e-10
    assert 0.0 <= float(values["closure_torque_relative"]) < 1e-10
    assert 0.0 < float(values["error_position"]) < 1e-4 and 0.0 < float(values["error_torque"]) < 1e-4


def test_a_sensitive_swim_that_misses_its_target_is_told(start, client):
    heard = client(topics=("head_pose",))
    heard.laws.publish(law_to_message(falling(period=0.4)))
    scene = ("-p", "scene.density:=3000", "-p", "scene.friction:=laminar", "-p", "accuracy:=1e-3")
    node = start("dynamics", "--ros-args", *FLAT_OUT, "-p", "duration:=9", *scene)
    assert node.wait(LIMIT) == 0, node.output()
    heard.until(lambda: heard.diagnosis()[1] != "swimming" and float(heard.diagnosis()[2]["time"]) == 9.0, "the end")
    level, _, values = heard.diagnosis()
    assert level == 1 and "errors have grown so far" in values["warnings"]
    # once at most: the node looks once a second, and a run as fast as possible may have lost the position by then
    assert node.output().count("above the target 0.001: the motion is sensitive") <= 1, node.output()
    assert float(values["error_since"]) > 1.0 and float(values["error_growth_rate"]) > 0.5


def test_no_error_is_measured_where_none_is_wanted(start, client):
    heard = client(topics=("head_pose", "odom", "swim_state"))
    heard.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", *FLAT_OUT, "-p", "duration:=1", "-p", "estimate_error:=false")
    assert node.wait(LIMIT) == 0, node.output()
    heard.until(lambda: heard.diagnosis()[1] == "finished", "the last diagnostics")
    values = heard.diagnosis()[2]
    assert {name: values[name] for name in values if name.startswith("error_")} == {"error_position": "off"}
    assert heard.received["swim_state"] and all(
        math.isnan(each.estimated_error) for each in heard.received["swim_state"]
    )
    assert {each.pose.covariance[0] for each in heard.received["odom"]} == {-1.0}
    assert "finished at t = 1 s" in node.output(), node.output()


def test_rate_that_does_not_divide_a_second(start, client):
    listener = client(topics=("head_pose",))
    listener.laws.publish(law_to_message(falling()))
    node = start("dynamics", "--ros-args", *FLAT_OUT, "-p", "duration:=1", "-p", "rate:=30")
    assert node.wait(LIMIT) == 0, node.output()
    listener.until(lambda: len(listener.received["head_pose"]) >= 31, "31 samples")
    stamps = [nanoseconds(message.header.stamp) for message in listener.received["head_pose"]]
    assert stamps == [round(k * 1e9 / 30) for k in range(31)]


def test_heavy_topics_alone_and_frames_by_parameter(start, client):
    listener = client(topics=("hydrodynamic_load", "odom"))
    listener.laws.publish(law_to_message(falling()))
    more = ("-p", "duration:=1", "-p", "stations:=7", "-p", "world_frame:=map", "-p", "head_frame:=eel/head")
    assert start("dynamics", "--ros-args", *FLAT_OUT, *more).wait(LIMIT) == 0
    listener.until(
        lambda: len(listener.received["odom"]) >= 101 and len(listener.received["hydrodynamic_load"]) >= 101,
        "101 samples",
    )
    assert len(listener.received["hydrodynamic_load"][-1].force_2) == 7 and any(
        listener.received["hydrodynamic_load"][-1].force_2
    )
    assert listener.received["hydrodynamic_load"][-1].header.frame_id == "section"
    assert (listener.received["odom"][-1].header.frame_id, listener.received["odom"][-1].child_frame_id) == (
        "map",
        "eel/head",
    )


def test_start_in_ros_frames(start, client):
    listener = client(topics=("head_pose", "head_twist"))
    listener.laws.publish(law_to_message(falling()))
    begin = ("-p", "initial_position:=[1.0, 2.0, -0.5]", "-p", "initial_orientation:=[0.0, 0.0, 0.7071068, 0.7071068]")
    motion = ("-p", "initial_linear_velocity:=[1, 0, 0]", "-p", "duration:=0.5", "-p", "scene.current:=[0, 2, 0]")
    assert start("dynamics", "--ros-args", *FLAT_OUT, *begin, *motion).wait(LIMIT) == 0
    listener.until(lambda: len(listener.received["head_pose"]) >= 51, "51 samples")
    first, last = listener.received["head_pose"][0].pose.position, listener.received["head_pose"][-1].pose.position
    assert (first.x, first.y, first.z) == pytest.approx((1.0, 2.0, -0.5), abs=1e-12)
    assert listener.received["head_twist"][0].twist.linear.x == pytest.approx(1.0, abs=1e-9)
    # heads along +y (a quarter turn to the left), in water that flows along +y twice as fast: it is carried along
    assert last.y - first.y > 0.5 and abs(last.x - first.x) < 0.1


@pytest.mark.fault(
    "laws",
    "a law that no body can swim, in a run with a duration, as fast as possible",
    "ERROR in /diagnostics, the last good state stays the last; status 1, as nobody is there to reset it",
)
def test_a_batch_run_that_cannot_go_on_ends_with_status_1(start, client):
    listener = client(topics=("head_pose", "internal_wrench"))
    listener.laws.publish(law_to_message(Law(Term(amplitude=(1e3,), period=1.0), name="monster")))
    few = ("-p", "most_evaluations:=5000", "-p", "estimate_error:=false")
    node = start("dynamics", "--ros-args", *FLAT_OUT, "-p", "duration:=5", *few)
    assert node.wait(LIMIT) == 1, node.output()
    listener.until(
        lambda: listener.received["/diagnostics"] and listener.diagnosis()[0] == 2, "error in the diagnostics"
    )
    _, text, values = listener.diagnosis()
    assert "stopped at t =" in text and "this run ends here, with status 1" in text
    assert node.output().count("[ERROR]") == 1 and "Traceback" not in node.output()
    poses = listener.received["head_pose"]
    assert poses and all(is_finite(message) for message in poses + listener.received["internal_wrench"])
    assert nanoseconds(poses[-1].header.stamp) == round(float(values["time"]) * 1e9) < 5e9
