# SPDX-License-Identifier: Apache-2.0
"""The example of the environments for learning: its policies do their tasks, and one holds a heading over topics."""

import json
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from eel_viz.recording.reading import read
from nav_msgs.msg import Odometry
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_dynamics import Scene
from eel_gym import HeadingEnv
from eel_viz import entities

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "docs" / "examples"
FOUND = {path.stem: json.loads(path.read_text()) for path in EXAMPLES.glob("policy_*.json")}


@pytest.fixture
def example(monkeypatch):
    """The module of the example."""
    monkeypatch.syspath_prepend(EXAMPLES)
    import train_policy

    return train_policy


def swum(example, name, weights, seeds):
    return example.swim(example.TASKS[name], np.tile(weights, (len(seeds), 1, 1)), seeds)


def test_the_policy_holds_the_heading_of_new_episodes(example):
    """Of the action 0 the error is what it was at the start, and what the hidden bend adds: half a radian in the
    mean of many episodes."""
    weights, errors = np.array(FOUND["policy_heading"]["weights"]), {}
    for name, each in (("policy", weights), ("none", 0.0 * weights)):
        errors[name] = example.TASKS["heading"].error(swum(example, "heading", each, list(range(5))))
    assert errors["policy"].max() < 10.0 and errors["none"].mean() > 2.0 * errors["policy"].mean()


def test_the_policy_swims_through_the_points_of_new_episodes(example):
    weights = np.array(FOUND["policy_way_points"]["weights"])
    assert swum(example, "way_points", weights, [11, 12]).reached.tolist() == [3, 3]


def test_the_policy_swims_to_the_depth_of_new_episodes_and_rolls_little(example):
    weights = np.array(FOUND["policy_depth"]["weights"])
    found = swum(example, "depth", weights, [21, 22])
    assert example.TASKS["depth"].error(found).max() < 0.1 and found.length.tolist() == [200, 200]


@pytest.mark.soak
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("name", ["heading", "depth", "way_points"])
def test_training_finds_a_policy_that_does_the_task(example, name):
    """All of it: some minutes on two cores, most of them in the swims of 1,200 episodes or more."""
    task = example.TASKS[name]
    found = example.train(task)
    assert len(found["curve"]) == task.generations and found["curve"][-1][0] > found["curve"][0][0] + 1.0
    swims = example.tested(task, np.array(found["weights"]))
    if name == "way_points":
        assert swims.reached.mean() > 2.8
    else:
        assert task.error(swims).max() < {"heading": 6.0, "depth": 0.1}[name]


def test_the_policy_over_topics_swims_as_in_the_environment(start, fresh_domain):
    """The same start, gait, water and policy. The positions of the head agree to a tenth of the target, 1e-4 of the
    path: the two march by methods of their own, stamps are whole nanoseconds, and observations have single precision.
    The heading is held."""
    swim = SwimClient(domain=fresh_domain, topics=())
    swim.listen("odom", Odometry)
    settings = ("scene.planar:=true", "scene.internal_wrench:=false", "scene.ledger:=false", "estimate_error:=false")
    pace = ("real_time_factor:=0", "rate:=10", "duration:=12", "wait_for_subscribers:=2", "subscriber_timeout:=60")
    node = start("dynamics", "--ros-args", *(word for each in (*settings, *pace) for word in ("-p", each)))
    start(sys.executable, EXAMPLES / "policy_controller.py", "--ros-args", "-p", "heading:=0.6")
    swim.until(lambda: swim.received["odom"] and swim.received["odom"][-1].header.stamp.sec >= 12, "the end", 2 * LIMIT)
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output() and "run out" not in node.output(), node.output()
    positions = {nanoseconds(each.header.stamp): each.pose.pose.position for each in swim.received["odom"]}
    swim.close()

    env, weights = AtRest(control_period=0.1), np.array(FOUND["policy_heading"]["weights"])[0]
    env.target = 0.6
    observation, _ = env.reset()
    for k in range(1, 121):
        action = np.tanh([weights[:-1] @ observation + weights[-1]])
        observation, *_ = env.step(action)
        seen = positions[k * 100_000_000]
        assert (seen.x, seen.y, seen.z) == pytest.approx(env.head.position.tolist(), rel=1e-5, abs=1e-5)
    assert env.heading == pytest.approx(0.6, abs=0.05)


class AtRest(HeadingEnv):
    """Begins as the dynamics node does."""

    def begin(self, options):
        return type(super().begin(options))()


def test_an_episode_is_recorded_as_the_visualiser_would_show_it(tmp_path):
    env = gymnasium.make("Eel/Heading-v0", render_mode="rerun", recordings=tmp_path, scene=Scene(planar=True))
    for _ in range(2):
        env.reset(seed=1)
        for _ in range(5):
            env.step([1.0])
    env.close()
    files = sorted(tmp_path.iterdir())
    assert [path.name for path in files] == ["Heading-0.rrd", "Heading-1.rrd"]
    heading = np.array(read(files[0], entities.ATTITUDE)["scalars"])[:, 0]
    assert len(heading) == 6 and np.ptp(heading) > 0.0
    assert len(read(files[1], entities.WRENCH_NUMBERS)["torque_3"]) == 6
