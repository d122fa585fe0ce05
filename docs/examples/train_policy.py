# SPDX-License-Identifier: Apache-2.0
"""Learn a task of eel_gym: CMA-ES trains a policy of one row of weights for each value of the action.

    python docs/examples/train_policy.py heading                     # trains, tests, writes policy_heading.json
    python docs/examples/train_policy.py depth --draw depth.png      # draws the policy of policy_depth.json
    python docs/examples/train_policy.py way_points

action = tanh(weights . (observation, 1)). `policy_controller.py` lets the heading's steer the dynamics node.
"""

import argparse
import json
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium
import numpy as np

import eel_gym  # noqa: F401, it registers the environments
from eel_dynamics import Scene

POPULATION, EPISODES, SEED = 12, 4, 1
TESTED, TEST_SEED = 20, 100_000  # episodes, none of which was trained on
LAST = 4.0  # s of a test episode that count
GREY, ORANGE, BLUE = "#888888", "#D55E00", "#0072B2"


class Task(NamedTuple):
    """A task, how long it is trained, and which number of the observation tells how well it is done."""

    settings: dict  # of gymnasium.make_vec
    generations: int
    seen: int  # the number of the observation
    factor: float  # from it to what is shown
    label: str  # of what is shown
    beside: int | None = None  # another one, drawn beside it; None: the path from above
    scene: Scene | None = None  # None: that of the environment

    def error(self, swum: "Swum") -> np.ndarray:
        """Mean size (n,) of what is shown over the last seconds of each episode."""
        steps = round(LAST / self.settings["control_period"])
        sizes = self.factor * np.abs(swum.seen[:, :, self.seen])
        return np.array([sizes[end - steps : end, k].mean() for k, end in enumerate(swum.length)])


class Swum(NamedTuple):
    """n episodes of at most T control steps. What comes after the end of an episode is NaN."""

    reward: np.ndarray  # (n,) in total
    length: np.ndarray  # (n,) control steps
    reached: np.ndarray  # (n,) rewards above a half: points that were reached
    seen: np.ndarray  # (T, n, O) observations, times their scales
    position: np.ndarray  # (T, n, 3) m, of the head: x, y left, z up


TASKS = {
    "heading": Task(
        {"id": "Eel/Heading-v0", "control_period": 0.1, "duration": 12.0},
        *(25, 0, 180.0 / np.pi, "error of the heading [degrees]"),
    ),
    "depth": Task(
        {"id": "Eel/Depth-v0", "control_period": 0.1, "duration": 20.0},
        *(40, 0, 1.0, "error of the depth [m]", 3),
        scene=Scene(metacentric_height=0.005, internal_wrench=False, ledger=False),  # ballast
    ),
    "way_points": Task(
        {"id": "Eel/WayPoints-v0", "control_period": 0.1, "duration": 40.0},
        *(25, 1, 3.0, "distance of the point [m]"),
    ),
}


def file_of(task: str) -> Path:
    """The file of the policy for the `task`."""
    return Path(__file__).with_name(f"policy_{task}.json")


def actions_of(weights: np.ndarray, observations: np.ndarray) -> np.ndarray:
    """The actions (n, A) of policies `weights` (n, A, O + 1) or (A, O + 1) at `observations` (n, O)."""
    actions: np.ndarray = np.tanh(np.einsum("...ao,...o->...a", weights[..., :-1], observations) + weights[..., -1])
    return actions


def size_of(task: Task) -> tuple[int, int]:
    """The shape of a policy's weights: values of the action, numbers of the observation and 1."""
    env = gymnasium.make(**task.settings, scene=task.scene)
    (actions,), (observations,) = env.action_space.shape or (), env.observation_space.shape or ()
    return actions, observations + 1


def swim(task: Task, weights: np.ndarray, seeds: list[int]) -> Swum:
    """Swim an episode with each policy `weights` (n, A, O + 1), from the n `seeds`."""
    envs: Any = gymnasium.make_vec(num_envs=len(seeds), scene=task.scene, **task.settings)
    observations, _ = envs.reset(seed=seeds)
    scales = envs.get_attr("scales")[0]
    going, total = np.ones(len(seeds), dtype=bool), np.zeros(len(seeds))
    length, reached = np.zeros((2, len(seeds)), dtype=int)
    seen, positions = [], []
    while going.any():
        observations, rewards, terminated, truncated, _ = envs.step(actions_of(weights, observations))
        total, length, reached = (
            total + np.where(going, rewards, 0.0),
            length + going,
            reached + going * (rewards > 0.5),
        )
        seen.append(np.where(going[:, None], scales * observations, np.nan))
        positions.append(np.where(going[:, None], [head.position for head in envs.get_attr("head")], np.nan))
        going &= ~(terminated | truncated)
    envs.close()
    return Swum(total, length, reached, np.array(seen), np.array(positions))


