# SPDX-License-Identifier: Apache-2.0
"""Ready robots by name, on the body of section 7.2.1 of Boyer, Porez and Leroyer (2010), 1 m long.

The servo is the ROBOTIS DYNAMIXEL XM430-W210 at 12 V. From its e-Manual
(emanual.robotis.com/docs/en/dxl/x/xm430-w210): gear 212.6:1, stall torque 3.0 N m, no-load speed 77 rev/min. Between
these two its torque falls linearly. Its controller sets the voltage: 885 units are the full voltage. The default
position gain, 800/128 = 6.25 units for each of 4096 steps of a turn, is quoted from memory and was not looked up; it is
6.25/885 3.0 N m in 2 pi/4096 rad. The slope of the line, stall torque over no-load speed, damps the motor; the velocity
feed-forward of the same controller subtracts that from the reference. In its position control mode it turns by 360
degrees, half of them to each side; a frame may stop it earlier.

The data sheet does not give the rotor's inertia. Haarnoja et al. (Science Robotics 9, 2024, eadi8022,
doi:10.1126/scirobotics.adi8022), as quoted by others, identified 0.045 kg m^2 after the gear of an XM430-W350. We
assume that this has the same motor with a gear of 353.5:1: 3.6e-7 kg m^2 before the gear.
"""

import math
from dataclasses import replace
from typing import Any

from eel_dynamics.model.robot.actuators import Servo
from eel_dynamics.model.robot.continuous import PassiveTail
from eel_dynamics.model.robot.joint import Joint

STALL_TORQUE = 3.0  # N m
NO_LOAD_SPEED = 77.0 * 2.0 * math.pi / 60.0  # rad/s
STOPS = -math.pi, math.pi  # rad
XM430_W210 = Servo(
    kp=6.25 / 885.0 * STALL_TORQUE / (2.0 * math.pi / 4096.0),
    kd=STALL_TORQUE / NO_LOAD_SPEED,
    torque_limit=STALL_TORQUE,
    speed_limit=NO_LOAD_SPEED,
    gear=212.6,
    rotor_inertia=0.045 / 353.5**2,
)
SERVOS = {"xm430_w210": XM430_W210}
FIRST, SPACING, COUNT = 0.10, 0.12, 8  # m, places of the joints on a body of 1 m
SPRING = 50.0  # N m/rad
"""Of `series_elastic`, chosen: the stall torque winds it by 0.06 rad; with the reflected rotor it resonates at 9 Hz."""
TAIL_STIFFNESS = 0.3  # N m^2
"""Of `passive_tail`: of stiffnesses a factor of 2 apart, the one that swims fastest at a period of 1 s."""
TAIL_DAMPING = 0.01  # N m^2 s, chosen: a loss angle of 0.2 at 1 s


def eight_servos() -> list[Any]:
    """Eight joints in yaw with XM430-W210 servos, from 0.10 m to 0.94 m, each bending over 6 cm."""
    return _chain(XM430_W210)


def series_elastic() -> list[Any]:
    """The same, with a spring of 50 N m/rad between each gear and its joint."""
    return _chain(replace(XM430_W210, series_stiffness=SPRING))


def sixteen_servos() -> list[Any]:
    """Eight universal joints: a joint in yaw and one in pitch at each place of `eight_servos`, with the same servos."""
    return [
        replace(joint, axis=axis, name=f"{axis}_{index}")
        for index, joint in enumerate(_chain(XM430_W210), start=1)
        for axis in ("yaw", "pitch")
    ]


def passive_tail() -> list[Any]:
    """The law is imposed on the front, up to 0.6 m, followed by a passive tail of 0.3 N m^2."""
    return [PassiveTail(0.6, TAIL_STIFFNESS, TAIL_DAMPING)]


def _chain(servo: Servo) -> list[Any]:
    return [Joint(round(FIRST + SPACING * index, 6), limits=STOPS, actuator=servo) for index in range(COUNT)]


READY = {make.__name__: make for make in (eight_servos, sixteen_servos, series_elastic, passive_tail)}
"""Functions that return the parts of a robot, by its name."""
