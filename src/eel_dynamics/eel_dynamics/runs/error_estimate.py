"""Every run measures its own error: the distance from a companion, a run of the same swimmer with coarser settings.

The companion has another grid, a looser tolerance and longer longest steps, and so some ten times the error of the run.
Their distance is thus an estimate of the run's error that lies on the safe side. It is not scaled by an order of
convergence: observed orders are 2.3 to 4.9. It sees the growth of errors, which no error of a single step does.

Where the estimate exceeds the target, the run becomes the next companion of a finer one, up to `MOST_REFINEMENTS`
times. A warning names what is then still above the target.
"""

from dataclasses import dataclass, replace

import numpy as np

from eel_dynamics.accuracy.accuracy import Accuracy
from eel_dynamics.simulation.stopping import SimulationStopped

ACCEPTED = 1.5  # factor of the target by which an estimate must lie below it
MOST_REFINEMENTS = 3  # of a run whose error is above its target
ROUND_OFF = 2e-16  # relative error of the arithmetic, which grows with the motion's sensitivity
ROUND_OFF_SHARE = 0.1  # of the target that grown round-off may take
# Part of body length and path beyond which the distance of two runs is no longer small, so that it no longer grows.
SMALL = 0.03
SETTLED = 0.2  # share of a run in which the distance grows from nothing, and says nothing of the sensitivity
LEAST_SAMPLES = 5  # of a fit of the growth rate
# Torques below this part of m (l/T)^2 count by it: m mass, l length, T the shortest period or the run's duration.
TORQUE_FLOOR = 1e-3
HALVINGS = 8  # of an unstable step, at most, in the search for a stable one


@dataclass(frozen=True)
class ErrorEstimate:
    """Relative errors of position and torque, as accuracy targets define them; infinite where they are not known.

    torque is None for a run without internal wrench or stations. growth_rate [1/s]: the distance of two runs grows by
    a factor of e in 1/growth_rate; 0 where it does not grow, or not seen. evaluations: of the head's dynamics that the
    estimate took, beside those of the run; cost: the same, each times the nodes along the body.
    """

    position: float
    torque: float | None
    growth_rate: float = 0.0
    evaluations: int = 0
    cost: int = 0

    @property
    def worst(self) -> float:
        """The greater of the two."""
        return max(self.position, self.torque or 0.0)

    def round_off(self, duration: float) -> float:
        """The relative error that round-off has grown to after `duration` [s] at the `growth_rate`."""
        with np.errstate(over="ignore"):
            return float(ROUND_OFF * np.exp(self.growth_rate * duration))

    def hopeless(self, target: float, duration: float) -> bool:
        """Whether grown round-off alone takes more of the `target` than `ROUND_OFF_SHARE`: no settings help."""
        return self.round_off(duration) > ROUND_OFF_SHARE * target

    def missed(self, target: float | None, duration: float) -> str:
        """One line if the error is above the `target`, else an empty text."""
        if target is None or self.worst <= target:
            return ""
        if not np.isfinite(self.worst):
            return f"the error is not known: a run with coarser settings stopped; the target is {target:g}"
        line = f"the error is estimated at {self.worst:.1e}, above the target {target:g}"
        if self.growth_rate * duration < 1.0:
            return line
        line += f": the motion is sensitive, and errors grow by a factor of e in {1.0 / self.growth_rate:.2g} s"
        if self.hopeless(target, duration):
            line += ", so that round-off alone may spoil it"
        return line


