# SPDX-License-Identifier: Apache-2.0
"""MuJoCo at its best for an imposed shape: its chain with the joints prescribed, the head's six equations solved here.

python mujoco_prescribed.py task.npz        # in MuJoCo's own environment; prints one line of JSON

No servo holds the angles, so no stiffness bounds the step. MuJoCo gives the mass matrix, the bias forces and its
fluid's forces of the chain (mujoco_chain.py); the joints' accelerations are known, and the first six rows are the
head's accelerations. Time goes by the classical Runge-Kutta method of order 4, in Python.
"""

import json
import statistics
import sys
import time

import mujoco
import numpy as np
from mujoco_chain import chain


class PrescribedChain:
    """The chain, and its head's acceleration under given joints."""

    def __init__(self, model: mujoco.MjModel):
        self.model, self.data = model, mujoco.MjData(model)
        self.mass = np.zeros((model.nv, model.nv))

    def acceleration(self, place, velocity, joints) -> np.ndarray:
        """Of the head (6,), in the units and axes of `qvel`. joints: angle, rate and acceleration of each."""
        model, data = self.model, self.data
        angle, rate, acceleration = joints
        data.qpos[:7], data.qpos[7:] = place, angle
        data.qvel[:6], data.qvel[6:] = velocity, rate
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_passive(model, data)
        mujoco.mj_rne(model, data, 0, data.qfrc_bias)
        mujoco.mj_fullM(model, data, self.mass)
        force = data.qfrc_passive[:6] - data.qfrc_bias[:6] - self.mass[:6, 6:] @ acceleration
        return np.linalg.solve(self.mass[:6, :6], force)

    def moved(self, place, velocity, duration: float) -> np.ndarray:
        """Position and quaternion (7,) of the head after a `duration` [s] at a constant velocity."""
        position = np.concatenate((place, self.data.qpos[7:]))
        mujoco.mj_integratePos(self.model, position, np.concatenate((velocity, np.zeros(self.model.nv - 6))), duration)
        return position[:7]

    def swim(self, joints: np.ndarray, step: float) -> np.ndarray:
        """Positions of the head (steps + 1, 3) [m] from rest. joints: (2 steps + 1, 3, joints), at half steps."""
        place, velocity = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), np.zeros(6)
        path = [place[:3]]
        for k in range(0, len(joints) - 1, 2):
            now, middle, end = joints[k : k + 3]
            a1 = self.acceleration(place, velocity, now)
            v2 = velocity + 0.5 * step * a1
            a2 = self.acceleration(self.moved(place, velocity, 0.5 * step), v2, middle)
            v3 = velocity + 0.5 * step * a2
            a3 = self.acceleration(self.moved(place, v2, 0.5 * step), v3, middle)
            v4 = velocity + step * a3
            a4 = self.acceleration(self.moved(place, v3, step), v4, end)
            place = self.moved(place, (velocity + 2.0 * v2 + 2.0 * v3 + v4) / 6.0, step)
            velocity = velocity + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
            path.append(place[:3])
        return np.array(path)


def main(path: str) -> int:
    """Measure the task in the file at `path`."""
    task = dict(np.load(path))
    step = float(task["step"])
    names = ("length", "half_width", "half_height", "density", "water", "viscosity")
    swimmer = PrescribedChain(chain(*(task[name] for name in names), step, "Euler"))
    times = []
    for _ in range(int(task["repeats"])):
        start = time.process_time()
        head = swimmer.swim(task["joints"], step)
        times.append(time.process_time() - start)
    told = {
        "version": mujoco.__version__,
        "seconds": statistics.median(times),
        "head": head[-1].tolist(),
        "path": float(np.sum(np.linalg.norm(np.diff(head, axis=0), axis=1))),
    }
    print(json.dumps(told))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
