# SPDX-License-Identifier: Apache-2.0
"""The page beside the figures: what the paper shows, what we show, and where we differ.

Every number is computed from the runs in the figures.
"""

import textwrap

import numpy as np

from eel_studies.figures import corrections, kern_comparison
from eel_studies.figures.paper_drawings import INSTANT, PLACE

PRINTED_MASS = 1.94  # kg, section 7.2.1
FINE = 4  # index of the number of points from which on the order along the body is fitted
TRANSITION = 8e4  # local Reynolds number at which the printed friction jumps

CAVEAT = (
    "This comparison is uncertain. The Reynolds number is about 4e3, more than a hundred times below that for which "
    "the drag of this model was fitted. These published numbers support no claim better than 10 %. The ratio of the "
    "two speeds is the most reliable, since errors of the drag act on both gaits. Our faster gait lies {above:.0%} "
    "above the greatest of their speeds. Both Strouhal numbers lie above those of live eels. At such Reynolds numbers "
    "computed flows also require more than 0.45 (Borazjani and Sotiropoulos, J. Exp. Biol. 212 (2009), 576-592). Their "
    "efficiency is defined differently from both of ours, so only its sign can be compared. The number of waves on the "
    "body of the efficient gait is less certain than the other numbers."
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
        "# The paper's figures, computed again",
        "The command `eel figures` makes this page and its figures. Each number comes from the runs that are drawn. "
        "*The paper* is Boyer, Porez and Leroyer (2010), "
        "[doi:10.1007/s00332-009-9050-5](https://doi.org/10.1007/s00332-009-9050-5). It prints curves without tables. "
        "So agreement is claimed here only where its text has a number or a statement to compare with. *Corrected* is "
        "the library's own reading of its formulae, *as printed* takes perimeter and added mass as printed. The "
        "[table](#what-the-corrections-do) shows the effect of each.",
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
        "The paper draws the robot's outline. We draw the same formulae (section 7.2.1), with sections at their true "
        f"size. Mass: {run.body_mass:.4f} kg; printed: {PRINTED_MASS} kg. In the printed text the names of the "
        "half-axes of the nose are exchanged. Only their product is used."
    )


def _configurations(run, printed, control) -> str:
    x, y, z = run.position[-1]
    return (
        "The paper shows the body twice a second. It sinks from one depth to another and deviates sideways. So does "
        f"ours: after {run.time[-1]:g} s the head is at ({x:+.2f}, {y:+.2f}, {z:+.2f}) m. The text explains the "
        "sideways deviation by the roll, which breaks the symmetry of the yaw. A run confirms this: the same wave "
        f"without the bends in pitch does not roll, and ends at y = {control.position[-1, 1]:+.2f} m instead of "
        f"{y:+.2f} m. With the added mass as printed there is no dive (z = {printed.position[-1, 2]:+.2f} m). So the "
        "published run was probably not computed with (37) as printed."
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
        "The paper plots the internal axial force and the two control torques along the body. We plot the same. The "
        f"greatest values are N1 = {force_1:+.3f} N (X = {at_force:.2f} m; negative is compression), "
        f"C2 = {pitch:+.3f} N m (X = {at_pitch:.2f} m) and C3 = {yaw:+.3f} N m (X = {at_yaw:.2f} m). At the free ends "
        "both torques vanish, and N1(0) is the load on the nose. The kink of N1 near "
        f"X = {jump:.2f} m is due to the printed friction, which jumps at Re = 8e4. The text has no number to compare "
        f"with. The largest C2 as printed is {_share(printed.torque[k, :, 1], torque[:, 1])} of the corrected one."
    )


def _in_time(run, printed) -> str:
    station = int(np.argmin(np.abs(run.x - PLACE)))
    force, torque = run.force[:, station, 0], run.torque[:, station]
    late = run.time >= 0.5 * run.time[-1]
    return (
        "The paper plots the same three against time at half the length. So do we. The torque is greatest at the "
        f"start: C3 lies between {torque[:, 2].min():.2f} and {torque[:, 2].max():.2f} N m, and within "
        f"{_greatest(torque[late, 2]):.2f} N m in the later half. N1 oscillates twice per period, C3 once. N1 lies "
        f"between {force.min():.2f} and {force.max():.2f} N. C2 is zero until the body bends in pitch. It continues "
        "after the body is straight in pitch again, because head and body still roll. The text has no number to "
        f"compare with. The largest C3 as printed is {_share(printed.torque[:, station, 2], torque[:, 2])} of the "
        "corrected one."
    )


