# SPDX-License-Identifier: Apache-2.0
"""Writes data/rigid_chain.csv: the tumbling of a chain of nine rigid links in vacuum, by MuJoCo.

python make_rigid_chain.py data/rigid_chain.csv        # where MuJoCo is installed

The body is an ellipsoid that is cut into links of equal length; the joints are hinges in yaw and pitch by turns, with
springs, dampers, armature and constant torques. test_rigid_chain.py has the same numbers, and joints of a width that
goes to 0. Steps of half the length change the head's path by less than 1e-9 m.
"""

import sys
from pathlib import Path

import mujoco
import numpy as np

LINKS, LENGTH, HALF_WIDTH, HALF_HEIGHT, DENSITY = 9, 1.0, 0.03, 0.05, 1000.0  # -, m, m, m, kg/m^3
STIFFNESS, DAMPING, ARMATURE = 0.1, 0.005, 2e-4  # N m/rad, N m s/rad, kg m^2
TORQUES = (0.05, -0.04, 0.06, 0.05, -0.05, 0.04, 0.03, -0.02)  # N m, in the joints' signs
SPIN = (0.5, 2.0, 3.0)  # rad/s, of the head at the start
END, SAMPLE, STEP = 2.0, 0.1, 1e-4  # s


def chain() -> mujoco.MjModel:
    """The model: the head's nose at the origin, the body along -x. A turn about y is pitch, one about -z yaw."""
    link = LENGTH / LINKS
    text = "<body><freejoint/>" + inertial_of(0)
    for k in range(1, LINKS):
        axis = "0 0 -1" if k % 2 else "0 1 0"
        text += (
            f'<body pos="{-link} 0 0"><joint type="hinge" axis="{axis}" stiffness="{STIFFNESS}" damping="{DAMPING}" '
            f'armature="{ARMATURE}"/>{inertial_of(k)}'
        )
    text += LINKS * "</body>"
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 0" integrator="RK4"><flag contact="disable"/></option>'
        f"<worldbody>{text}</worldbody></mujoco>"
    )


def inertial_of(index: int) -> str:
    """Mass, centre and moments of inertia of a link, about its centre, by Gauss' rule: they are polynomials of X."""
    link = LENGTH / LINKS
    points, weights = np.polynomial.legendre.leggauss(8)
    own = 0.5 * link * (1.0 + points)  # m from the link's front end
    x = index * link + own
    share = 4.0 * x * (LENGTH - x) / LENGTH**2  # squares of the half-axes by the greatest ones'
    mass = DENSITY * np.pi * HALF_WIDTH * HALF_HEIGHT * share * 0.5 * link * weights
    centre = mass @ own / mass.sum()
    across = np.array([HALF_WIDTH**2 + HALF_HEIGHT**2, HALF_HEIGHT**2, HALF_WIDTH**2]) / 4.0 * (mass @ share)
    inertia = across + np.array([0.0, 1.0, 1.0]) * (mass @ (own - centre) ** 2)
    numbers = " ".join(map(str, inertia))
    return f'<inertial pos="{-centre} 0 0" mass="{mass.sum()}" diaginertia="{numbers}"/>'


def tumble(step: float) -> np.ndarray:
    """Time, the head's place and the joints' angles (T, 1 + 3 + 8) [s, m, rad]."""
    model = chain()
    model.opt.timestep = step
    data = mujoco.MjData(model)
    data.qvel[3:6] = SPIN
    data.qfrc_applied[6:] = TORQUES
    rows = []
    for _ in range(round(END / SAMPLE) + 1):
        rows.append((data.time, *data.qpos[:3], *data.qpos[7:]))
        for _ in range(round(SAMPLE / step)):
            mujoco.mj_step(model, data)
    return np.array(rows)


if __name__ == "__main__":
    found = tumble(STEP)
    assert np.abs(found - tumble(2.0 * STEP)).max() < 1e-8
    head = "time,x,y,z," + ",".join(f"joint_{k}" for k in range(1, LINKS))
    np.savetxt(Path(sys.argv[1]), found, fmt="%.10f", delimiter=",", header=head, comments="")
    print(f"MuJoCo {mujoco.__version__}: {len(found)} rows")
