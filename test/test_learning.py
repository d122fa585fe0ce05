# SPDX-License-Identifier: Apache-2.0
"""The example of the environments for learning: its policy holds a heading, alone and over topics."""

import json
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from eel_dynamics.gym import HeadingEnv
from eel_viz.recording.reading import read
from nav_msgs.msg import Odometry
from swim_client import LIMIT, SwimClient, nanoseconds

from eel_dynamics import Scene
from eel_viz import entities

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "docs" / "examples"
FOUND = json.loads((EXAMPLES / "hold_heading.json").read_text())


@pytest.fixture
def example(monkeypatch):
    """The module of the example."""
    monkeypatch.syspath_prepend(EXAMPLES)
    import hold_heading

    return hold_heading


def test_the_policy_holds_the_heading_of_new_episodes(example):
    """Of the action 0 the error is what it was at the start, and what the hidden bend adds: half a radian in the
    mean of many episodes."""
    seeds = list(range(5))
    errors = {}
    for name, weights in (("policy", np.array(FOUND["weights"])), ("none", np.zeros(10))):
        swum = example.swim(np.tile(weights, (5, 1)), seeds)
        errors[name] = np.abs(swum["error"][-40:]).mean(axis=0)
    assert errors["policy"].max() < 0.2 and errors["none"].mean() > 2.0 * errors["policy"].mean()


@pytest.mark.soak
@pytest.mark.timeout(1800)
def test_training_finds_a_policy_that_holds_the_heading(example):
    """All of it: some minutes on two cores, most of them in the swims of 1,200 episodes."""
    found = example.train()
    assert len(found["curve"]) == 25 and found["curve"][-1][0] > found["curve"][0][0] + 1.0
    assert example.final_error(np.array(found["weights"])).max() < 0.1


def test_the_policy_over_topics_swims_as_in_the_environment(start, fresh_domain):
    """The same start, gait, water and policy. The positions of the head agree to 1e-6 m: stamps are whole nanoseconds,
    and observations have single precision. The heading is held."""
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

    env, weights = AtRest(control_period=0.1), np.array(FOUND["weights"])
    env.target = 0.6
    observation, _ = env.reset()
    for k in range(1, 121):
        action = np.tanh([weights[:-1] @ observation + weights[-1]])
        observation, *_ = env.step(action)
        seen = positions[k * 100_000_000]
        assert (seen.x, seen.y, seen.z) == pytest.approx(env.head.position.tolist(), abs=1e-6)
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
