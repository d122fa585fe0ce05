# SPDX-License-Identifier: Apache-2.0
"""The gait generator as a process, over real DDS."""

import math
import signal
import time

import numpy as np
import pytest
from eel_common.ros.testing.node_process import PROMPT
from eel_gaits.gaits.cpg import Oscillation, Oscillators
from rclpy.qos import QoSProfile

from eel_gaits import falling, gait, sampled, save_law, sequence, straight, turning
from eel_msgs.msg import CurvatureSamples

SAID = "published on"


@pytest.fixture
def generator(start):
    """generator(*ros_arguments) -> the running process, after its first log line."""

    def run(*arguments):
        process = start("gait_generator", *(("--ros-args", *arguments) if arguments else ()))
        process.wait_for_output(SAID)
        return process

    return run


def test_a_late_subscriber_gets_the_law(generator, client):
    generator()
    client.listen()
    assert client.law(0) == (falling(), 0.0)
    assert client.messages[0].header.frame_id == "section"


def test_a_volatile_subscriber_that_was_there_first_gets_it_too(start, client):
    client.listen(quality=QoSProfile(depth=10))
    start("gait_generator").wait_for_output(SAID)
    client.set(period=2.0)  # by then the end points have met
    client.until(lambda: client.messages and client.latest()[0] == falling(period=2.0), "new law")


def test_parameters_at_start_take_integers_and_tell_what_they_are(generator, client):
    generator("-p", "period:=2", "-p", "transition:=1", "-p", "pitch_bend:=-1")
    client.listen()
    assert client.law(0)[0] == falling(period=2.0, transition=1.0, pitch_bend=-1.0)
    assert client.values()["period"] == 2.0 and client.values()["use_sim_time"] is True
    period, name = client.describe("period", "gait")
    assert period.description == "period T of the wave [s]" and period.type == 3 and not period.dynamic_typing
    assert (period.floating_point_range[0].from_value, period.floating_point_range[0].to_value) == (1e-3, 1e4)
    assert "turning" in name.additional_constraints


def test_several_values_set_at_once_make_one_law(generator, client):
    """As `ros2 param load` does it: one request, in which each parameter is set by itself."""
    generator("-p", "gait:=kern_fast")
    client.listen()
    before = client.law(0)[0]
    changes = {"waves": 1.5, "bend_nose": 1.6, "bend_third": 0.5, "bend_tail": 2.5, "period": 2, "transition": 0.5}
    assert all(result.successful for result in client.set(**changes))
    law, _ = client.law(1)
    assert law == gait("kern_fast", **{**changes, "period": 2.0}) and law != before
    client.set(period=3.0)
    assert client.law(2)[0] == gait("kern_fast", **{**changes, "period": 3.0}) and len(client.messages) == 3


def test_a_params_file_in_a_namespace(generator, client, tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n    gait: turning\n    left_bend: 1\n    rate: 100\n    use_sim_time: false\n"
    )
    generator("--params-file", str(file), "-r", "__ns:=/second")
    client.listen("second/curvature_law")
    client.generator = "second/gait_generator"
    assert client.law(0) == (turning(left_bend=1.0), 0.0)
    values = client.values()
    assert values["use_sim_time"] is False and "rate" not in values and "pitch_bend" not in values


def begin_turning(client):
    """Changes to the gait turning anew; when it began [s]. A law may come after the answer to the call."""
    for name in ("falling", "turning"):
        before = len(client.messages)
        client.set(gait=name)
        client.until(
            lambda before=before, name=name: client.messages[before:] and client.latest()[0].name == name,
            f"law of {name}",
        )
    return client.latest()[1]


def test_a_parameter_of_the_same_gait_keeps_the_time_another_gait_starts_at_now(generator, client):
    generator("-p", "wavelength:=0.8")
    client.listen()
    client.law(0)

    client.tick_until(12.5, lambda: begin_turning(client) == 12.5, "law with the ticked time")
    assert client.latest() == (turning(wavelength=0.8), 12.5)
    values = client.values()
    assert values["gait"] == "turning" and values["left_bend"] == -0.5 and "pitch_bend" not in values

    count = len(client.messages)
    client.tick(20.0)
    assert client.set(left_bend=1)[0].successful
    assert client.law(count) == (turning(wavelength=0.8, left_bend=1.0), 12.5)
    assert client.set(transition=2)[0].successful
    assert client.law(count + 1) == (turning(wavelength=0.8, left_bend=1.0, transition=2.0), 12.5)


