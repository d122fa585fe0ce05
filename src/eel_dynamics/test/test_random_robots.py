# SPDX-License-Identifier: Apache-2.0
"""Random robots run, or are refused with the part that is to blame; what they deliver is within their target."""

import numpy as np
import pytest
from random_robots import drawn

from eel_dynamics import Accuracy, SimulationStopped, simulate

FAST, ALL = 60, 5000
EXACT = Accuracy(name="exact", resolution=120.0, tolerance=1e-7)  # at 36 the torque of some is off by a hundredth


def swum(seed: int, accuracy, estimate: bool = True):
    draw = drawn(seed)
    return simulate(
        draw.law, 0.5, robot=draw.robot, scene=draw.scene, accuracy=accuracy, stations=11, estimate=estimate
    )


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seeds", [range(FAST), pytest.param(range(FAST, ALL), marks=pytest.mark.soak)])
def test_random_robots_run_or_are_refused_with_the_part_to_blame(seeds):
    refused = 0
    for seed in seeds:
        try:
            run = swum(seed, 1e-2)
        except (SimulationStopped, ValueError) as error:
            refused += 1
            assert any(part.name in str(error) for part in drawn(seed).robot.parts), (seed, error)
            continue
        assert np.isfinite(run.torque).all() and np.isfinite(run.joint_angle).all(), seed
    assert refused <= 0.05 * len(seeds)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seeds", [(2, 7, 19, 21), pytest.param(range(100), marks=pytest.mark.soak)])
def test_error_of_random_robots_is_within_the_target_or_told(seeds):
    for seed in seeds:
        run, exact = swum(seed, 1e-3), swum(seed, EXACT, False)
        position = np.linalg.norm(run.position - exact.position, axis=1).max() / max(exact.path_length, 1.0)
        apart = np.linalg.norm(run.torque - exact.torque, axis=2).max() / np.linalg.norm(exact.torque, axis=2).max()
        assert max(position, apart) < 1e-3 or run.error_estimate.worst > 1e-3, (seed, position, apart)
