# SPDX-License-Identifier: Apache-2.0
"""What a run was, from the messages that came over the network: numbers first, then the text that says them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from eel_dynamics.runs.exchange.recorded_run import fields_of_messages
from eel_dynamics.simulation.energy import EnergyLedger

from eel_dynamics import Run

RESIDUAL_LIMIT = 1e-3  # of the actuators' work
CLOSURE_LIMIT = 1e-10  # of the greatest internal force and torque
NEEDED = ("head_pose", "internal_wrench", "energy", "diagnostics")


@dataclass(frozen=True)
class RunSummary:
    """The run that the messages tell of, and what the run itself does not hold."""

    run: Run
    pose: Any  # geometry_msgs/Pose of the head at the end, world frame
    told: dict[str, list[float]]  # the numbers of the diagnostics, by their keys, in order

    @property
    def energy(self) -> EnergyLedger:
        """The run's ledger."""
        assert self.run.energy is not None
        return self.run.energy

    @cached_property
    def published(self) -> int:
        """Samples, as the dynamics node counts them."""
        return int(self.told["samples_published"][-1])

    @cached_property
    def residual(self) -> float:
        """Greatest imbalance of the ledger [J]."""
        return float(np.abs(self.energy.residual).max())

    @cached_property
    def work(self) -> float:
        """Of the actuators [J]."""
        return self.told["actuator_work"][-1]

    def closure(self, name: str) -> float:
        """Residual of the `name`, torque or force, at the nose by its greatest value along the body."""
        values = getattr(self.run, name)
        return max(self.told[f"closure_{name}"]) / float(np.linalg.norm(values, axis=2).max())

    @property
    def failures(self) -> list[str]:
        """What breaks the limits; empty for a sound run."""
        found = []
        if not self.residual <= RESIDUAL_LIMIT * abs(self.work):
            limit = f"{RESIDUAL_LIMIT:g} of the work {self.work:.4g} J"
            found.append(f"energy residual {self.residual:.3g} J exceeds {limit}")
        for name in ("force", "torque"):
            if not self.closure(name) <= CLOSURE_LIMIT:
                limit = f"{CLOSURE_LIMIT:g} of its greatest value"
                found.append(f"closure of the {name} {self.closure(name):.3g} exceeds {limit}")
        return found


def summarise(messages: list[tuple[str, Any]]) -> RunSummary:
    """Read a run's `messages` (topic and message); `ValueError` where a topic is missing, or says nothing."""
    for topic in NEEDED:
        if not any(name == topic for name, _ in messages):
            raise ValueError(f"no message came on {topic}")
    told: dict[str, list[float]] = {}
    for _, message in (each for each in messages if each[0] == "diagnostics"):
        for pair in (pair for status in message.status for pair in status.values):
            if pair.key in ("samples_published", "actuator_work", "closure_force", "closure_torque"):
                told.setdefault(pair.key, []).append(float(pair.value))
    run = Run(**fields_of_messages(messages, None, None))
    if not np.any(run.torque):
        raise ValueError("every internal torque that came is zero")
    pose = [message.pose for topic, message in messages if topic == "head_pose"][-1]
    return RunSummary(run, pose, told)


def describe(summary: RunSummary) -> str:
    """The summary for a terminal, one fact a line."""
    run, place, turn = summary.run, summary.pose.position, summary.pose.orientation
    (torque, x, time), energy = run.greatest_torque(), summary.energy
    duration, drag = run.time[-1] - run.time[0], energy.drag_work[-1] + energy.nose_work[-1]
    kinetic = energy.kinetic_body[-1] + energy.kinetic_fluid[-1]
    facts = {
        "law": run.law.name,
        "final pose": f"x {place.x:+.4f}  y {place.y:+.4f}  z {place.z:+.4f} m,  quaternion x y z w "
        f"{turn.x:+.4f} {turn.y:+.4f} {turn.z:+.4f} {turn.w:+.4f}",
        "path of the head": f"{run.path_length:.4f} m in {duration:g} s",
        "greatest torque": f"{torque:.4f} N m at X = {x:.3f} m, t = {time:.2f} s",
        "energy": f"actuators {summary.work:+.4f} J, wake {energy.wake_work[-1]:+.4f} J, drag and nose {drag:+.4f} J, "
        f"kinetic at the end {kinetic:.4f} J",
        "energy residual": f"{summary.residual:.2e} J, {summary.residual / abs(summary.work):.1e} of the actuators' "
        f"work (limit {RESIDUAL_LIMIT:g})",
        "closure residual": f"force {summary.closure('force'):.1e}, torque {summary.closure('torque'):.1e} of the "
        f"greatest (limit {CLOSURE_LIMIT:g})",
    }
    return "\n".join(f"  {name:<18} {text}" for name, text in facts.items())
