# SPDX-License-Identifier: Apache-2.0
"""Streams of samples, whatever the time does: a jump costs no more than a look, and nothing of the past is sent."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from eel_common.ros.headers import LATEST, seconds_of
from eel_gaits.gaits.cpg import Oscillation, Oscillators
from eel_gaits.pilot import goals
from eel_gaits.pilot.settings import PilotSettings
from eel_gaits.ros.messages import samples_to_message
from eel_gaits.ros.pilot_messages import head_motion, path_message, read_path
from eel_gaits.ros.streams import MOST_SAMPLES, ROWS_AHEAD, OscillatorStream, RowStream
from eel_gaits.sources.sampled_law import SampledLaw
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message

LIMITS = PilotSettings().limits
HOUR, WALL_TIME, END = 3600.0, 1.8e9, 2.0**31 - 10.0  # s


class Topic:
    """Stands for a node and its only publisher, which has a subscriber. times: [s], of what was published."""

    topic_name = "curvature_samples"

    def __init__(self):
        self.times, self.warnings = [], []

    def create_publisher(self, *of):
        return self

    def get_subscription_count(self):
        return 1

    def get_namespace(self):
        return "/"

    def get_logger(self):
        return self

    def warning(self, text, throttle_duration_sec):
        self.warnings.append(text)

    def publish(self, message):
        self.times.append(message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec)


@pytest.mark.parametrize("jump", [HOUR, WALL_TIME, END])
def test_a_jump_of_time_begins_the_oscillators_anew_and_is_said_once(jump, monkeypatch):
    steps, rate = [], Oscillators._rate
    monkeypatch.setattr(Oscillators, "_rate", lambda chain, state: steps.append(1) or rate(chain, state))
    topic = Topic()
    stream = OscillatorStream(topic, "section")
    stream.follow(Oscillation(), 0.0)
    before, sent = len(steps), len(topic.times)
    stream.extend(jump)
    assert len(steps) < 3 * before
    assert all(jump <= time <= jump + 1.0 for time in topic.times[sent:]) and len(topic.times) > sent
    stream.extend(jump + 0.1)
    assert len(topic.warnings) == 1 and "a new start" in topic.warnings[0]


def test_after_a_jump_of_time_rows_go_on_from_the_present_and_some_at_a_time():
    jump = 0.5 * HOUR
    time = np.concatenate((np.arange(0.0, jump, 0.1), np.arange(jump, jump + 10.0, 1e-3)))
    topic = Topic()
    stream = RowStream(topic, "section")
    stream.follow(SampledLaw(time, np.linspace(0.0, 1.0, 4), np.zeros((len(time), 2, 3, 4)), name="rows"), 0.0)
    stream.extend(0.0)
    sent = len(topic.times)
    for _ in range(5):
        stream.extend(jump)
    counts = len(topic.times) - sent
    assert topic.times[sent] == pytest.approx(jump, abs=0.11) and topic.times[-1] <= jump + ROWS_AHEAD
    assert MOST_SAMPLES < counts <= 5 * MOST_SAMPLES and np.all(np.diff(topic.times) > 0.0)
    after = stream.next_stamp
    assert after.sec + 1e-9 * after.nanosec == pytest.approx(topic.times[-1] + 1.0, abs=1e-6)


@pytest.mark.parametrize("time", [-1e-3, 2.0**31 - 1.0, math.inf, math.nan])
def test_a_sample_of_a_time_that_no_stamp_holds_is_refused(time):
    with pytest.raises(ValueError, match=r"time of a sample must be >= 0 s and < 2147483647 s"):
        samples_to_message(time, np.zeros(2), np.zeros((6, 2)))


@pytest.mark.parametrize("stamp", [(-1, 0), (0, 10**9), (LATEST, 0), (2**31 - 1, 2**32 - 1)])
def test_an_odom_that_no_answer_can_follow_is_refused(stamp):
    with pytest.raises(ValueError, match=rf"header.stamp must be .*, got sec {stamp[0]}, nanosec {stamp[1]}"):
        seconds_of(Time(sec=stamp[0], nanosec=stamp[1]))


@pytest.mark.parametrize("value", [1e7, -1e308])
def test_an_odom_farther_than_any_goal_is_refused(value):
    odometry = Odometry()
    odometry.pose.pose.position.y = value
    with pytest.raises(ValueError, match=r"position must be at most 1e\+06 in size, got \[0.0, "):
        head_motion(odometry)


def test_a_path_of_too_many_points_is_refused_before_it_is_read():
    points = np.zeros((goals.MOST_POINTS + 1, 3))
    points[:, 0] = np.arange(len(points))
    most = path_message(points[1:], "odom")
    assert len(goals.path(points[1:], 0.5, LIMITS).points) == len(read_path(serialize_message(most)).poses)
    data = serialize_message(path_message(points, "odom"))
    refused = r"path must have at most 10000 points, got 10001"
    for attempt in (lambda: read_path(data[:60]), lambda: goals.path(points, 0.5, LIMITS)):
        with pytest.raises(ValueError, match=refused):
            attempt()
