# SPDX-License-Identifier: Apache-2.0
"""What a run was, from the messages that came over the network: numbers first, then the text that says them."""

from dataclasses import dataclass

import numpy as np
from eel_dynamics.analysis.peaks import peak_along

RESIDUAL_LIMIT = 1e-3  # of the actuators' work
CLOSURE_LIMIT = 1e-10  # of the greatest internal force and torque


@dataclass(frozen=True, kw_only=True)
class RunSummary:
    """SI units; positions in the world frame (REP-103), powers and work into body and fluid."""

    law: str
    duration: float  # s, of simulation
    published: int  # [-] samples, as the dynamics node counts them
    received: int  # [-] poses that came
    position: np.ndarray  # m, (3,) head at the end
    orientation: np.ndarray  # [-], (4,) head at the end, x y z w
    path_length: float  # m, of the head
    torque: float  # N m, greatest internal torque, between samples too
    torque_x: float  # m, where along the body
    torque_time: float  # s, when
    work: float  # J, of the actuators
    wake: float  # J, shed into the wake
    drag: float  # J, taken by the resistive loads, nose included
    kinetic: float  # J, of body and fluid at the end
    residual: float  # J, greatest imbalance of the ledger
    closure_force: float  # [-] residual of the wrench at the nose over the greatest internal force
    closure_torque: float  # [-] likewise for the torque

    @property
    def failures(self) -> list[str]:
        """What breaks the limits; empty for a sound run."""
        found = []
        if not self.residual <= RESIDUAL_LIMIT * abs(self.work):
            found.append(
                f"energy residual {self.residual:.3g} J exceeds {RESIDUAL_LIMIT:g} of the work {self.work:.4g} J"
            )
        for name, value in (("force", self.closure_force), ("torque", self.closure_torque)):
            if not value <= CLOSURE_LIMIT:
                found.append(f"closure of the {name} {value:.3g} exceeds {CLOSURE_LIMIT:g} of its greatest value")
        return found


def seconds(message) -> float:
    """Simulation time [s] of a stamped message."""
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def diagnostic_values(arrays: list, key: str) -> list[str]:
    """All values that the diagnostics gave for `key`, in order."""
    return [pair.value for array in arrays for status in array.status for pair in status.values if pair.key == key]


def summarise(messages: dict[str, list]) -> RunSummary:
    """Read a run's `messages` (topic: list, as `Reception` keeps them); ValueError where a topic is missing."""
    for topic in ("head_pose", "internal_wrench", "energy", "/diagnostics"):
        if not messages[topic]:
            raise ValueError(f"no message came on {topic}")
    poses, ledgers, wrenches = messages["head_pose"], messages["energy"], messages["internal_wrench"]
    head = np.array([[p.pose.position.x, p.pose.position.y, p.pose.position.z] for p in poses])
    turn = poses[-1].pose.orientation
    path = float(np.linalg.norm(np.diff(head, axis=0), axis=1).sum())
    duration = seconds(poses[-1]) - seconds(poses[0])

    torques = np.stack([_field(wrenches, f"torque_{axis}") for axis in (1, 2, 3)], axis=2)
    force = np.sqrt(sum(_field(wrenches, f"force_{axis}") ** 2 for axis in (1, 2, 3)))
    if not torques.any():
        raise ValueError("every internal torque that came is zero")
    torque, where, when = peak_along(np.array([seconds(wrench) for wrench in wrenches]), wrenches[0].x, torques)

    time = np.array([seconds(ledger) for ledger in ledgers])
    energy = {
        name: np.array([getattr(ledger, name) for ledger in ledgers])
        for name in ("wake_power", "nose_power", "drag_power", "residual")
    }
    last = ledgers[-1]
    return RunSummary(
        law=messages["curvature_law"][-1].name if messages["curvature_law"] else "",
        duration=duration,
        published=int(_numbers(messages["/diagnostics"], "samples_published")[-1]),
        received=len(poses),
        position=head[-1],
        orientation=np.array([turn.x, turn.y, turn.z, turn.w]),
        path_length=path,
        torque=torque,
        torque_x=where,
        torque_time=when,
        work=float(_numbers(messages["/diagnostics"], "actuator_work")[-1]),
        wake=float(np.trapezoid(energy["wake_power"], time)),
        drag=float(np.trapezoid(energy["drag_power"] + energy["nose_power"], time)),
        kinetic=last.kinetic_body + last.kinetic_fluid,
        residual=float(np.abs(energy["residual"]).max()),
        closure_force=_numbers(messages["/diagnostics"], "closure_force").max() / force.max(),
        closure_torque=_numbers(messages["/diagnostics"], "closure_torque").max() / torque,
    )


def describe(summary: RunSummary) -> str:
    """The summary for a terminal, one fact a line."""
    x, y, z = summary.position
    turn = " ".join(f"{number:+.4f}" for number in summary.orientation)
    facts = {
        "law": summary.law,
        "final pose": f"x {x:+.4f}  y {y:+.4f}  z {z:+.4f} m,  quaternion x y z w {turn}",
        "path of the head": f"{summary.path_length:.4f} m in {summary.duration:g} s",
        "greatest torque": f"{summary.torque:.4f} N m at X = {summary.torque_x:.3f} m, t = {summary.torque_time:.2f} s",
        "energy": f"actuators {summary.work:+.4f} J, wake {summary.wake:+.4f} J, "
        f"drag and nose {summary.drag:+.4f} J, "
        f"kinetic at the end {summary.kinetic:.4f} J",
        "energy residual": f"{summary.residual:.2e} J, {summary.residual / abs(summary.work):.1e} of the actuators' "
        f"work (limit {RESIDUAL_LIMIT:g})",
        "closure residual": f"force {summary.closure_force:.1e}, torque {summary.closure_torque:.1e} of the greatest "
        f"(limit {CLOSURE_LIMIT:g})",
    }
    return "\n".join(f"  {name:<18} {text}" for name, text in facts.items())


def _field(messages: list, name: str) -> np.ndarray:
    return np.array([getattr(message, name) for message in messages])


def _numbers(arrays: list, key: str) -> np.ndarray:
    values = [float(value) for value in diagnostic_values(arrays, key)]
    if not values:
        raise ValueError(f"the diagnostics have no {key}")
    return np.array(values)
