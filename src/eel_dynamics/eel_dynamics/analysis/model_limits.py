# SPDX-License-Identifier: Apache-2.0
"""Checks a run against the limits of the model. Beyond a limit the simulation continues, but is less reliable.

| limit | why |
|---|---|
| a section's edge at the centre of curvature, abs(K3) b + abs(K2) a >= 1 | sections would cut through each other |
| the body touches itself | the model knows no contact |
| slenderness l/(2 max(a, b)) < 5 | the water moves in planes across a slender body (section 4.1 of the paper) |
| U l/nu < 1000 | added mass and a thin boundary layer need inertia to dominate |
| the tail leads, V1(l) > 0, for a good part of the time | the wake then supplies energy (the last term of eq. 60) |
| the flow's gradient changes by more than a tenth of itself across a section | the model assumes it uniform there |
| the hull's coefficients, or a tail that is not slender | `hull_limits` |
| the energy ledger is open by more than its tolerance | not a limit of the model: steps or points are too few |

The tolerance of the ledger is ten times the target, within 1e-4 and 1e-2, of all energy that passed; or 1e-3 for
settings given one by one. A swim that ends before its first stroke may exceed it: its energy is small beside the
gait's, for which the steps are chosen. Only a motion of round-off is not checked.

b is the half-width along axis 2, a the half-height along axis 3. A point y E2 + z E3 of a section moves along the body
by t1 (1 + K2 z - K3 y) per length, which must stay positive out to the skin.
"""

import numpy as np
from eel_common.attitude import world_from_body

from eel_dynamics.analysis.analysis import STILL, Analysis
from eel_dynamics.analysis.hull_limits import hull_warnings
from eel_dynamics.model.axes import REP103
from eel_dynamics.simulation.energy import WORKS

LEAST_SLENDERNESS = 5.0
LEAST_REYNOLDS = 1e3
OPEN_BY_TARGET, LEAST_OPEN, MOST_OPEN = 10.0, 1e-4, 1e-2  # share of the energy: times the target, and bounds
OPEN_OF_SETTINGS = 1e-3  # the same for resolution and step chosen by hand
GRADIENT_CHANGES = 0.1  # change across a section, relative to the greatest gradient along the body
LOOKS, PLACES = 32, 13  # instants and stations for that check
TAIL_LEADS = 0.25  # share of the time
APART = 4.0  # half-axes along the body: sections further apart are not neighbours
COINCIDENT = 1e-9  # of the body's length: closer centres of sections coincide
TINY = float(np.finfo(float).tiny)
AT_ONCE = 64  # instants whose pairs of sections are checked together