def relative_errors(run, reference) -> ErrorEstimate:
    """Distance of `run` from `reference`, a run of the same swimmer with the same samples and stations.

    Of the head's position: the greatest over the later half of the samples, relative to the length of the path, or of
    the body if that is longer. Of the torque: the greatest over samples and stations, relative to its own maximum,
    which counts for no less than `TORQUE_FLOOR` says. growth_rate: of the distance of the heads.
    """
    distance = np.linalg.norm(run.position - reference.position, axis=1)
    scale = max(reference.path_length, reference.body.length)
    later = distance[run.time >= 0.5 * run.time[-1]]
    position, rate = float(later.max()) / scale, _growth_rate(run.time, distance, SMALL * scale)
    if run.torque is None or reference.torque is None:
        return ErrorEstimate(position, None, rate)
    size = max(np.linalg.norm(reference.torque, axis=2).max(), _least_torque(run))
    return ErrorEstimate(position, float(np.linalg.norm(run.torque - reference.torque, axis=2).max() / size), rate)


def _least_torque(run) -> float:
    time = min((term.period for term in run.law.terms if term.period), default=max(float(run.time[-1]), 1.0))
    return TORQUE_FLOOR * run.body_mass * (run.body.length / time) ** 2


def _growth_rate(time: np.ndarray, distance: np.ndarray, small: float) -> float:
    """Slope [1/s] of the logarithm of the `distance` (T,) over `time` (T,), where it is settled and `small`; or 0."""
    counts = (time >= SETTLED * time[-1]) & (distance > 0.0) & (distance < small)
    if counts.sum() < LEAST_SAMPLES:
        counts = (distance > 0.0) & (distance < small)  # it has grown within the first part
    if counts.sum() < LEAST_SAMPLES:
        return 0.0
    return max(0.0, float(np.polyfit(time[counts], np.log(distance[counts]), 1)[0]))


def with_error_estimate(swim, request):
    """The `swim` of a `request` (`SwimRequest`) with the `error_estimate` of its run; or a finer one, for the target.

    Nothing is estimated for a run that stopped before its end. Without a target nothing is made finer.
    """
    others = []
    target = getattr(request.swimmer.accuracy, "target", None)  # a budget of time has none
    if swim.stopped is not None or len(request.times) < 2:
        return swim
    coarser = swim.run.accuracy.coarser()
    if _nodes(request, coarser) == swim.run.nodes:
        coarser = coarser.with_other_points()
    companion = _finished(request, coarser)
    for refinement in range(MOST_REFINEMENTS + 1):
        error = ErrorEstimate(np.inf, None) if companion is None else relative_errors(swim.run, companion.run)
        others += [] if companion is None else [companion.run]
        cost = sum(each.evaluations * each.nodes for each in others)
        error = replace(error, evaluations=sum(each.evaluations for each in others), cost=cost)
        swim = swim._replace(run=replace(swim.run, error_estimate=error))
        if target is None or error.worst <= target / ACCEPTED or refinement == MOST_REFINEMENTS:
            break
        if refinement and error.hopeless(target, float(swim.run.time[-1])):  # the first pair may be far apart
            break
        finer = _finished(request, swim.run.accuracy.tightened(target / ACCEPTED / error.worst))
        if finer is None:
            break
        companion, swim = swim, _for_target(finer, target)
    return swim


def _for_target(swim, target: float | None):
    return swim._replace(run=replace(swim.run, accuracy=replace(swim.run.accuracy, target=target))) if target else swim


def _nodes(request, accuracy: Accuracy) -> int | None:
    """Number of nodes along the body with the settings `accuracy`; None where the swim cannot begin."""
    try:
        return len(request.simulation(accuracy).grid.x)
    except (SimulationStopped, ValueError):
        return None


def _finished(request, accuracy: Accuracy):
    """The swim with the settings `accuracy`; None where it does not come to its end."""
    try:
        swim = request.swim(accuracy)
    except (SimulationStopped, ValueError):
        return None
    return swim if swim.stopped is None else None


def stable_step(swim, accuracy) -> float | None:
    """The longest step [s], by halving that of `accuracy`, at which `swim(accuracy)` does not stop; None if none is."""
    step = accuracy.step
    for _ in range(HALVINGS):
        step *= 0.5
        try:
            swim(replace(accuracy, step=step))
        except SimulationStopped:
            continue
        return step
    return None
