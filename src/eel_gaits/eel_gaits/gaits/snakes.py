# SPDX-License-Identifier: Apache-2.0
"""Gaits of snake robots: the serpenoid curve, and a wave of joint angles.

serpenoid: the angle of the backbone is a sine of the arc length. Its curvature is

    K3(t, X) = winding_angle k cos(k X - 2 pi t / T) - left_bend,   k = 2 pi waves / L

(Hirose, Biologically Inspired Robots, Oxford University Press, 1993).

joint_wave: the angle of joint i of n, counted from the tail as on the robot Mamba, is

    phi_i(t) = alpha g(i) sin(2 pi t / T + (i - 1) delta) + phi_0,   g = 1 or (n - i) / (n + 1)

(Kelasidi, Liljeback, Pettersen and Gravdahl, Robotics and Biomimetics 2:8 (2015), doi:10.1186/s40638-015-0029-4). With
delta > 0 the wave runs from head to tail. A joint stands for a segment of the length L / n and lies in its middle. The
angle of each joint is the integral of the curvature K3 over its segment, exactly: phi > 0 bends the tail to the right.
"""

import math
from dataclasses import dataclass
from typing import Any

from eel_common.quantity import quantity

from eel_gaits.gaits.numbers import TO_THE_LEFT, PeriodicBody, left_quantity, left_turn, waves_quantity
from eel_gaits.gaits.registry import register
from eel_gaits.laws.term import Term


@dataclass(frozen=True, kw_only=True)
class Serpenoid(PeriodicBody):
    waves: float = waves_quantity(1.0)
    winding_angle: float = quantity(0.5, "rad", "greatest angle of the backbone to its mean direction", -1e3, 1e3)
    left_bend: float = left_quantity(0.0, "yaw curvature of a turn")


@dataclass(frozen=True, kw_only=True)
class JointWave(PeriodicBody):
    joints: float = quantity(10.0, "", "number of joints, n", 1.0, 1000.0, whole=True)
    joint_amplitude: float = quantity(0.35, "rad", "amplitude of the joint angles, alpha", -math.pi, math.pi)
    joint_phase: float = quantity(0.6, "rad", "phase from joint to joint, delta", -math.pi, math.pi)
    left_angle: float = quantity(0.0, "rad", f"offset of every joint, -phi_0{TO_THE_LEFT}", -math.pi, math.pi)
    eel_like: float = quantity(1.0, "", "amplitude along the body: 1: (n - i) / (n + 1), 0: g = 1", 0.0, 1.0)


@register(Serpenoid)
def serpenoid(numbers: Serpenoid) -> tuple[Term, ...]:
    """The serpenoid curve of Hirose, travelling from head to tail."""
    amplitude = 2.0 * math.pi * numbers.waves / numbers.length * numbers.winding_angle
    wave = Term(
        amplitude=(amplitude,),
        wavelength=numbers.length / numbers.waves,
        period=numbers.period,
        phase=0.5 * math.pi,
        envelope=numbers.start,
    )
    return (wave, *left_turn(numbers.left_bend, numbers.start))


@register(JointWave)
def joint_wave(numbers: JointWave) -> tuple[Term, ...]:
    """A wave of joint angles, as of snake robots: lateral undulation (eel_like = 0) or eel-like motion (1)."""
    n, segment = numbers.joints, numbers.length / numbers.joints
    # i - 1 = n - 1/2 - X / segment at joint i, so its angle is (first + growth X) sin(2 pi t / T + phase + k X)
    first = numbers.joint_amplitude * (1.0 - numbers.eel_like + numbers.eel_like * (-0.5) / (n + 1.0))
    growth = numbers.joint_amplitude * (numbers.eel_like / ((n + 1.0) * segment))
    phase, wave_number = numbers.joint_phase * (n - 0.5), -numbers.joint_phase / segment
    half = 0.5 * wave_number * segment
    # The integrals over a segment of sin theta, cos theta and (X - X_i) sin theta are S sin theta_i, S cos theta_i and
    # S (1/k - h cot kh) cos theta_i, with h = segment / 2 and S = 2 sin(kh) / k. The last one is the shift.
    if abs(half) < 1e-6:
        share, shift = 1.0 / segment, 0.0
    else:
        share = half / math.sin(half) / segment
        shift = 1.0 / wave_number - 0.5 * segment / math.tan(half)
    # sin(2 pi t / T + b) = sin(-2 pi t / T + pi - b), and a term has -2 pi t / T beside its wave number
    wavelength = -2.0 * math.pi / wave_number if wave_number else 0.0
    shared: dict[str, Any] = {"wavelength": wavelength, "period": numbers.period, "envelope": numbers.start}
    wave = Term(amplitude=(share * first, share * growth), phase=math.pi - phase, **shared)
    correction = Term(amplitude=(-share * growth * shift,), phase=0.5 * math.pi - phase, **shared)
    bend = left_turn(numbers.left_angle / segment, numbers.start)
    return (wave, correction, *bend) if growth * shift else (wave, *bend)