@pytest.mark.fault(
    "time", "time that jumps back, at the gait generator", "its law begins at 0 again, as the receiver's does"
)
def test_after_time_went_back_the_law_has_its_start_at_zero(generator, client):
    generator()
    client.listen()
    client.law(0)

    client.tick_until(30.0, lambda: begin_turning(client) > 0.0, "law at 30 s")
    client.tick_until(3.0, lambda: client.latest() == (turning(), 0.0), "law whose start is at zero")
    count = len(client.messages)
    client.set(period=2.0)
    assert client.law(count) == (turning(period=2.0), 0.0)


def test_before_any_clock_another_gait_has_a_zero_stamp(generator, client):
    generator()
    client.listen()
    client.law(0)
    assert client.set(gait="helix")[0].successful
    assert client.law(1) == (gait("helix"), 0.0)


def test_what_the_user_set_carries_over(generator, client):
    generator("-p", "left_bend:=-0.25")  # of a gait that is not on yet
    client.listen()
    assert client.law(0)[0] == falling()
    assert all(result.successful for result in client.set(period=3, wavelength=0.7, gait="turning"))
    assert client.law(1)[0] == turning(period=3.0, wavelength=0.7, left_bend=-0.25)
    client.set(gait="kern_efficient")
    assert client.law(2)[0] == gait("kern_efficient", period=3.0)
    client.set(gait="turning")
    assert client.law(3)[0] == turning(period=3.0, wavelength=0.7, left_bend=-0.25)


def test_a_gait_and_its_numbers_set_together(generator, client):
    generator()
    client.listen()
    client.law(0)
    assert client.set_together(gait="turning", left_bend=2, period=1.5).successful
    assert client.law(1)[0] == turning(left_bend=2.0, period=1.5)
    assert client.values()["left_bend"] == 2.0
    assert client.set_together(bend_start=5, bend_full=6).successful
    assert client.law(2)[0] == turning(left_bend=2.0, period=1.5, bend_start=5.0, bend_full=6.0)


def test_oscillators_are_streamed_ahead_of_the_clock_and_follow_new_numbers(generator, client):
    samples = []
    client.node.create_subscription(CurvatureSamples, "curvature_samples", samples.append, 1000)
    client.listen()
    generator("-p", "gait:=cpg")
    times = lambda: [each.header.stamp.sec + 1e-9 * each.header.stamp.nanosec for each in samples]  # noqa: E731
    client.until(lambda: samples and times()[-1] >= 0.5, "samples of the first half second")
    client.tick_until(0.3, lambda: times()[-1] >= 0.8, "samples after the clock has ticked")
    assert client.set(left_bend=1)[0].successful
    client.tick_until(1.0, lambda: times()[-1] >= 1.5, "samples with the bend")
    begun = times().index(0.0)
    chain = Oscillators(Oscillation())
    for time_, sample in list(zip(times(), samples, strict=True))[begun : begun + 20]:
        if time_ > chain.time:
            chain.advance(time_)
        value, rate, acceleration = chain.curvature()
        assert list(sample.x) == list(chain.x) and not any(sample.pitch)
        assert list(sample.yaw) == pytest.approx(list(value), abs=1e-9)
        assert list(sample.yaw_rate) == pytest.approx(list(rate), abs=1e-8)
        assert list(sample.yaw_accel) == pytest.approx(list(acceleration), abs=1e-7)
    assert not client.messages  # no law beside the samples
    assert client.set(gait="straight")[0].successful and client.law(0)[0] == straight()


@pytest.mark.fault(
    "parameters",
    "a sequence's file that does not fit, while a gait runs",
    "refused with file, line and key; the old law stays",
)
def test_a_sequence_from_a_file_and_one_that_does_not_fit(generator, client, tmp_path):
    file = tmp_path / "patrol.yaml"
    file.write_text("steps:\n  - {gait: straight, duration: 3}\n  - gait: turning\n")
    generator("-p", "gait:=sequence", "-p", f"file:={file}")
    client.listen()
    before = client.law(0)[0]
    assert before.terms == sequence([(straight(), 3.0), (turning(), None)]).terms and before.name == "patrol"
    file.write_text("steps:\n  - {gait: straight, duration: long}\n")
    refused = client.set_together(file=str(file))
    assert not refused.successful
    assert refused.reason.endswith("patrol.yaml', line 2, key 'duration': duration must be a number, got 'long'")
    file.write_text("blend: 2\nsteps:\n  - {gait: straight, duration: 3}\n")
    assert client.set_together(file=str(file)).successful
    assert client.law(1)[0].terms == sequence([(straight(), 3.0)], blend=2.0).terms
    assert client.set_together(gait="straight").successful and client.law(2)[0] == straight()


