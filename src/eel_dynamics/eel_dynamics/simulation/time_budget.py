# SPDX-License-Identifier: Apache-2.0
"""What a budget of time in place of an accuracy buys on this machine: swims of the swimmer at hand are timed."""

import math
import time as clock
from dataclasses import replace
from functools import cache

from eel_base.wording import one_line, shown
from eel_gaits.gaits.diving import falling
from eel_gaits.gaits.swimming import straight
from eel_gaits.laws.law import Law

from eel_dynamics.accuracy.accuracy import BUDGET_TARGETS, Accuracy
from eel_dynamics.accuracy.budget import Budget
from eel_dynamics.simulation.march import March
from eel_dynamics.simulation.simulation_setup import SimulationSetup
from eel_dynamics.simulation.stopping import SimulationStopped


def affordable(setup: SimulationSetup) -> SimulationSetup:
    """The same `setup`; in place of a budget, the finest settings of the `BUDGET_TARGETS` that keep within it.

    They have no target: the error of such a run is measured, and not compared with one. `ValueError` if none do.
    """
    budget, best = setup.accuracy, None
    if not isinstance(budget, Budget):
        return setup
    for target in BUDGET_TARGETS:  # the coarsest first
        settings = Accuracy.of(target).in_scene(setup.scene).as_it_is()
        seconds = swim_time(replace(setup, accuracy=settings))
        if seconds > budget.seconds_per_second:
            break
        best = settings
    if best is None:
        raise ValueError(
            f"accuracy {shown(budget.name)} cannot be met on this machine in this scene: the coarsest run takes "
            f"{1e3 * seconds:.3g} ms per second"
        )
    return replace(setup, accuracy=replace(best, name=budget.name))


@cache
def swim_time(setup: SimulationSetup) -> float:
    """Wall time [s] per simulated second of the falling gait, in a planar scene of the gait straight.

    It is the least of some swims of two seconds with samples every 0.05 s. `ValueError` where such a swim stops, as on
    the edge of a grid.
    """
    law = _scaled(straight() if setup.scene.planar else falling(), setup.body.length)
    duration, best = 2.0, math.inf
    for repeat in range(4):  # the first fills caches
        begin = clock.perf_counter()
        march = March(setup, law)
        try:
            for sample in range(1, 41):
                march.advance(duration * sample / 40, None)
                march.observe(load=False)
        except SimulationStopped as error:
            gait = f"{duration:g} s of the gait {law.name}, by which the time is measured"
            raise ValueError(f"accuracy cannot be a budget of time here: {gait}, stop: {one_line(error)}") from error
        if repeat:
            best = min(best, (clock.perf_counter() - begin) / duration)
    return best


def _scaled(law: Law, length: float) -> Law:
    """A `law` for a body of 1 m, for one of `length` [m]: the same angles and as many waves."""
    terms = [
        replace(
            term,
            wavelength=length * term.wavelength,
            amplitude=tuple(part / length ** (power + 1) for power, part in enumerate(term.amplitude)),
        )
        for term in law.terms
    ]
    return Law(*terms, name=law.name)
