# SPDX-License-Identifier: Apache-2.0
"""The straight gait in the street of vortices behind a cylinder, over its spacing and the phase at the start.

The cylinder moves ahead of the swimmer at the swimmer's own speed U in still water: seen from the cylinder, the swimmer
would hold its place in a stream U. Its wake is von Karman's street (Lamb, Hydrodynamics, 1932, art. 156): spacing a of
a row, width 0.281 a between the rows, circulation 2 sqrt(2) a v, where v is the speed with which the street follows the
cylinder. With the shedding frequency St U / D: a = (U - v) D / (St U). The cores are those of a wake near the cylinder.

A steered law keeps the swimmer on the middle line by a bend of the body; without it the street throws it out.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from eel_common.attitude import heading
from eel_gaits.laws.steered_law import SteeredLaw

from eel_dynamics import Flow, Scene, Simulation, Uniform, VortexStreet
from eel_gaits import straight

STROUHAL = 0.2  # of shedding, of a cylinder at Re 1e3 to 1e5
FOLLOWING = 0.15  # v / U: the street follows the cylinder at this part of its speed
WIDTH = 0.281  # of the spacing
CORE = 0.5  # of the diameter: radius of the cores
STEP = 0.02  # s, of the steering
GAIN, TOWARDS, MOST = 1.0, 0.5, 0.6  # 1/m per rad; rad per body length aside; rad/m
SETTLE, MEASURED = 16, 12  # periods
LENGTH, MARGIN = 40.0, 4.0  # m: of the street, and of it behind the swimmer
SCENE = Scene(planar=True, friction="laminar", internal_wrench=False)


class Swum(NamedTuple):
    """Means over the last periods."""

    speed: float  # m/s, along the street, against the water far away
    power: float  # W, of the actuators, net
    paid: float  # W, without what they get back: of the instants with positive power


class Wake:
    """A street behind a cylinder that moves at `speed` [m/s], with this `spacing` [m] of its vortices.

    Attributes:
        diameter: of the cylinder [m]. core: radius of the vortices' cores [m]. circulation: of each vortex [m^2/s].
        mean: velocity of the water on the middle line [m/s], towards the cylinder: circulation / spacing, but for what
            part of the vorticity of Gaussian cores lies across the line.
    """

    def __init__(self, speed: float, spacing: float):
        self.speed, self.spacing = speed, spacing
        self.diameter = STROUHAL * spacing / (1.0 - FOLLOWING)
        self.core = CORE * self.diameter
        self.circulation = 2.0 * math.sqrt(2.0) * spacing * FOLLOWING * speed
        self.mean = self.circulation / spacing * math.erf(0.5 * WIDTH * spacing / self.core)

    def flow(self, phase: float) -> VortexStreet:
        """The street; `phase` (0 to 1): part of a spacing by which it lies further ahead at the start."""
        return VortexStreet(
            circulation=-self.circulation,  # rows are told from behind, where the street ends
            core=self.core,
            spacing=self.spacing,
            width=WIDTH * self.spacing,
            count=math.ceil(LENGTH / self.spacing),
            start=(-MARGIN + self.spacing * phase, 0.0, 0.0),
            drift=(FOLLOWING * self.speed, 0.0, 0.0),
        )


def swim(flow: Flow | None) -> Swum:
    """A swim of the straight gait along x in `flow`, steered to the line y = 0."""
    law = SteeredLaw(straight())
    simulation = Simulation(scene=SCENE, accuracy=1e-3, stations=3, flow=flow)
    body, period = simulation.body, law.period
    simulation.add_samples(0.0, law.x, *law.begin())
    steps = round(period / STEP)
    total = (SETTLE + MEASURED) * steps
    rows = np.zeros((total + 1, 5))  # x and y of the middle, heading, work, power
    for k in range(total + 1):
        turned = heading(simulation.head.orientation.tolist())
        snapshot = simulation.observe(wrench=False, load=False)
        rows[k] = (*snapshot.backbone[1, :2], turned, simulation.works[0], snapshot.powers[0])
        if k == total:
            break
        last = rows[max(0, k - steps) : k + 1]
        aside, course = last[:, 1].mean(), last[:, 2].mean()
        wanted = -TOWARDS * np.clip(aside / body.length, -1.0, 1.0)
        bend = float(np.clip(GAIN * (wanted - course), -MOST, MOST))
        simulation.add_samples((k + 1) * STEP, law.x, *law.advance({"left_bend": bend}, STEP), waves=2.0)
        simulation.advance((k + 1) * STEP)
    measured = rows[-1 - MEASURED * steps :]
    speed, power = ((measured[-1] - measured[0])[[0, 3]] / (MEASURED * period)).tolist()
    return Swum(speed, power, float(np.maximum(measured[1:, 4], 0.0).mean()))


@dataclass(frozen=True)
class Study:
    """Swims over S spacings [m] and P phases.

    Attributes:
        still: without a street.
        drafting: in uniform water of a street's mean velocity alone.
        swum: (S, P) of each field of `Swum`, by name.
    """

    spacings: np.ndarray
    still: Swum
    drafting: Swum
    swum: dict[str, np.ndarray]

    @property
    def wakes(self) -> list[Wake]:
        """The streets."""
        return [Wake(self.still.speed, float(spacing)) for spacing in self.spacings]


def study_of(spacings: Sequence[float], phases: np.ndarray, progress: Callable[[int, int], object]) -> Study:
    """Swim at all of the `spacings` [m] and `phases`. progress(done, all) is called after each."""
    still, swum = swim(None), []
    wakes = [Wake(still.speed, spacing) for spacing in spacings]
    drafting = swim(Uniform((wakes[0].mean, 0.0, 0.0)))
    for wake, phase in product(wakes, phases.tolist()):
        swum.append(swim(wake.flow(phase)))
        progress(len(swum), len(wakes) * len(phases))
    table = np.array(swum).reshape(len(wakes), len(phases), -1)
    return Study(np.array(spacings), still, drafting, dict(zip(Swum._fields, np.moveaxis(table, -1, 0), strict=True)))


def locked_speed(still: Swum, spacing: Any) -> Any:
    """Of a swimmer [m/s] that passes one `spacing` [m] of its street in each beat."""
    return FOLLOWING * still.speed + spacing / straight().terms[0].period
