# SPDX-License-Identifier: Apache-2.0
"""PPO of Stable-Baselines3, with its default numbers, learns a task. Prints the curve as a table. See requirements.txt.

python docs/examples/ppo/train.py heading --seed 1 --steps 49152 --policy heading.npz
"""

import argparse
import time

import gymnasium
import numpy as np
import torch
from eel_gym.stable_baselines import make_vec
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnvWrapper

TASKS = {"heading": "Eel/Heading-v0", "way_points": "Eel/WayPoints-v0"}
SETTINGS: dict = {"accuracy": "standard, fixed steps"}  # those of the dynamics node, which then swims the same path
TESTED, LAST = 20, 40  # episodes of a test; control steps at their end over which the heading's error counts


class Timed(VecEnvWrapper):  # counts the wall time [s] that the environments take
    seconds, reset = 0.0, lambda self: self.venv.reset()

    def step_wait(self):
        began, result = time.perf_counter(), self.venv.step_wait()
        self.seconds += time.perf_counter() - began
        return result


def score(model, task):
    """Over new episodes: mean error of the heading at the end [degrees], or mean number of points that are reached."""
    envs, going, reached, errors = gymnasium.make_vec(TASKS[task], TESTED, **SETTINGS), np.full(TESTED, True), 0, []
    seen, _ = envs.reset(seed=100_000)
    while going.any():
        seen, rewards, terminated, truncated, _ = envs.step(model.predict(seen, deterministic=True)[0])
        reached, going = reached + np.sum(going & (rewards > 0.5)), going & ~(terminated | truncated)
        errors.append(np.degrees(0.5 * np.abs(seen[:, 0])))  # of the heading; its scale is 0.5 rad
    return np.mean(errors[-LAST:]) if task == "heading" else reached / TESTED


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("task", choices=TASKS)
for name, kind, default in (("--seed", int, 1), ("--steps", int, 98_304), ("--policy", str, "policy.npz")):
    parser.add_argument(name, type=kind, default=default)
words, wall, cpu = parser.parse_args(), 0.0, 0.0
torch.set_num_threads(1)  # it is the fastest for a network of this size
envs = Timed(make_vec(TASKS[words.task], num_envs=4, **SETTINGS))
model = PPO("MlpPolicy", envs, seed=words.seed, device="cpu")
print("task,seed,steps,wall s,CPU s,environments % of wall,score", flush=True)
while model.num_timesteps < words.steps:
    wall, cpu = wall - time.perf_counter(), cpu - time.process_time()
    model.learn(model.n_steps * envs.num_envs, reset_num_timesteps=False)
    wall, cpu = wall + time.perf_counter(), cpu + time.process_time()
    row = round(wall, 1), round(cpu, 1), round(100.0 * envs.seconds / wall, 1), round(score(model, words.task), 2)
    print(words.task, words.seed, model.num_timesteps, *row, sep=",", flush=True)
layers = [*model.policy.mlp_extractor.policy_net[::2], model.policy.action_net]  # for policy_controller.py
saved = [(f"{name}_{k}", getattr(each, name).detach()) for k, each in enumerate(layers) for name in ("weight", "bias")]
np.savez(words.policy, **dict(saved))
