# SPDX-License-Identifier: Apache-2.0
"""PyElastica as a peer: a Cosserat rod with its slender-body drag, bent by muscles through a law's curvature.

python elastica_rod.py task.npz        # in PyElastica's own environment; prints one line of JSON

The muscles set the curvature at which the rod is without torque, at each step to that of the law, which is what muscle
torques -B K along the body do. The rod is elastic: it follows as far as its stiffness allows. Its sections are circles
of the area of the body's, since the library's rods are round. Verlet steps, explicit, so that waves of tension limit
them.
"""

import time
from importlib.metadata import version

import elastica as ea
import numpy as np
from numba import njit
from task import answer, read_task


class Simulator(ea.BaseSystemCollection, ea.Forcing):
    """A rod and the loads on it."""


@njit(cache=True)
def _bend(rest, shapes, weights):
    """Curvature without torque (3, n - 1): the sum of the law's tabulated shapes (m, 2, n - 1) by weights (m,)."""
    for j in range(rest.shape[1]):
        pitch, yaw = 0.0, 0.0
        for m in range(len(weights)):
            pitch += weights[m] * shapes[m, 0, j]
            yaw += weights[m] * shapes[m, 1, j]
        rest[0, j], rest[1, j] = yaw, pitch  # the first director is upright


class Muscles(ea.NoForces):
    """Set the curvature without torque at each step."""

    def __init__(self, shapes, weights, step):
        super().__init__()
        self.shapes, self.weights, self.step = shapes, weights, step

    def apply_torques(self, system, time=0.0):
        """`weights` are tabulated at each half step, for the Verlet scheme evaluates in between."""
        _bend(system.rest_kappa, self.shapes, self.weights[round(2.0 * float(time) / self.step)])


def rods_of(task, count: int):
    """`count` equal rods in one system, ready to be stepped; the first of them."""
    simulator, rods = Simulator(), []
    for _ in range(count):
        rod = ea.CosseratRod.straight_rod(
            task["elements"],
            np.zeros(3),
            np.array([1.0, 0.0, 0.0]),
            np.array([0.0, 0.0, 1.0]),
            task["length"],
            task["radius"],
            task["density"],
            youngs_modulus=task["youngs_modulus"],
        )
        simulator.append(rod)
        simulator.add_forcing_to(rod).using(ea.SlenderBodyTheory, dynamic_viscosity=task["viscosity"])
        simulator.add_forcing_to(rod).using(Muscles, task["shapes"], task["weights"], task["step"])
        rods.append(rod)
    simulator.finalize()
    return simulator, rods[0]


def swim(task, steps: int, count: int = 1):
    """Head's positions (T, 3) at the steps; CPU seconds without set-up; the greatest error of the shape."""
    simulator, rod = rods_of(task, count)
    step, stepper, moment = np.float64(task["step"]), ea.PositionVerlet(), np.float64(0.0)
    head, apart = np.zeros((steps + 1, 3)), 0.0
    start = time.process_time()
    for k in range(steps):
        moment = stepper.step(simulator, moment, step)
        head[k + 1] = rod.position_collection[:, 0]
        if k % 100 == 0:
            apart = max(apart, float(np.max(np.abs(rod.kappa - rod.rest_kappa))))
    return head, time.process_time() - start, apart


def main() -> None:
    task = read_task()
    steps, batch = task["steps"], task["batch"]
    for count in {1, batch}:
        swim(task, 20, count)  # compiles
    results = [swim(task, steps) for _ in range(task["repeats"])]
    part = steps // 5  # of a batch, a fifth of the way tells its cost
    together = swim(task, part, batch)[1] * steps / part / batch if batch > 1 else None
    head, _, apart = results[0]
    seconds = float(np.median([each for _, each, _ in results]))
    answer(seconds, head, version=version("pyelastica"), batch_seconds=together, shape_error=apart)


if __name__ == "__main__":
    main()