@pytest.mark.fault(
    "parameters",
    "a measured motion's file that does not fit, while a gait runs",
    "refused with file and line; the old motion goes on",
)
def test_the_rows_of_a_measured_motion_are_streamed_ahead_of_the_simulation(generator, client, tmp_path):
    law, samples = sampled(lambda t, x: np.sin(6.0 * (x - t)), 8.0), []
    save_law(law, tmp_path / "wave.npz")
    client.node.create_subscription(CurvatureSamples, "curvature_samples", samples.append, QoSProfile(depth=1000))
    generator("-p", "gait:=file", "-p", f"file:={tmp_path / 'wave.npz'}")

    def reaches(time, after=0):
        return lambda: len(samples) > after and stamp(samples[-1]) >= time - 0.05

    client.until(reaches(2.0), "rows ahead of the start")  # a simulation that waits for them stands at 0
    assert stamp(samples[0]) == 0.0
    for message in samples[:: max(1, len(samples) // 5)]:
        wanted = law.curvature(stamp(message), message.x)
        found = (message.yaw, message.yaw_rate, message.yaw_accel)
        assert all(np.allclose(a, b[:, 2], atol=0.01 * 36.0) for a, b in zip(found, wanted, strict=True))
        assert np.allclose(message.yaw, wanted[0][:, 2], atol=0.01) and not any(message.pitch)
    client.tick_until(3.0, reaches(5.0), "rows ahead of the time")
    (tmp_path / "bad.csv").write_text("time,x,y\n0,0,zero\n")
    refused = client.set_together(file=str(tmp_path / "bad.csv"))
    assert not refused.successful and "bad.csv', line 2: y must be a number, got 'zero'" in refused.reason
    client.tick_until(4.0, reaches(6.0), "rows of the old motion")
    before = len(samples)
    client.tick_until(0.5, lambda: len(samples) > before and stamp(samples[-1]) <= 2.5, "rows after a reset")
    client.listen()
    assert client.set_together(gait="straight").successful
    client.until(lambda: client.messages and client.latest()[0] == straight(), "the gait")


def stamp(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


@pytest.mark.fault(
    "parameters",
    "a gait's parameter set to what cannot be, while it runs",
    "refused with the reason; nothing changes, nothing is published",
)
def test_a_refused_set_says_why_and_changes_nothing(generator, client):
    generator("-p", "period:=2.0")
    client.listen()
    client.law(0)
    before = client.values()
    for values, reason in (
        ({"gait": "swim"}, "unknown gait 'swim', must be one of anguilliform, backward"),
        ({"gait": 7}, "unknown gait 7"),
        ({"period": -1.0}, "period must be >= 0.001 s, got -1.0"),
        ({"period": 0}, "period must be >= 0.001 s, got 0"),
        ({"period": math.nan}, "period must be finite, got nan"),
        ({"period": "fast"}, "period must be a number, got 'fast'"),
        ({"period": True}, "period must be a number, got True"),
        ({"period": None}, "period must be a number, got None"),
        ({"period": [1.0, 2.0]}, "period must be a number, got"),
        ({"bend_full": 0.5}, "bend_full must be > bend_start (1 s), got 0.5"),
        ({"left_bend": 1.0}, "gait 'falling' has no parameter 'left_bend' (did you mean 'pitch_bend'?), it has"),
        ({"transition": -1}, "transition must be >= 0 s, got -1"),
    ):
        result = client.set(**values)[0]
        assert not result.successful and reason in result.reason, (values, result)
    together = client.set_together(period=3.0, gait="turning", pitch_bend=1.0)
    assert not together.successful and "gait 'turning' has no parameter 'pitch_bend'" in together.reason
    assert not client.set_together(period=3.0, use_sim_time=3).successful
    assert client.values() == before
    assert client.set(wavelength=0.9)[0].successful
    assert client.law(1)[0] == falling(period=2.0, wavelength=0.9)  # and nothing was published in between
    assert len(client.messages) == 2


@pytest.mark.fault("parameters", "a bad parameter of the gait generator", "one line, status 2")
def test_bad_parameters_at_start_are_one_line_each_and_status_2(start_in_turn):
    bad = {
        "period:=-1": "gait_generator: period must be >= 0.001 s, got -1",
        "period:=.inf": "gait_generator: period must be finite, got inf",
        "period:=fast": "gait_generator: period must be a number, got 'fast'",
        "gait:=swim": "gait_generator: unknown gait 'swim', must be one of",
        "bend_full:=0": "gait_generator: bend_full must be > bend_start (1 s), got 0.0",
        "transition:=[1.0]": "gait_generator: transition must be a number, got",
    }
    lines = [["--ros-args", "-p", argument] for argument in bad]
    for line, (status, said) in zip(bad.values(), start_in_turn("eel_gaits.ros.node", lines), strict=True):
        assert status == 2 and said.startswith(line) and said.count("\n") == 1, said


@pytest.mark.fault("names", "words for the gait generator that are no ROS arguments", "one line, status 2")
def test_a_bad_params_file_or_a_word_that_is_no_ros_argument_ends_it_with_status_2(start_in_turn, tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text("gait_generator:\n  ros__parameters:\n    gait: turning\n    left_bend: 1e9\n")
    lines = [["--ros-args", "--params-file", str(tmp_path / name)] for name in ("parameters.yaml", "missing.yaml")]
    lines += [[*before, "--rosargs", "-p", "period:=2.0"] for before in ((), ("--ros-args", "-p", "period:=2.0", "--"))]
    large, missing, *unknown = start_in_turn("eel_gaits.ros.node", lines)
    assert large == (2, "gait_generator: left_bend must be <= 100000 rad/m, got 1000000000.0\n")
    assert missing[0] == 2 and "missing.yaml" in missing[1] and missing[1].count("\n") == 1
    line = "gait_generator: unknown argument '--rosargs' (parameters come after --ros-args as -p NAME:=VALUE)\n"
    assert unknown == [(2, line)] * 2


def test_help_is_short_and_says_where_the_numbers_of_a_gait_are(start):
    process = start("gait_generator", "--help")
    assert process.wait(90.0) == 0
    lines = process.output().splitlines()
    assert lines[0] == "usage: gait_generator [--ros-args -p NAME:=VALUE ...]"
    for name in ("gait", "file", "transition", "length", "scale"):
        assert any(line.startswith(f"  {name} ") for line in lines)
    assert "`eel simulate --help GAIT`" in process.output() and "turning (default falling)" in process.output()
    assert len(lines) < 40 and max(map(len, lines)) <= 100


@pytest.mark.fault("names", "a parameter of the gait generator that there is not", "a warning that names it")
def test_overrides_that_are_no_parameters_are_named(generator):
    process = generator("-p", "perod:=0.5", "-p", "left_bend:=1", "-p", "qos_overrides./a.publisher.depth:=2")
    assert process.output().count("WARN") == 1
    assert "not parameters of this node, ignored: 'perod' (did you mean 'period'?)\n" in process.output()


@pytest.mark.parametrize(("sent", "delay"), [(signal.SIGINT, 0.0), (signal.SIGTERM, 0.05), (signal.SIGINT, 0.5)])
def test_a_signal_ends_it_promptly_with_status_0(generator, sent, delay):
    process = generator()
    time.sleep(delay)  # the moment of the signal is what is tried here
    assert process.time_to_end(sent) < PROMPT
    assert process.status == 0
    assert "Traceback" not in process.output()


@pytest.mark.fault("ending", "a second signal while the gait generator ends", "status 0, no traceback")
@pytest.mark.parametrize("delay", [0.0, 0.08, *(pytest.param(each, marks=pytest.mark.soak) for each in (0.04, 0.12))])
def test_a_second_signal_does_no_harm(generator, delay):
    process = generator()
    process.process.send_signal(signal.SIGINT)
    time.sleep(delay)  # from the loop to the last moments of the interpreter
    process.process.send_signal(signal.SIGTERM)
    process.process.send_signal(signal.SIGINT)
    assert process.wait(60.0) == 0
    assert "Traceback" not in process.output()
