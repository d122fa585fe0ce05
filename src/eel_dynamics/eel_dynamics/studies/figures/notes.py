# SPDX-License-Identifier: Apache-2.0
"""The page beside the figures: what the paper shows, what we show, and where we differ.

Every number is computed from the runs in the figures.
"""

import textwrap

import numpy as np

from eel_dynamics.studies.figures import corrections, kern_comparison
from eel_dynamics.studies.figures.paper_drawings import INSTANT, PLACE

PRINTED_MASS = 1.94  # kg, section 7.2.1
FINE = 4  # index of the number of points from which on the order along the body is fitted
TRANSITION = 8e4  # local Reynolds number at which the printed friction jumps

CAVEAT = (
    "Soft numbers, to be read as such: the Reynolds number is about 4e3, more than a hundred times below that for "
    "which the drag of this model was fitted, and nothing in these published numbers supports a claim better than 10 "
    "%. The ratio of the two speeds is the firmest of them, since errors of the drag act on both gaits; our faster "
    "gait lies {above:.0%} above the greatest of their speeds. Both Strouhal numbers lie above those of live eels; at "
    "such Reynolds numbers computed flows ask for more than 0.45 too (Borazjani and Sotiropoulos, J. Exp. Biol. 212 "
    "(2009), 576-592). Their efficiency is another ratio than either of ours, so that only its sign can be compared; "
    "and the number of waves on the body of the efficient gait is less certain than the rest."
)


def page(readings, control, comparison, errors) -> str:
    """The whole page in Markdown.

    readings: of `corrections.swim`. control: run of the same wave without the bends in pitch. comparison: of
    `kern_comparison.compare`. errors: of `orders`, by rule and drag.
    """
    runs = {row.label: row.run for row in readings}
    run, printed = runs[corrections.OWN], runs[corrections.PRINTED]
    title_along, title_in_time = f"Fig. 7, along the body at t = {INSTANT:g} s", f"Fig. 8, in time at X = {PLACE:g} m"
    above = comparison.fast.stride / kern_comparison.PUBLISHED_SPEEDS[1] - 1.0
    parts = [
        "# The paper's figures, made again",
        "Made by `figures`, this page included; each number is read off the runs that are drawn. *The paper* is Boyer, "
        "Porez and Leroyer (2010), [doi:10.1007/s00332-009-9050-5](https://doi.org/10.1007/s00332-009-9050-5). It "
        "prints curves without tables, so that agreement is claimed here only where its text can be held against a "
        "number. *Corrected* is the library's own reading of its formulae, *as printed* takes perimeter and added mass "
        "as they stand there; the [table](#what-the-corrections-do) tells what each does.",
        "## Figures 5 to 9 of the paper",
        *_figure("figure5_body", "Fig. 5, the body", _body(run)),
        *_figure("figure6_configurations", "Fig. 6, the falling gait", _configurations(run, printed, control)),
        *_figure("figure7_wrench_along_the_body", title_along, _along(run, printed)),
        *_figure("figure8_wrench_in_time", title_in_time, _in_time(run, printed)),
        *_figure("figure9_head_velocity", "Fig. 9, axial velocity and roll of the head", _head(run, printed)),
        "## Beyond the paper",
        *_figure("torque_surface", "The torque over time and body", _torque(run)),
        *_figure("head_path", "The head's path", _path(run)),
        *_figure("power_ledger", "Where the power goes", _ledger(run)),
        *_figure("convergence", "Errors against points and steps", _orders(errors)),
        "## What the corrections do",
        corrections.table_of(readings),
        _corrections(run, readings),
        "## A second body and other people's numbers",
        "The eel of Kern and Koumoutsakos, J. Exp. Biol. 209 (2006), 4841-4857, "
        "[doi:10.1242/jeb.02526](https://doi.org/10.1242/jeb.02526), whose flow was computed from the Navier-Stokes "
        f"equations; L = 1 m, T = 1 s, viscosity {kern_comparison.VISCOSITY:g} L^2/T, from rest, over the later half.",
        kern_comparison.table_of(comparison),
        CAVEAT.format(above=above),
    ]
    return "\n\n".join(_wrapped(part) for part in parts) + "\n"


