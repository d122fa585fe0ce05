# SPDX-License-Identifier: Apache-2.0
"""Learn to hold a heading: CMA-ES trains a policy of ten numbers in Eel/Heading-v0.

    python docs/examples/hold_heading.py                                # trains, tests, writes hold_heading.json
    python docs/examples/hold_heading.py --draw docs/images/hold_heading.png

The policy is one row of weights: action = tanh(weights . (observation, 1)). `policy_controller.py` lets it steer the
dynamics node.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import eel_dynamics.gym  # noqa: F401, it registers the environments
import gymnasium
import numpy as np
from heading_policy import FILE, actions_of

TASK = {"id": "Eel/Heading-v0", "control_period": 0.1, "duration": 12.0}
POPULATION, EPISODES, GENERATIONS, SEED = 12, 4, 25, 1
TESTED, TEST_SEED = 20, 100_000  # episodes, none of which was trained on


def swim(weights: np.ndarray, seeds: list[int]) -> dict[str, np.ndarray]:
    """Swim an episode with each row of `weights` (n, 10), from the n `seeds`.

    Returns `reward` (n,) [s] in total, and over the control steps T `error` (T, n) [rad] of the heading and `position`
    (T, n, 2) [m].
    """
    envs = gymnasium.make_vec(num_envs=len(seeds), **TASK)
    observations, _ = envs.reset(seed=seeds)
    total, errors, positions = np.zeros(len(seeds)), [], []
    for _ in range(round(TASK["duration"] / TASK["control_period"])):
        observations, rewards, _, _, _ = envs.step(actions_of(weights, observations))
        total += rewards
        errors.append(observations[:, 0])
        positions.append([head.position[:2] for head in envs.get_attr("head")])
    envs.close()
    return {"reward": total, "error": np.array(errors), "position": np.array(positions)}


def train() -> dict:
    """Train a policy. Returns what the file holds."""
    import cma  # here: it imports the whole of scipy.stats and pyplot

    search = cma.CMAEvolutionStrategy(np.zeros(10), 0.3, {"popsize": POPULATION, "seed": SEED, "verbose": -9})
    began, curve = time.monotonic(), []
    for generation in range(GENERATIONS):
        candidates = np.array(search.ask())
        seeds = [1 + EPISODES * generation + episode for episode in range(EPISODES)]  # the same for all candidates
        rewards = swim(np.repeat(candidates, EPISODES, axis=0), seeds * POPULATION)["reward"]
        rewards = rewards.reshape(POPULATION, EPISODES).mean(axis=1)
        search.tell(list(candidates), list(-rewards))
        curve.append([float(rewards.mean()), float(rewards.max())])
        print(f"generation {generation + 1:2d}: mean reward {curve[-1][0]:.3f} s of {TASK['duration']:g} s", flush=True)
    print(f"trained in {time.monotonic() - began:.0f} s")
    return {"task": TASK, "weights": search.result.xfavorite.tolist(), "curve": curve}


def final_error(weights: np.ndarray) -> np.ndarray:
    """Mean size [rad] of the error over the last 4 s of each test episode."""
    error = swim(np.tile(weights, (TESTED, 1)), list(range(TEST_SEED, TEST_SEED + TESTED)))["error"]
    return np.abs(error[-round(4.0 / TASK["control_period"]) :]).mean(axis=0)


def draw(found: dict, path: Path) -> None:
    """Draw the learning curve, and six test episodes with and without the policy."""
    from matplotlib.figure import Figure

    weights, seeds = np.array(found["weights"]), list(range(TEST_SEED, TEST_SEED + 6))
    with_policy, without = (swim(np.tile(each, (6, 1)), seeds) for each in (weights, np.zeros(10)))
    time_ = TASK["control_period"] * np.arange(1, len(without["error"]) + 1)
    figure = Figure(figsize=(10.0, 3.4), dpi=100, layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    mean, best = np.array(found["curve"]).T
    left.plot(range(1, len(mean) + 1), mean, color="#0072B2", label="mean of the population")
    left.plot(range(1, len(best) + 1), best, color="#0072B2", alpha=0.4, label="best")
    left.set(xlabel="generation", ylabel=f"reward of an episode [s], at most {TASK['duration']:g}", title="learning")
    for swum, colour, label in ((without, "#888888", "action 0"), (with_policy, "#D55E00", "policy")):
        lines = middle.plot(time_, np.degrees(swum["error"]), color=colour, linewidth=1.0)
        lines[0].set_label(label)
        for path_ in swum["position"].swapaxes(0, 1):
            right.plot(*path_.T, color=colour, linewidth=1.0)
    middle.set(xlabel="t [s]", ylabel="error of the heading [degrees]", title="six test episodes")
    right.set(xlabel="x [m], wanted heading", ylabel="y [m], left", title="paths of the head", aspect="equal")
    left.legend(), middle.legend()
    for axes in (left, middle, right):
        axes.grid(alpha=0.3)
    figure.savefig(path)
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--policy", type=Path, default=FILE, help="file of the policy")
    parser.add_argument("--draw", type=Path, metavar="PNG", help="draw the policy of the file; no training")
    words = parser.parse_args()
    if words.draw is not None:
        draw(json.loads(words.policy.read_text()), words.draw)
        return 0
    found = train()
    words.policy.write_text(json.dumps(found) + "\n")
    for name, weights in (("action 0", np.zeros(10)), ("policy", np.array(found["weights"]))):
        errors = np.degrees(final_error(weights))
        mean, worst = errors.mean(), errors.max()
        print(f"{name}: error over the last 4 s of {TESTED} new episodes: mean {mean:.1f}, worst {worst:.1f} degrees")
    return 0


if __name__ == "__main__":
    sys.exit(main())
