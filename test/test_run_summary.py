# SPDX-License-Identifier: Apache-2.0
"""The demo's summary is that of the run whose messages came; and what makes it fail."""

from types import SimpleNamespace

import numpy as np
import pytest
from eel_dynamics.runs.exchange.messages_of_run import messages_of_run
from eel_gaits.ros.messages import law_to_message
from run_summary import describe, summarise

from eel_dynamics import simulate
from eel_gaits import falling


@pytest.fixture(scope="module")
def run():
    return simulate(falling(), 3.0, sample_period=0.02, estimate=False)


def messages(run, residual=1e-4, closure=1e-14, left_out=""):
    """What the nodes publish of a run, with a ledger and a closure that are off by so much of work and torque."""
    for topic, message in messages_of_run(run):
        if topic == "energy":
            message.residual = residual * run.energy.actuator_work[-1]
        if topic not in ("diagnostics", "curvature_law", left_out):
            yield topic, message
    yield "curvature_law", law_to_message(run.law)
    values = {
        "samples_published": len(run.time),
        "actuator_work": run.energy.actuator_work[-1],
        "closure_force": closure * np.linalg.norm(run.force, axis=2).max(),
        "closure_torque": 0.1 * closure * np.linalg.norm(run.torque, axis=2).max(),
    }
    pairs = [SimpleNamespace(key=key, value=str(value)) for key, value in values.items()]
    if left_out != "diagnostics":
        yield "diagnostics", SimpleNamespace(status=[SimpleNamespace(values=pairs)])


def test_figures_are_those_of_the_run(run):
    summary = summarise(list(messages(run)))
    assert (summary.run.law.name, summary.published, len(summary.run.time)) == ("falling", 151, 151)
    assert summary.run.path_length == pytest.approx(run.path_length)
    assert summary.run.greatest_torque() == pytest.approx(run.greatest_torque(), rel=3e-3)  # splines
    assert summary.run.energy.wake_work[-1] == pytest.approx(run.energy.wake_work[-1], rel=1e-4)
    assert summary.residual == pytest.approx(1e-4 * abs(summary.work))
    assert (summary.closure("force"), summary.closure("torque")) == pytest.approx((1e-14, 1e-15))
    assert summary.failures == []
    torque, x, _ = summary.run.greatest_torque()
    assert f"{torque:.4f} N m at X = {x:.3f} m" in describe(summary)


@pytest.mark.parametrize(
    "fault", [{"residual": 1.1e-3}, {"closure": 1.1e-10}, {"residual": np.nan}, {"closure": np.nan}]
)
def test_what_breaks_a_limit_is_a_failure(run, fault):
    failures = summarise(list(messages(run, **fault))).failures
    assert next(iter(fault)) in failures[0]


@pytest.mark.parametrize("topic", ["head_pose", "internal_wrench", "energy", "diagnostics"])
def test_a_missing_topic_is_an_error(run, topic):
    with pytest.raises(ValueError, match=topic):
        summarise(list(messages(run, left_out=topic)))
