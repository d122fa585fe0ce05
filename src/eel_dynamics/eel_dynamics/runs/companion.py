# SPDX-License-Identifier: Apache-2.0
"""Estimates the error of a run: its distance from a companion, a run of the same swimmer with coarser settings.

For a swimmer without an end, as in the node, `ErrorMeter` does this (eel_dynamics/simulation/error_meter.py), and
`ErrorMonitor` reports an error above the target (eel_dynamics/ros/loop/error_monitor.py).

If the estimate exceeds the target, the run becomes the companion of a finer one, up to `MOST_REFINEMENTS` times. A
warning names an error that then still exceeds the target.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.accuracy.error_estimate import (
    PROMISED,
    SMALL,
    ErrorEstimate,
    angle_between,
    floors_of,
    growth_rate_of,
    twist_size,
)
from eel_dynamics.analysis.peaks import torque_size
from eel_dynamics.model.scene import ROUGH_FRICTION, Scene
from eel_dynamics.simulation.bending.joint_motion import bends, stops_met, torque_at_stops
from eel_dynamics.simulation.error_meter import on_another_grid
from eel_dynamics.simulation.stopping import SimulationStopped

ACCEPTED = 1.5  # an estimate must be below the target / this factor
MOST_REFINEMENTS = 4  # refinements of a run whose error exceeds its target
BLENDED_ORDER = 3.0  # greatest order of the grid's error if the friction law changes along the body
RESAMPLING = 1.0 / 3.0  # 1 / (2^p - 1) of the order p = 2 of an interpolation
# The companion has every third sample, if there are many. A period has 20 of them by default, so that three
# periods together show the same phases.
COMPARED_EVERY, MANY_SAMPLES = 3, 100
HALVINGS = 8  # most halvings of an unstable step in the search for a stable one


def relative_errors(run, reference) -> ErrorEstimate:
    """Distance of `run` from `reference`, a run of the same swimmer with the same stations, at the reference's samples.

    Position of the head: the greatest over the later half of the samples, relative to the length of the path, or of the
    body if that is longer. Torque: the greatest over samples and stations, relative to its own maximum. Others: see
    `ErrorEstimate`. Denominators are at least `Floors`. growth_rate: of the distance of the heads.
    """
    time, here = reference.time, np.searchsorted(run.time, reference.time)
    distance = np.linalg.norm(run.position[here] - reference.position, axis=1)
    scale = max(reference.path_length, reference.body.length)
    later = distance[time >= 0.5 * time[-1]]
    least = floors_of(run.law, run.body_mass, run.body.length, float(time[-1]))
    speeds = np.maximum(twist_size(reference.twist), (least.speed, least.rate))
    apart = {
        "position": later.max() / scale,
        "orientation": angle_between(run.orientation[here], reference.orientation).max(),
        "twist": (twist_size(run.twist[here] - reference.twist) / speeds).max(),
    }
    own, others = bends(run, vars(run)), bends(reference, vars(reference))
    if own.size and others.size:
        differs = np.abs(own[:, here] - others)
        apart["joint_angle"] = differs[0].max()
        apart["joint_rate"] = differs[1].max() / max(np.abs(others[1]).max(), least.rate)
    found: dict[str, Any] = {"torque": None} | {name: float(value) for name, value in apart.items()}
    if run.torque is not None and reference.torque is not None:
        torques = torque_size(run.torque[here] - reference.torque)
        found["torque"] = float(torques.max() / max(torque_size(reference.torque).max(), least.torque))
    return ErrorEstimate(growth_rate=growth_rate_of(time, distance, SMALL * scale), **found)


def error_at_stops(run, reference) -> float:
    """The difference of two runs in `torque_at_stops`, relative to the greatest of the `reference`."""
    if run.robot is None or run.torque is None or reference.torque is None:
        return 0.0
    apart = np.abs(run.joint_angle[np.searchsorted(run.time, reference.time)] - reference.joint_angle).max(axis=0)
    least = floors_of(run.law, run.body_mass, run.body.length, float(run.time[-1])).torque
    greatest = max(torque_size(reference.torque).max(), least)
    return torque_at_stops(run.robot, stops_met(run.robot, run.joint_angle), apart) / greatest


def with_error_estimate(swim: Any, observed: Any) -> Any:
    """The `swim` of an `ObservedSwim` with the `error_estimate` of its run; or a finer swim, for the target.

    A run that stopped early has no estimate. A run is not refined without a target, nor if motors are far too slow, as
    that would take minutes.
    """
    others = []
    target = observed.swimmer.accuracy.target
    if swim.stopped is not None or len(observed.times) < 2:
        return swim
    marching = _for_comparison(observed)
    companion = _finished(marching, swim.run.accuracy.coarser().by_adams(), swim.run.nodes)
    for refinement in range(MOST_REFINEMENTS + 1):
        error = ErrorEstimate(np.inf, None)
        if companion is not None:
            error = relative_errors(swim.compared, companion.compared)
            error = error.with_torque(error_at_stops(swim.compared, companion.compared))
        if refinement and companion is not None:  # a faster fall is agreement by chance
            share = swim.run.accuracy.tolerance / companion.run.accuracy.tolerance
            if observed.swimmer.scene.friction in ROUGH_FRICTION:
                share = max(share, (companion.run.nodes / swim.run.nodes) ** BLENDED_ORDER)
            error = error.at_least(share, companion.run.error_estimate)
        others += [] if companion is None else [companion.run]
        cost = sum(each.evaluations * each.nodes for each in others)
        error = replace(error, evaluations=sum(each.evaluations for each in others), cost=cost)
        swim = swim._replace(run=replace(swim.run, error_estimate=error))
        if target is None or error.worst <= target / ACCEPTED or refinement == MOST_REFINEMENTS:
            break
        if refinement == 0 and (slow := observed.slow_motors) is not None and slow.far:
            break
        if refinement and error.hopeless(target, float(swim.run.time[-1])):  # the first two may be far apart
            break
        tightened = swim.run.accuracy.tightened(target / ACCEPTED / error.worst)
        finer = _finished(observed, tightened, swim.run.nodes)
        if finer is None:
            break
        settings = replace(finer.run.accuracy, target=target)
        companion, swim = swim, finer._replace(run=replace(finer.run, accuracy=settings))
    return swim._replace(run=_with_resampling(swim.run, marching, others))


def _with_resampling(run, observed, others: list):
    """The `run` with the interpolation error of its law's rows, if that is a `SampledLaw`.

    Two companions, one with every second row and point of the law, differ by at least `1 / RESAMPLING` of this error
    for a smooth law, as the interpolation is at least of second order.
    """
    law, error = run.law, run.error_estimate
    if not isinstance(law, SampledLaw) or error is None or not others:
        return run
    settings = others[0].accuracy
    coarse = _finished(observed.of_swimmer(law=law.coarser()), settings)
    if coarse is None:
        return replace(run, error_estimate=replace(error, position=np.inf, resampling=np.inf))
    apart = {name: RESAMPLING * value for name, value in relative_errors(others[0], coarse.run).errors.items()}
    error = replace(
        error,
        **{name: value + apart.get(name, 0.0) for name, value in error.errors.items()},
        evaluations=error.evaluations + coarse.run.evaluations,
        cost=error.cost + coarse.run.evaluations * coarse.run.nodes,
        resampling=max(apart.get(name, 0.0) for name in PROMISED),
    )
    return replace(run, error_estimate=error)


def _for_comparison(observed):
    """The `observed` swim reduced for comparison: motion and torque, at some of the instants, with the last.

    Without a ledger Adams' method is cheaper.
    """
    times = observed.instants
    if len(times) > MANY_SAMPLES:
        times = times[(len(times) - 1) % COMPARED_EVERY :: COMPARED_EVERY].copy()
    observed = observed.of_swimmer(scene=_without_ledger(observed.swimmer.scene))
    return observed._replace(load=False, times=times, every=1)


@lru_cache(maxsize=64)
def _without_ledger(scene: Scene) -> Scene:
    return replace(scene, ledger=False)


def _finished(observed, accuracy: Accuracy, nodes: int | None = None):
    """The swim with these settings, on a grid that does not have `nodes`; None if it stops early."""
    try:
        march = on_another_grid(observed.march, accuracy, nodes)
    except (SimulationStopped, ValueError):  # a law that cannot be started
        return None
    try:
        swim = observed.swim(march)
    except SimulationStopped:
        return None
    return swim if swim.stopped is None else None


def stable_step(observed, accuracy: Accuracy) -> float | None:
    """The longest step [s], found by halving that of `accuracy`, with which the swim of `observed` reaches its end.

    None if `HALVINGS` give none.
    """
    assert accuracy.step is not None
    steps = [accuracy.step * 0.5**halvings for halvings in range(1, HALVINGS + 1)]
    return next((step for step in steps if _finished(observed, replace(accuracy, step=step)) is not None), None)
