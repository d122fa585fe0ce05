# SPDX-License-Identifier: Apache-2.0
"""A copy of an environment goes on by itself, to the same bit: for tree search, and as a checkpoint."""

import copy
import multiprocessing
import pickle
import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from eel_dynamics.model.flow.sources import Gust, Shear
from eel_gym.heading import HeadingEnv

from eel_dynamics import Scene
from eel_gym import JointAction, KnotAction, ThreadedVectorEnv

ENVIRONMENTS = {
    "heading": lambda: gymnasium.make("Eel/Heading-v0"),
    "depth": lambda: gymnasium.make("Eel/Depth-v0"),
    "way points": lambda: gymnasium.make("Eel/WayPoints-v0"),
    "knots": lambda: gymnasium.make("Eel/Heading-v0", action=KnotAction(4)),
    "joints": lambda: gymnasium.make("Eel/Heading-v0", action=JointAction("eight_servos")),
    "gust": lambda: gymnasium.make("Eel/Heading-v0", flow=Gust(velocity=(0.1, 0.05, 0.0), rise=0.2)),
    "drawn flow": lambda: gymnasium.make("Eel/Heading-v0", flow=drawn_flow),
    "ledger": lambda: gymnasium.make("Eel/Heading-v0", scene=Scene(planar=True), accuracy=1e-2),
    "three": lambda: gymnasium.make_vec("Eel/Heading-v0", num_envs=3, duration=0.3, flow=drawn_flow),
    "three in threads": lambda: gymnasium.make_vec("Eel/Depth-v0", num_envs=3, threads=2, duration=0.3),
    "robots in threads": lambda: ThreadedVectorEnv(
        3, task=HeadingEnv, threads=2, action=JointAction("eight_servos", "torque"), duration=0.2
    ),
}


def drawn_flow(random):
    return Shear(velocity=(random.uniform(-0.3, 0.3), 0.0, 0.0), width=1.0)


def pickled(thing):
    return pickle.loads(pickle.dumps(thing))


def went_on(environment, steps=12):
    """What an environment gives for random actions, episodes that begin anew among them."""
    draw, seen = np.random.default_rng(5), []
    for _ in range(steps):
        action = draw.uniform(-1.0, 1.0, environment.action_space.shape)
        observation, reward, terminated, truncated, _ = environment.step(action)
        seen += [observation.tobytes(), np.asarray(reward).tobytes(), np.array((terminated, truncated)).tobytes()]
        if not hasattr(environment, "num_envs") and (terminated or truncated):
            seen.append(environment.reset()[0].tobytes())
    return seen


@pytest.mark.parametrize("make", ENVIRONMENTS.values(), ids=ENVIRONMENTS)
def test_copies_go_on_by_themselves_to_the_same_bit(make):
    environment = make()
    fresh = copy.deepcopy(environment), pickled(environment)
    begun = [each.reset(seed=3)[0].tobytes() for each in (environment, *fresh)]
    assert begun[1:] == begun[:1] * 2
    went_on(environment, 7)
    copies = copy.deepcopy(environment), pickled(environment)
    wanted = went_on(environment)
    for each in copies:
        again = pickled(each)
        assert went_on(each) == wanted == went_on(again)
    for each in (environment, *copies):
        each.close()


def test_a_plain_copy_of_a_task_goes_on_by_itself_too():
    environment = HeadingEnv()
    environment.reset(seed=1)
    other = copy.copy(environment)
    wanted = went_on(environment)
    assert went_on(other) == wanted


def test_one_environment_is_tried_in_many_ways_from_one_state():
    """Tree search: the state is kept, and each branch begins from it."""
    environment = HeadingEnv(duration=5.0)
    environment.reset(seed=1)
    went_on(environment, 3)
    kept = pickle.dumps(environment)
    ends = []
    for bend in (-1.0, 0.0, 1.0):
        branch = pickle.loads(kept)
        for _ in range(5):
            seen, *_ = branch.step(np.array([bend]))
        ends.append(seen)
    assert pickle.dumps(environment) == kept and len({end.tobytes() for end in ends}) == 3


def test_an_episode_that_is_recorded_is_recorded_of_both(tmp_path):
    environment = HeadingEnv(render_mode="rerun", recordings=tmp_path)
    environment.reset(seed=1)
    went_on(environment, 3)
    other = pickled(environment)
    for each in (environment, other):
        went_on(each, 2)
        each.close()
    first, second = sorted(tmp_path.iterdir())
    assert first.stat().st_size > 0 and second.stat().st_size > 0


FRESH = """
import pickle, sys
import numpy as np
environment = pickle.load(sys.stdin.buffer)
for _ in range(5):
    seen, *_ = environment.step(np.full(environment.action_space.shape, 0.3))
sys.stdout.buffer.write(seen.tobytes())
"""


def steered(environment):
    for _ in range(5):
        seen, *_ = environment.step(np.full(environment.action_space.shape, 0.3))
    return seen.tobytes()


def in_a_fork(pipe, environment, state):
    seen = steered(environment), steered(pickle.loads(state))
    whole = getattr(environment, "unwrapped", environment)
    vars(getattr(whole, "swimmers", whole)).clear()  # its threads are not in the fork: none is waited for
    pipe.send(seen)


@pytest.mark.parametrize("name", ["heading", "three in threads", "robots in threads"])
def test_environments_go_on_in_other_processes(name):
    environment = ENVIRONMENTS[name]()
    environment.reset(seed=2)
    went_on(environment, 3)
    state = pickle.dumps(environment)
    fresh = subprocess.run([sys.executable, "-c", FRESH], input=state, capture_output=True, timeout=200.0, check=True)
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe()
    child = context.Process(target=in_a_fork, args=(there, environment, state))
    child.start()
    there.close()  # so that a child that fails is seen at once
    inherited, read = here.recv()
    child.join(60.0)
    wanted = steered(environment)
    assert fresh.stdout == wanted == inherited == read and child.exitcode == 0