class ModelLimits:
    """Checks of `body` in `scene` with stations x (M,) [m]; each returns a warning, or an empty text."""

    def __init__(self, body, scene, x):
        self.body, self.scene, self.x = body, scene, np.asarray(x, dtype=float)
        self._width, self._height = body.half_width(self.x), body.half_height(self.x)
        along = np.linspace(0.0, body.length, 1025)
        self._greatest = float(max(np.max(body.half_width(along)), np.max(body.half_height(along))))
        self._half_spacing = 0.5 * float(np.max(np.diff(self.x), initial=0.0))
        self._pairs = np.argwhere(self.x[None, :] - self.x[:, None] > APART * self._greatest).T

    def of_body(self) -> str:
        """A warning if the body is not slender."""
        slenderness = self.body.length / (2.0 * self._greatest)
        if self.scene.reactive and slenderness < LEAST_SLENDERNESS:
            return (
                f"slenderness l/(2 max(a, b)) is {slenderness:.3g}, below {LEAST_SLENDERNESS:g}: water would flow "
                "around the ends, not across"
            )
        return ""

    def of_bending(self, time, curvature) -> str:
        """A warning if sections intersect at one of the times (T,) [s], given the curvature (T, M, 3) [rad/m]."""
        reach = np.abs(curvature[..., 2]) * self._width + np.abs(curvature[..., 1]) * self._height
        if not reach.size or np.max(reach) < 1.0:
            return ""
        sample = np.argmax(np.any(reach >= 1.0, axis=1))
        station = np.argmax(reach[sample])
        return (
            f"curvature too strong for the body's width: |K3| b + |K2| a is {reach[sample, station]:.3g} >= 1 at "
            f"X = {self.x[station]:.3g} m, t = {time[sample]:.4g} s"
        )

    def of_contact(self, time, curvature, backbone, section_orientation) -> str:
        """A warning if the body overlaps itself at one of the times (T,) [s].

        curvature (T, M, 3) [rad/m], backbone (T, M, 3) [m] and section_orientation (T, M, 4) in the world. Two sections
        overlap if the distance of their centres is less than the sum of the ellipses' extents along it.
        """
        if not self._pairs.size:
            return ""
        # The ends of a line that turns by less than 2 pi/3 in all are farther apart than half of its length.
        bend = np.linalg.norm(curvature, axis=2)
        turned = 0.5 * (bend[:, 1:] + bend[:, :-1]) @ np.diff(self.x)
        suspects = np.flatnonzero(turned >= 2.0 * np.pi / 3.0)
        first, second = self._pairs
        for begin in range(0, len(suspects), AT_ONCE):
            samples = suspects[begin : begin + AT_ONCE]
            apart = backbone[samples][:, second] - backbone[samples][:, first]
            side, up = cross_axes(section_orientation[samples])
            ahead = np.cross(side, up)[:, first]
            between = np.sum(apart * ahead, axis=2)  # compensation for sections between two stations
            apart -= np.clip(between, -self._half_spacing, self._half_spacing)[..., None] * ahead
            distance = np.linalg.norm(apart, axis=2)
            towards = apart / np.maximum(distance, TINY)[..., None]
            reach = sum(
                np.hypot(
                    self._width[pair] * np.sum(side[:, pair] * towards, axis=2),
                    self._height[pair] * np.sum(up[:, pair] * towards, axis=2),
                )
                for pair in (first, second)
            )
            overlapping = (distance < reach) | (distance < COINCIDENT * self.body.length)
            if np.any(overlapping):
                sample = np.argmax(np.any(overlapping, axis=1))
                pair = np.argmax((reach - distance)[sample])
                return (
                    f"the body touches itself: sections at X = {self.x[first[pair]]:.3g} m and "
                    f"{self.x[second[pair]]:.3g} m overlap at t = {time[samples[sample]]:.4g} s"
                )
        return ""

    def of_speed(self, speed: float) -> str:
        """A warning if the Reynolds number of a mean speed [m/s] relative to the water is too low; 0: not checked."""
        if not speed or not self.scene.viscosity:
            return ""
        reynolds = speed * self.body.length / self.scene.viscosity
        if reynolds >= LEAST_REYNOLDS:
            return ""
        return f"Reynolds number U l/nu is {reynolds:.3g}, below {LEAST_REYNOLDS:g}: viscosity rules, not inertia"

    def of_tail(self, wake_power, span: str = "") -> str:
        """A warning if the tail leads for much of the time. wake_power (T,) [W] has the sign of V1(l).

        span: of the samples, for the text.
        """
        share = float(np.mean(np.asarray(wake_power) > 0.0)) if len(wake_power) else 0.0
        if share < TAIL_LEADS:
            return ""
        often = f"{share:.0%} of the time{span}"
        return f"the tail leads, V1(l) > 0, for {often}: the wake feeds energy in, as the theory has it"

    def of_flow(self, flow, time, backbone, section_orientation) -> str:
        """A warning if the gradient of the `flow` changes much across a section at one of the times (T,) [s].

        backbone (T, M, 3) [m] and section_orientation (T, M, 4) in the world. A part of instants and stations is
        checked.
        """
        stations = np.unique(np.linspace(0, len(self.x) - 1, PLACES).astype(int))
        samples = np.unique(np.linspace(0, len(time) - 1, LOOKS).astype(int))
        side, up = cross_axes(section_orientation[np.ix_(samples, stations)])
        arms = self._width[stations, None] * side, self._height[stations, None] * up
        middle = backbone[np.ix_(samples, stations)]
        places = np.stack([middle, *(middle + sign * arm for arm in arms for sign in (-1.0, 1.0))], axis=1)
        try:
            gradients = np.stack([flow.sample(*each).jacobian for each in zip(places, time[samples], strict=True)])
        except ValueError:  # outside a grid, or a function that a file cannot hold
            return ""
        pairs = ((1, 2), (3, 4), (0, 1), (0, 2), (0, 3), (0, 4))  # of the centre and the edges
        changes = [np.linalg.norm(gradients[:, a] - gradients[:, b], axis=(-2, -1)) for a, b in pairs]
        changes = np.max(changes, axis=0)
        greatest = np.linalg.norm(gradients, axis=(-2, -1)).max()
        if greatest == 0.0 or changes.max() <= GRADIENT_CHANGES * greatest:
            return ""
        sample, station = np.unravel_index(np.argmax(changes), changes.shape)
        return (
            f"the flow is too fine for the body: its gradient changes by {changes.max() / greatest:.2g} of its "
            f"greatest across the section at X = {self.x[stations[station]]:.3g} m, t = {time[samples[sample]]:.4g} s, "
            f"more than {GRADIENT_CHANGES:g}"
        )

    def of_ledger(self, energy, most: float, floor: float) -> str:
        """A warning if the residual of an `EnergyLedger` of (T,) arrays exceeds the share `most` of the energy.

        floor: energy [J] that counts as zero.
        The energy is the greatest sum of energies and works at the samples. It misses energy that comes and goes
        between two samples, as in a sudden ramp.
        """
        signed = energy.potential, *(getattr(energy, f"{part}_work") for part in WORKS)
        passed = np.max(energy.kinetic_body + energy.kinetic_fluid + sum(np.abs(each) for each in signed), initial=0.0)
        residual = np.max(np.abs(energy.residual), initial=0.0)
        if passed <= floor or residual <= most * passed:
            return ""
        return (
            f"the energy ledger is open by {residual / passed:.2g} of what passed, more than {most:.2g}: the works are "
            "no more exact, steps or points along the body are too few"
        )


