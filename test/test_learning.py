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
from eel_gym import HeadingEnv, JointAction
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
    assert swum(example, "way_points", weights, [11, 12]).reached.tolist() == [5, 5]


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
        assert swims.reached.mean() > 4.5
    else:
        assert task.error(swims).max() < {"heading": 6.0, "depth": 0.1}[name]


@pytest.mark.parametrize(("robot", "steps"), [("", 120), ("eight_servos", 40)])
def test_a_policy_over_topics_swims_as_in_the_environment(start, fresh_domain, tmp_path, policies, robot, steps):
    """The same start, water and policy: by the curvature the one that PPO has learned, by joints a network of numbers
    drawn at random. The paths of the head agree to 1e-9 m: node and environment march by the same steps on the same
    grid, so that observations, which have single precision, are the same too."""
    own = (f"robot:={robot}",) if robot else ()
    settings = own or ("accuracy:=standard, fixed steps",)
    settings += ("scene.planar:=true", "scene.internal_wrench:=false", "scene.ledger:=false", "estimate_error:=false")
    pace = ("real_time_factor:=0", "rate:=10", f"duration:={steps / 10}", "wait_for_subscribers:=2")
    action = JointAction(robot) if robot else None
    env = AtRest(action=action, accuracy="standard" if robot else "standard, fixed steps")
    env.target, policy = 0.6, EXAMPLES / "ppo" / "heading.npz"
    if robot:
        policy = written(tmp_path / "policy.npz", *env.observation_space.shape, *env.action_space.shape)

    swim = SwimClient(domain=fresh_domain, topics=())
    swim.listen("odom", Odometry)
    words = (*settings, *pace, "subscriber_timeout:=60")
    node = start("dynamics", "--ros-args", *(word for each in words for word in ("-p", each)))
    words = ("heading:=0.6", f"policy:={policy}", *own)
    controller = EXAMPLES / "policy_controller.py"
    start(sys.executable, controller, "--ros-args", *(word for each in words for word in ("-p", each)))
    last = steps * 100_000_000

    def ended():
        return swim.received["odom"] and nanoseconds(swim.received["odom"][-1].header.stamp) == last

    swim.until(ended, "the end", 2 * LIMIT)
    assert node.wait(LIMIT) == 0 and "ERROR" not in node.output() and "run out" not in node.output(), node.output()
    positions = {nanoseconds(each.header.stamp): each.pose.pose.position for each in swim.received["odom"]}
    swim.close()

    act, path, far = policies.Policy(policy, env), [], 0.0
    observation, _ = env.reset()
    for k in range(1, steps + 1):
        observation, *_ = env.step(act(observation))
        seen = positions[k * 100_000_000]
        path.append(env.head.position.tolist())
        far = max(far, np.abs(np.subtract((seen.x, seen.y, seen.z), path[-1])).max())
    print(f"{robot or 'the body'}: {steps / 10:g} s, {np.ptp(path, axis=0).max():.3g} m, at most {far:.2g} m apart")
    assert far < 1e-9 and np.ptp(path, axis=0).max() > 0.5
    assert robot or env.heading == pytest.approx(0.6, abs=np.radians(5.0))


def test_a_policy_that_does_not_fit_is_refused_by_name(policies, tmp_path):
    other = tmp_path / "other.npz"
    other.write_text("no policy")
    with pytest.raises(ValueError, match=r"policy must be a file of train_policy.py or ppo/train.py, got \S*other.npz"):
        policies.Policy(other, HeadingEnv())
    told = "policy must be for 9 observed numbers and 1 of an action, got one for 10 and 1"
    with pytest.raises(ValueError, match=told):
        policies.Policy(EXAMPLES / "policy_way_points.json", HeadingEnv())


@pytest.fixture
def policies(monkeypatch):
    """The module of the controller."""
    monkeypatch.syspath_prepend(EXAMPLES)
    import policy_controller

    return policy_controller


def written(path, observations, actions):
    """The file of a network of 16 tanh, with weights drawn at random."""
    draw = np.random.default_rng(3).normal
    weights = {"weight_0": draw(size=(16, observations)), "bias_0": draw(size=16)}
    np.savez(path, **weights, weight_1=draw(size=(actions, 16)) / 4.0, bias_1=draw(size=actions) / 4.0)
    return path


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