def train(task: Task) -> dict:
    """Train a policy. Returns what its file holds."""
    import cma  # here: it imports the whole of scipy.stats and pyplot

    shape = size_of(task)
    search = cma.CMAEvolutionStrategy(
        np.zeros(np.prod(shape)), 0.3, {"popsize": POPULATION, "seed": SEED, "verbose": -9}
    )
    began, curve = time.monotonic(), []
    for generation in range(task.generations):
        candidates = np.array(search.ask())
        seeds = [1 + EPISODES * generation + episode for episode in range(EPISODES)]  # the same for all candidates
        weights = np.repeat(candidates, EPISODES, axis=0).reshape(-1, *shape)
        rewards = swim(task, weights, seeds * POPULATION).reward.reshape(POPULATION, EPISODES).mean(axis=1)
        search.tell(list(candidates), list(-rewards))
        curve.append([float(rewards.mean()), float(rewards.max())])
        print(f"generation {generation + 1:2d}: mean reward {curve[-1][0]:.3f}, best {curve[-1][1]:.3f}", flush=True)
    print(f"trained in {time.monotonic() - began:.0f} s")
    return {"task": task.settings, "weights": search.result.xfavorite.reshape(shape).tolist(), "curve": curve}


def tested(task: Task, weights: np.ndarray) -> Swum:
    """The test episodes, with one policy (A, O + 1)."""
    return swim(task, np.tile(weights, (TESTED, 1, 1)), list(range(TEST_SEED, TEST_SEED + TESTED)))


def summary(task: Task, swum: Swum) -> str:
    """How the episodes went, in words."""
    lasted, errors = task.settings["control_period"] * swum.length, task.error(swum)
    summary = f"{swum.reached.sum()} points reached" if "WayPoints" in task.settings["id"] else ""
    summary = summary or f"{task.label} over the last {LAST:g} s: mean {errors.mean():.2g}, worst {errors.max():.2g}"
    return f"{summary}; reward {swum.reward.mean():.3g}; {lasted.min():.3g} to {lasted.max():.3g} s long"


def draw(task: Task, found: dict, path: Path) -> None:
    """Draw the learning curve, and six test episodes with and without the policy."""
    from matplotlib.figure import Figure

    weights, seeds = np.array(found["weights"]), list(range(TEST_SEED, TEST_SEED + 6))
    figure = Figure(figsize=(10.0, 3.4), dpi=100, layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    mean, best = np.array(found["curve"]).T
    left.plot(range(1, len(mean) + 1), mean, color=BLUE, label="mean of the population")
    left.plot(range(1, len(best) + 1), best, color=BLUE, alpha=0.4, label="best")
    left.set(xlabel="generation", ylabel="reward of an episode", title="learning")
    for each, colour, label in ((0.0 * weights, GREY, "action 0"), (weights, ORANGE, "policy")):
        swum = swim(task, np.tile(each, (6, 1, 1)), seeds)
        instants = task.settings["control_period"] * np.arange(1, len(swum.seen) + 1)
        lines = middle.plot(instants, task.factor * swum.seen[:, :, task.seen], color=colour, linewidth=1.0)
        lines[0].set_label(label)
        if task.beside is None:
            right.plot(swum.position[:, :, 0], swum.position[:, :, 1], color=colour, linewidth=1.0)
        else:
            right.plot(instants, np.degrees(swum.seen[:, :, task.beside]), color=colour, linewidth=1.0)
    middle.set(xlabel="t [s]", ylabel=task.label, title="six test episodes")
    if task.beside is None:
        right.set(xlabel="x [m]", ylabel="y [m], left", title="paths of the head", aspect="equal")
    else:
        right.set(xlabel="t [s]", ylabel="[degrees]", title="roll of the head")
    left.legend(), middle.legend()
    for axes in (left, middle, right):
        axes.grid(alpha=0.3)
    figure.savefig(path)
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("task", choices=TASKS)
    parser.add_argument("--policy", type=Path, help="file of the policy (policy_TASK.json beside this script)")
    parser.add_argument("--draw", type=Path, metavar="PNG", help="draw the policy of the file; no training")
    words = parser.parse_args()
    task, policy = TASKS[words.task], words.policy or file_of(words.task)
    if words.draw is not None:
        draw(task, json.loads(policy.read_text()), words.draw)
        return 0
    found = train(task)
    policy.write_text(json.dumps(found) + "\n")
    for name, weights in (("action 0", np.zeros(size_of(task))), ("policy", np.array(found["weights"]))):
        swum = tested(task, weights)
        print(f"{name}, {TESTED} new episodes: {summary(task, swum)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
