# SPDX-License-Identifier: Apache-2.0
"""Robots: bodies that bend by themselves, by the number of joints and how stiff their motors are."""

import statistics
import time
from functools import partial

import numpy as np
from measuring import MOTION, Lines, times_in_turn

from eel_dynamics import Accuracy, Joint, PassiveTail, Robot, Scene, Servo, simulate
from eel_gaits import straight

DURATION = 10.0  # s
TARGETS, DELIVERED = (0.1, 0.03, 0.01, 1e-3), 1e-3  # relative errors
JOINTS, GAINS = (4, 8, 16), (10.0, 100.0)  # N m/rad
LAG = 0.027  # s, kd by kp, as of the ready servos
FINEST = Accuracy(name="finest", resolution=36.0, tolerance=1e-8)


def chain(joints: int, gain: float) -> Robot:
    """Equidistant servos from 0.15 to 0.92 m, with the rotor of the ready ones."""
    servo = Servo(kp=gain, kd=LAG * gain, gear=212.6, rotor_inertia=3.6e-7)
    return Robot([Joint(float(x), actuator=servo) for x in np.linspace(0.15, 0.92, joints)])


def robots() -> Lines:
    """10 s of straight() by robots, laminar friction, motion alone: times real time on one core (CPU time) at the
    loosest target that delivers an error of 1e-3, and at the target 1e-3. The error is the
    head's, by its path, against a run at 1e-8."""
    cases = {f"{joints} servos, kp {gain:g} N m/rad": chain(joints, gain) for gain in GAINS for joints in JOINTS}
    cases |= {name: Robot.named(name) for name in ("eight_servos", "series_elastic", "passive_tail")}
    cases["passive tail, 8 modes"] = Robot([PassiveTail(0.6, 0.3, 0.01, modes=8)])
    for where, planar in (("plane", True), ("space", False)):
        scene = Scene(friction="laminar", planar=planar, **MOTION)
        for name, robot in cases.items():
            swim = partial(simulate, straight(), DURATION, robot=robot, scene=scene, sample_period=DURATION, stations=2)
            bare = {target: partial(swim, accuracy=target, estimate=False) for target in TARGETS}
            finest, runs = swim(accuracy=FINEST, estimate=False), {target: run() for target, run in bare.items()}
            ends = {target: run.position[-1] - finest.position[-1] for target, run in runs.items()}
            errors = {target: float(np.linalg.norm(apart)) / finest.path_length for target, apart in ends.items()}
            loosest = next((target for target in TARGETS if errors[target] <= DELIVERED), TARGETS[-1])
            found = times_in_turn({target: bare[target] for target in (loosest, TARGETS[-1])}, clock=time.thread_time)
            for target, times in found.items():
                said = f"times real time, error {errors[target]:.1e}, {runs[target].evaluations} evaluations"
                yield f"{where}, {name}, target {target:g}", DURATION / statistics.median(times), said