def warnings_of(run) -> tuple[str, ...]:
    """The model's limits that a `Run` exceeded, one line each.

    Speed and tail are checked over the later half of the run, in whole periods if the gait is periodic.
    """
    limits = ModelLimits(run.body, run.scene, run.x)
    later, speed = _later_half(run)
    placed = run if run.flow is None else run.in_axes(REP103)
    floor = run.body_mass * (STILL * run.body.length / max(run.time[-1] - run.time[0], TINY)) ** 2
    found = [
        limits.of_body(),
        limits.of_bending(run.time, run.curvature),
        limits.of_contact(run.time, run.curvature, run.backbone, run.section_orientation),
        limits.of_speed(speed),
        "" if run.flow is None else limits.of_flow(run.flow, run.time, placed.backbone, placed.section_orientation),
        limits.of_tail(run.energy.wake_power[later]) if run.energy is not None and run.flow is None else "",
        limits.of_ledger(run.energy, ledger_tolerance(run.accuracy.target), floor) if run.energy is not None else "",
        *hull_warnings(run),
    ]
    return tuple(text for text in found if text)


def ledger_tolerance(target: float | None) -> float:
    """The share of the energy by which the ledger of a run with this `target` may be open; None: of given settings."""
    return OPEN_OF_SETTINGS if target is None else min(max(OPEN_BY_TARGET * target, LEAST_OPEN), MOST_OPEN)


def cross_axes(orientation) -> tuple[np.ndarray, np.ndarray]:
    """Directions left and up of sections, (..., 3) each, in the world, from their orientation (..., 4) x y z w."""
    axes = world_from_body(orientation)
    return axes[..., 1], axes[..., 2]


def _later_half(run) -> tuple[np.ndarray, float]:
    """Mask of the later half's samples, (T,), and the mean speed [m/s] there; 0 if it is round-off or undefined."""
    try:
        analysis = Analysis(run)
    except ValueError:  # no period, or too few samples
        later = run.time >= 0.5 * (run.time[0] + run.time[-1])
        time, centre = run.time[later], run.center_of_mass[later] - np.outer(run.time[later], run.scene.current)
        swims = bool(run.law.waves)
        if swims or len(time) < 2:
            return later, 0.0
        way = float(np.linalg.norm(centre[-1] - centre[0]))
        return later, way / (time[-1] - time[0]) if way > STILL * run.body.length else 0.0
    return analysis.window.inside, analysis.mean_speed if analysis.moves else 0.0
