# SPDX-License-Identifier: Apache-2.0
"""Simulates one run of a law: `simulate`."""

from collections.abc import Callable, Iterable
from typing import Any

from numpy.typing import ArrayLike

from eel_dynamics.accuracy.accuracy import STANDARD, Accuracy
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.flow.flow import Flow
from eel_dynamics.model.robot.robot import Robot
from eel_dynamics.model.scene import Scene
from eel_dynamics.model.wrenches.external_wrench import ExternalWrench
from eel_dynamics.runs.motions import Motion
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.swim import Swim


def simulate(
    law: Motion,
    duration: float | str = 10.0,
    *,
    body: Body | None = None,
    scene: Scene | None = None,
    accuracy: "str | float | Accuracy" = STANDARD,
    sample_period: float | None = None,
    stations: int | ArrayLike = 51,
    position: ArrayLike = (0.0, 0.0, 0.0),
    orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    twist: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    load: bool = False,
    estimate: bool = True,
    most_evaluations: float = MOST_EVALUATIONS,
    progress: Callable[[float, float], None] | None = None,
    flow: Flow | None = None,
    robot: Robot | None = None,
    fins: Iterable[Any] | None = None,
    wrenches: Iterable[ExternalWrench] | None = None,
) -> Run:
    """Simulate `law` for `duration` [s], with samples every `sample_period` [s] from t = 0 on.

    The steps in time do not depend on the sampling. `ValueError` names a bad argument. `SimulationStopped` carries the
    samples so far as `run`.

    Args:
        law: a `Law`, a `SampledLaw`, a function K(t, X) (`eel_gaits.sampled`), or a file (`eel_gaits.read_motion`).
        duration: [s], or "settled": a whole number of periods until the gait has settled (`runs.settled_duration`), at
            most 100.
        body, scene, accuracy: as in `Simulation`.
        sample_period: [s]; None for 0.05 s, or a 20th of the law's shortest period if that is less. The last sample is
            at its last whole multiple: at 0.9 s for a duration of 1 s and a sample period of 0.3 s.
        stations: number of equidistant stations, or their X (M,) [m].
        position: (3,) [m], of the head at the start.
        orientation: (4,) x y z w, at the start.
        twist: (6,) (Omega, V) [rad/s, m/s], in the head's axes, at the start.
        load: whether to compute the water's load along the body too.
        estimate: whether to estimate the error (`Run.error_estimate`). If it exceeds the target, a finer run is
            returned, or a warning given if none is fine enough.
        most_evaluations: of the head's dynamics per simulated second. A law that needs more is refused, or stopped.
        progress: progress(time, left) is called once a second with the simulation time reached [s] and the remaining
            wall time [s], from the rate of the last seconds; NaN until that is good to a factor of 2. Without it, a run
            longer than a minute causes a warning.
        flow: the water's own motion, added to the scene's current (`Gust`, `Wave` ...); None: none.
        robot: joints, tails or muscles that move dynamically. The law is then the reference of its servos, and
            `Run.joint_angle` and the like are their motion; None: the law is imposed.
        fins: a list of `Fin`, and of pairs of them (`Fin.pair`); None: none.
        wrenches: a list of `ExternalWrench`, which act from outside: tows, tethers, thrusters; None: none.
    """
    swim = Swim.of(
        law=law,
        duration=duration,
        body=body,
        scene=scene,
        accuracy=accuracy,
        sample_period=sample_period,
        stations=stations,
        position=position,
        orientation=orientation,
        twist=twist,
        load=load,
        estimate=estimate,
        most_evaluations=most_evaluations,
        flow=flow,
        robot=robot,
        fins=fins,
        wrenches=wrenches,
    )
    return swim.run(progress, stacklevel=3)
