# SPDX-License-Identifier: Apache-2.0
"""Joints whose width goes to 0 against a chain of rigid links in vacuum that MuJoCo tumbled (data/rigid_chain.csv).

make_rigid_chain.py wrote the file, and has the same numbers.
"""

from pathlib import Path

import numpy as np
import pytest

from eel_dynamics import Body, Joint, Robot, Scene, Torque, simulate
from eel_gaits import Law

DATA = Path(__file__).parent / "data" / "rigid_chain.csv"
TORQUES = (0.05, -0.04, 0.06, 0.05, -0.05, 0.04, 0.03, -0.02)  # N m


def half_axis(greatest: float):
    return lambda x: 2.0 * greatest * np.sqrt(x * (1.0 - x))


BODY = Body(length=1.0, half_width=half_axis(0.03), half_height=half_axis(0.05))
VACUUM = Scene(reactive=False, resistive=False, nose=False)


def tumbled(width: float):
    joints = [
        Joint(
            k / 9.0,
            axis=("pitch", "yaw")[k % 2],
            width=width,
            stiffness=0.1,
            damping=0.005,
            armature=2e-4,
            actuator=Torque([torque, torque], time=[0.0, 2.0]),
        )
        for k, torque in enumerate(TORQUES, start=1)
    ]
    return simulate(
        Law(name="none"), 2.0, body=BODY, scene=VACUUM, robot=Robot(joints), accuracy=1e-5, sample_period=0.1,
        twist=(0.5, 2.0, 3.0, 0.0, 0.0, 0.0), stations=2, estimate=False,
    )  # fmt: skip


def test_narrow_joints_converge_to_a_chain_of_rigid_links():
    """The error is of first order in the width; what is left at the width 0 is that of the march."""
    table = np.loadtxt(DATA, delimiter=",", skiprows=1)
    heads, angles = [], []
    for width in (0.02, 0.01, 0.005):
        run = tumbled(width)
        assert run.time == pytest.approx(table[:, 0])
        heads.append(run.position - table[:, 1:4])
        angles.append(run.joint_angle - table[:, 4:])
    sizes = [np.abs(each).max() for each in heads]
    assert np.abs(table[:, 4:]).max() > 0.3 and np.linalg.norm(table[-1, 1:4]) > 0.3  # it bends, and goes far
    assert sizes[0] < 1e-2 and sizes[0] / sizes[1] == pytest.approx(2.0, abs=0.2)
    assert sizes[1] / sizes[2] == pytest.approx(2.0, abs=0.2)
    for each in (heads, angles):  # what is left is of second order
        assert np.abs(2.0 * each[2] - each[1]).max() < 0.2 * np.abs(each[2]).max() + 1e-5, "extrapolated to width 0"