def _head(run, printed) -> str:
    return (
        "The paper plots the axial velocity and the roll rate of the head. We plot the same. From rest the head "
        f"reaches V1(0) = {run.twist[-1, 3]:.2f} m/s ({printed.twist[-1, 3]:.2f} m/s as printed). The roll rate is "
        f"zero until the body bends in pitch, and then reaches {_greatest(run.twist[:, 0]):.1f} rad/s. It continues "
        "between the two bends and after them, since nothing restores the roll. This is what the text says: roll is "
        "not part of the gait, and has to be controlled. As printed it reaches "
        f"{_greatest(printed.twist[:, 0]):.1f} rad/s and dies out between the bends."
    )


def _torque(run) -> str:
    torque, place, time = run.greatest_torque()
    return (
        "Not in the paper: each torque over time and X, as a surface and as a map. The stripes of C3 are inclined, "
        f"since the wave travels to the tail. The greatest torque is {torque:.3f} N m, at X = {place:.2f} m and "
        f"t = {time:.2f} s, during the start."
    )


def _path(run) -> str:
    return (
        f"Not in the paper: the path of the head, {run.path_length:.2f} m long, with a dot each second. The centre of "
        "mass is averaged over a period. Its mean speed in the later half is "
        f"U = {run.analysis().mean_speed:.3f} m/s."
    )


def _ledger(run) -> str:
    energy = run.energy
    work = energy.actuator_work[-1]
    return (
        f"Not in the paper. The actuators do {work:.2f} J of work in {run.time[-1]:g} s. Drag along the body takes "
        f"{-energy.drag_work[-1] / work:.0%}, the wake {-energy.wake_work[-1] / work:.0%}, the nose "
        f"{-energy.nose_work[-1] / work:.0%}. The rest is kinetic energy. The residual is the change of kinetic energy "
        "minus all these works. It checks the torques against the motion, and is at most "
        f"{np.max(np.abs(energy.residual)) / work:.0e} of the work."
    )


def _orders(errors) -> str:
    space, time = errors["in_space"], errors["in_time"]
    fine = slice(FINE, None)
    smooth, kinked = (tuple(-space[drag].order(name, fine) for name in ("motion", "torque")) for drag in (False, True))
    return (
        "Not in the paper. Without drag of cross flow and roll all functions are smooth. Beyond "
        f"{space[False].against[FINE]:g} points the error of the motion falls with their number to the power "
        f"-{smooth[0]:.1f}, that of the torque to the power -{smooth[1]:.1f} (the Magnus series of the rotation has "
        f"order 6). The errors fall with the step in time to the powers {time[False].order('motion'):.1f} and "
        f"{time[False].order('torque'):.1f}, for a method of order 4. Cross-flow drag is proportional to V|V|, whose "
        "second derivative jumps where V changes sign. Such a place lies inside a panel and moves with time. It would "
        "limit the order of any rule for smooth functions to 2 to 3. So it is located in each evaluation, and the drag "
        "is integrated up to it. With it the errors fall with the number of points to the powers "
        f"-{kinked[0]:.1f} and -{kinked[1]:.1f}, to {space[True].motion[-1]:.0e} at {space[True].against[-1]:g} "
        f"points, and with the step in time to the powers {time[True].order('motion'):.1f} and "
        f"{time[True].order('torque'):.1f}."
    )


def _corrections(run, readings) -> str:
    own, perimeter, blended, laminar, mass, _ = readings
    left = mass.run.greatest_torque()[0] / own.run.greatest_torque()[0]
    return (
        f"All runs are {run.time[-1]:g} s of the falling gait. *Apart* is the distance of the head at the end from "
        "that of the library's own reading. The mean speed is over the later half. The added mass has the greatest "
        f"effect: with exchanged half-axes {left:.0%} of the peak torque is left, and there is no dive. Half the "
        "perimeter is half the friction, and changes the speed by "
        f"{perimeter.mean_speed / own.mean_speed - 1.0:+.0%}. Laminar "
        f"friction changes it by {laminar.mean_speed / own.mean_speed - 1.0:+.0%}. Blending the friction over its "
        f"transition moves the head by {1e3 * blended.apart:.1f} mm: the jump hardly changes the motion. Friction does "
        "not affect the peak torque, since the swimmer has no speed yet when it occurs."
    )


def _greatest(values) -> float:
    return float(np.max(np.abs(values)))


def _share(part, whole) -> str:
    return f"{_greatest(part) / _greatest(whole):.0%}"