def _wrapped(part: str) -> str:
    if part.startswith(("#", "|", "!")):
        return part
    return textwrap.fill(part, 120, break_long_words=False, break_on_hyphens=False)


def _figure(name: str, title: str, text: str) -> tuple[str, str, str]:
    return f"### {title}", f"![{title}]({name}.svg)", text


def _body(run) -> str:
    return (
        "The paper draws the robot's outline; we draw the same formulae (section 7.2.1), with sections at their true "
        f"size. Mass: {run.body_mass:.4f} kg; printed: {PRINTED_MASS} kg. In the printed text the half-axes of the "
        "nose carry each other's names; only their product is used."
    )


def _configurations(run, printed, control) -> str:
    x, y, z = run.position[-1]
    return (
        "The paper shows the body, twice a second, sink from one depth to another and drift off sideways; so does "
        f"ours: after {run.time[-1]:g} s the head is at ({x:+.2f}, {y:+.2f}, {z:+.2f}) m. The text blames the roll for "
        "the sideways deviation, since it breaks the symmetry of the yaw. That can be held against a run: the same "
        f"wave without the bends in pitch, which does not roll, ends at y = {control.position[-1, 1]:+.2f} m instead "
        f"of {y:+.2f} m. With the added mass as printed there is no dive (z = {printed.position[-1, 2]:+.2f} m), so "
        "the published run was hardly made with (37) as it stands in print."
    )


def _along(run, printed) -> str:
    k = int(np.argmin(np.abs(run.time - INSTANT)))
    force, torque = run.force[k], run.torque[k]
    jump = TRANSITION * run.scene.viscosity / abs(run.twist[k, 3])
    ((force_1, at_force), (pitch, at_pitch), (yaw, at_yaw)) = (
        (values[np.argmax(np.abs(values))], run.x[np.argmax(np.abs(values))])
        for values in (force[:, 0], torque[:, 1], torque[:, 2])
    )
    return (
        "The paper plots the internal axial force and the two control torques along the body; we plot the same. At the "
        f"most, N1 is {force_1:+.3f} N (X = {at_force:.2f} m; negative is compression), C2 {pitch:+.3f} N m "
        f"(X = {at_pitch:.2f} m) and C3 {yaw:+.3f} N m (X = {at_yaw:.2f} m). As free ends demand, both torques vanish "
        "there, and N1(0) is the load on the nose. The kink of N1 near "
        f"X = {jump:.2f} m is the printed friction, which jumps at Re = 8e4. The text has no number to hold this "
        f"against; the largest C2 as printed is {_share(printed.torque[k, :, 1], torque[:, 1])} of the corrected one."
    )


def _in_time(run, printed) -> str:
    station = int(np.argmin(np.abs(run.x - PLACE)))
    force, torque = run.force[:, station, 0], run.torque[:, station]
    late = run.time >= 0.5 * run.time[-1]
    return (
        "The paper plots the same three against time at half the length; we plot the same. The start is the hardest "
        f"moment: C3 goes from {torque[:, 2].min():.2f} to {torque[:, 2].max():.2f} N m, and stays within "
        f"{_greatest(torque[late, 2]):.2f} N m in the later half; N1 beats twice a period, C3 once, and N1 lies "
        f"between {force.min():.2f} and {force.max():.2f} N. C2 is zero until the body bends in pitch, and goes on "
        "when it is straight in pitch again, for head and body keep rolling. The text has no number to hold this "
        f"against; the largest C3 as printed is {_share(printed.torque[:, station, 2], torque[:, 2])} of the corrected "
        "one."
    )


