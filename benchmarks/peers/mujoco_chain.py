# SPDX-License-Identifier: Apache-2.0
"""MuJoCo as a peer: a chain of N rigid ellipsoids with its fluid model, driven through a law's joint angles.

python mujoco_chain.py task.npz        # in MuJoCo's own environment; prints one line of JSON

Neighbours turn about each other in pitch and yaw, each by the integral of K over half a link to either side. Servos
hold the angles: stiff springs, damped implicitly, with the rate fed forward. Each link has the body's mass over its
length; its ellipsoid is as wide and high as the body in its middle, and 3/2 as long as the link, so that its volume is
the link's. The steps are made by `mujoco.rollout`, in compiled code.
"""

import json
import statistics
import sys
import time

import mujoco
import numpy as np
from mujoco import rollout

STIFFNESS = 200.0  # N m/rad
LAG = 0.02  # s, damping by stiffness


def chain(length, half_width, half_height, density, water, viscosity, step, integrator) -> mujoco.MjModel:
    """The model: `half_width`, `half_height` (N,) [m] in the middle of the links."""
    link = length / len(half_width)
    bodies, ends, servos = [], [], []
    for k, (b, a) in enumerate(zip(half_width, half_height, strict=True)):
        joints = "<freejoint/>"
        if k:
            joints = f'<joint name="p{k}" axis="0 1 0"/><joint name="y{k}" axis="0 0 1"/>'
            for name in (f"p{k}", f"y{k}"):
                servos.append(
                    f'<general joint="{name}" biastype="affine" gainprm="{STIFFNESS}" '
                    f'biasprm="0 -{STIFFNESS} -{STIFFNESS * LAG}"/>'
                )
        mass = density * np.pi * a * b * link
        bodies.append(
            f'<body pos="{link if k else 0.0} 0 0">{joints}'
            f'<geom type="ellipsoid" pos="{link / 2} 0 0" size="{0.75 * link} {b} {a}" mass="{mass}"'
            ' fluidshape="ellipsoid" contype="0" conaffinity="0"/>'
        )
        ends.append("</body>")
    xml = (
        f'<mujoco><option timestep="{step}" integrator="{integrator}" density="{water}" viscosity="{viscosity}" '
        f'gravity="0 0 0"/><worldbody>{"".join(bodies)}{"".join(ends)}</worldbody>'
        f"<actuator>{''.join(servos)}</actuator></mujoco>"
    )
    return mujoco.MjModel.from_xml_string(xml)


def swim(model, targets, batch: int = 1):
    """Roll out `batch` equal swimmers from rest under `targets` (steps, 2 (N - 1)) [rad]; their states."""
    data = mujoco.MjData(model)
    start = np.zeros((batch, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    mujoco.mj_getState(model, data, start[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start[:] = start[0]
    states, _ = rollout.rollout(model, data, start, control=targets[None])
    return states[:, :, 1:]  # without the time


def added_mass_share(model) -> float:
    """How many times its own mass the first link seems to weigh when it is pushed sideways from rest: 1 without added
    mass in the acceleration terms."""
    alone = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="1e-6" density="{model.opt.density}" gravity="0 0 0"/><worldbody><body><freejoint/>'
        f'<geom type="ellipsoid" size="{" ".join(map(str, model.geom_size[0]))}" mass="{model.body_mass[1]}" '
        'fluidshape="ellipsoid"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(alone)
    data.xfrc_applied[1, 1] = 1.0
    mujoco.mj_step(alone, data)
    return float(1.0 / (alone.body_mass[1] * data.qvel[1] / alone.opt.timestep))


def main(path: str) -> int:
    """Measure the task in the file at `path`."""
    task = dict(np.load(path))
    step = float(task["step"])
    names = ("length", "half_width", "half_height", "density", "water", "viscosity")
    model = chain(*(task[name] for name in names), step, str(task["integrator"]))
    times = []
    for _ in range(int(task["repeats"])):
        start = time.process_time()
        states = swim(model, task["targets"])
        times.append(time.process_time() - start)
    start = time.process_time()
    batch = int(task["batch"])
    swim(model, task["targets"], batch)
    head = states[0, :, :3]
    angles = states[0, :, 7 : 7 + task["angles"].shape[1]]
    print(
        json.dumps(
            {
                "version": mujoco.__version__,
                "seconds": statistics.median(times),
                "batch_seconds": (time.process_time() - start) / batch,
                "head": head[-1].tolist(),
                "path": float(np.sum(np.linalg.norm(np.diff(head, axis=0), axis=1))),
                "shape_error": float(np.max(np.abs(angles - task["angles"]))),
                "added_mass_share": added_mass_share(model),
            }
        )
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
