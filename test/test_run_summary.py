# SPDX-License-Identifier: Apache-2.0
"""The demo's summary, from messages whose numbers are known; and what makes it fail."""

from types import SimpleNamespace

import numpy as np
import pytest
from run_summary import describe, summarise


def stamped(seconds, **fields):
    whole, part = divmod(round(seconds * 1e9), 1_000_000_000)
    return SimpleNamespace(header=SimpleNamespace(stamp=SimpleNamespace(sec=whole, nanosec=part)), **fields)


def messages(residual=1e-4, closure=1e-14):
    """Two seconds straight ahead at 0.5 m/s, one sample a second, with 2 J of work."""
    run = {"head_pose": [], "internal_wrench": [], "energy": [], "curvature_law": [SimpleNamespace(name="straight")]}
    for k in range(3):
        position = SimpleNamespace(x=0.5 * k, y=0.0, z=0.0)
        orientation = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
        run["head_pose"].append(stamped(k, pose=SimpleNamespace(position=position, orientation=orientation)))
        arrays = {f"{kind}_{axis}": np.zeros(3) for kind in ("torque", "force") for axis in (1, 2, 3)}
        arrays |= {"torque_3": np.array([0.0, -0.1 * k, 0.0]), "force_1": np.array([0.0, 2.0, 0.0])}
        run["internal_wrench"].append(stamped(k, x=np.array([0.0, 0.4, 1.0]), **arrays))
        powers = {"wake_power": -0.1, "nose_power": -0.2, "drag_power": -0.3}
        energies = {"kinetic_body": 0.25, "kinetic_fluid": 0.5, "residual": -residual * k / 2}
        run["energy"].append(stamped(k, **powers, **energies))
    values = {
        "samples_published": "3",
        "actuator_work": "2.0",
        "closure_force": str(closure),
        "closure_torque": "1e-15",
    }
    pairs = [SimpleNamespace(key=key, value=value) for key, value in values.items()]
    run["/diagnostics"] = [SimpleNamespace(status=[SimpleNamespace(values=pairs)])]
    return run


def test_numbers():
    summary = summarise(messages())
    assert (summary.law, summary.published, summary.received) == ("straight", 3, 3)
    assert summary.path_length == pytest.approx(1.0)
    peak = 0.2 * 0.25 / (0.4 * 0.6)  # of the parabola through the three stations, 0 at both ends
    assert (summary.torque, summary.torque_x, summary.torque_time) == pytest.approx((peak, 0.5, 2.0))
    assert (summary.work, summary.wake, summary.drag, summary.kinetic) == pytest.approx((2.0, -0.2, -1.0, 0.75))
    assert summary.residual == pytest.approx(1e-4)
    assert summary.closure_force == pytest.approx(5e-15)
    assert summary.failures == []
    assert "0.2083 N m at X = 0.500 m, t = 2.00 s" in describe(summary)


@pytest.mark.parametrize(
    "fault", [{"residual": 2.1e-3}, {"closure": 2.1e-10}, {"residual": np.nan}, {"closure": np.nan}]
)
def test_what_breaks_a_limit_is_a_failure(fault):
    (failure,) = summarise(messages(**fault)).failures
    assert next(iter(fault)) in failure


@pytest.mark.parametrize("topic", ["head_pose", "internal_wrench", "energy", "/diagnostics"])
def test_a_missing_topic_is_an_error(topic):
    with pytest.raises(ValueError, match=topic):
        summarise({**messages(), topic: []})
