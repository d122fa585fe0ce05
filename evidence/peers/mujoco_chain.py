# SPDX-License-Identifier: Apache-2.0
"""MuJoCo as a peer: a chain of N rigid ellipsoids with its fluid model, driven through a law's joint angles.

python mujoco_chain.py task.npz        # in MuJoCo's own environment; prints one line of JSON

Neighbours turn about each other in pitch and yaw, each by the integral of K over half a link to either side. Each link
has the body's mass over its length; its ellipsoid is as wide and high as the body in its middle, and 3/2 as long as the
link, so that its volume is the link's. There are two ways to drive it:

Servos hold the angles: stiff springs, damped implicitly, with the rate fed forward. The steps are made by
`mujoco.rollout`, in compiled code.

The joints are prescribed, MuJoCo's best for an imposed shape: no stiffness bounds the step. MuJoCo gives the mass
matrix, the bias forces and its fluid's forces; the joints' accelerations are known, and the first six rows are the
head's accelerations. Time goes by the classical Runge-Kutta method of order 4, in Python.
"""

import mujoco
import numpy as np
from mujoco import rollout
from task import answer, read_task, timed

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


def main() -> None:
    """Measure the task. With the joints' motion it is the chain with prescribed joints."""
    task = read_task()
    names = ("length", "half_width", "half_height", "density", "water", "viscosity", "step", "integrator")
    model = chain(*(task[name] for name in names))
    if "joints" in task:
        swimmer = PrescribedChain(model)
        head, seconds = timed(lambda: swimmer.swim(task["joints"], task["step"]), task["repeats"])
        answer(seconds, head)
        return
    states, seconds = timed(lambda: swim(model, task["targets"])[0], task["repeats"])
    _, together = timed(lambda: swim(model, task["targets"], task["batch"]))
    off = states[:, 7 : 7 + task["angles"].shape[1]] - task["angles"]
    answer(
        seconds,
        states[:, :3],
        version=mujoco.__version__,
        batch_seconds=together / task["batch"],
        shape_error=float(np.max(np.abs(off))),
        added_mass_share=added_mass_share(model),
    )


if __name__ == "__main__":
    main()