def _head(run, printed) -> str:
    return (
        "The paper plots the head's axial velocity and its roll; we plot the same. From rest the head comes to "
        f"V1(0) = {run.twist[-1, 3]:.2f} m/s ({printed.twist[-1, 3]:.2f} m/s as printed). Roll is zero until the body "
        f"bends in pitch, and then as fast as {_greatest(run.twist[:, 0]):.1f} rad/s; it beats on between the two "
        "bends and after, with nothing to hold it. That is what the text says: roll has no part in the gait, and needs "
        f"to be controlled. As printed it reaches {_greatest(printed.twist[:, 0]):.1f} rad/s and dies out between the "
        "bends."
    )


def _torque(run) -> str:
    torque, place, time = run.greatest_torque()
    return (
        "Not in the paper: each torque over time and body, as a surface and as a map. The stripes of C3 lean, since "
        f"the wave runs to the tail. The greatest torque is {torque:.3f} N m, at X = {place:.2f} m and t = {time:.2f} "
        "s, while the swimmer starts."
    )


def _path(run) -> str:
    return (
        f"Not in the paper: the way of the head, {run.path_length:.2f} m long, with a dot each second. The centre of "
        f"mass, averaged over a period, goes smoothly; U = {run.analysis().mean_speed:.3f} m/s in the later half."
    )


def _ledger(run) -> str:
    energy = run.energy
    work = energy.actuator_work[-1]
    return (
        f"Not in the paper. The actuators do {work:.2f} J of work in {run.time[-1]:g} s: drag along the body takes "
        f"{-energy.drag_work[-1] / work:.0%}, the wake {-energy.wake_work[-1] / work:.0%}, the nose "
        f"{-energy.nose_work[-1] / work:.0%}, and the rest is kinetic energy. The change of kinetic energy less all "
        "these works is the residual, which checks torques against motion: "
        f"{np.max(np.abs(energy.residual)) / work:.0e} of the work at most."
    )


def _orders(errors) -> str:
    space, time = errors["in_space"], errors["in_time"]
    fine = slice(FINE, None)
    smooth, kinked = (tuple(-space[drag].order(name, fine) for name in ("motion", "torque")) for drag in (False, True))
    return (
        "Not in the paper. Without drag of cross flow and roll everything is smooth: beyond "
        f"{space[False].against[FINE]:g} points the error of the motion falls with their number to the power "
        f"-{smooth[0]:.1f}, that of the torque -{smooth[1]:.1f} (the rotation's Magnus series has order 6); and in "
        f"time with the step to the power {time[False].order('motion'):.1f} and {time[False].order('torque'):.1f}, for "
        "a method of order 4. Cross-flow drag goes like V|V|, whose second derivative jumps where V changes sign. Such "
        "a place lies inside a panel and moves with time, and would cap the order of any rule for smooth functions at "
        "2 to 3; so it is located in each evaluation, and the drag is integrated up to it. What is left falls along "
        f"the body with the power -{kinked[0]:.1f} and -{kinked[1]:.1f}, to {space[True].motion[-1]:.0e} at "
        f"{space[True].against[-1]:g} points, and in time with {time[True].order('motion'):.1f} and "
        f"{time[True].order('torque'):.1f}."
    )


def _corrections(run, readings) -> str:
    own, perimeter, blended, laminar, mass, _ = readings
    left = mass.run.greatest_torque()[0] / own.run.greatest_torque()[0]
    return (
        f"All over {run.time[-1]:g} s of the falling gait; *apart*: the head at the end from the library's own; mean "
        "speed over the later half. The added mass is what matters: exchanged half-axes leave "
        f"{left:.0%} of the peak torque, and no dive. Half the perimeter is half the friction: "
        f"{perimeter.mean_speed / own.mean_speed - 1.0:+.0%} in speed; laminar friction "
        f"{laminar.mean_speed / own.mean_speed - 1.0:+.0%}. Blending the friction over its transition moves the head "
        f"by {1e3 * blended.apart:.1f} mm: its jump costs order, and hardly changes the motion. The peak torque does "
        "not know of friction, since the swimmer has no way on when it starts."
    )


def _greatest(values) -> float:
    return float(np.max(np.abs(values)))


def _share(part, whole) -> str:
    return f"{_greatest(part) / _greatest(whole):.0%}"
