# SPDX-License-Identifier: Apache-2.0
"""`python evidence/robot_swims.py`: blunt and jointed robots beside what was measured on them.

python evidence/robot_swims.py --out docs/data/robots.csv

Mamba swims by its published gaits and AmphiBot III by the log of its joints, on bodies of links; the tendon fish by its
hinges, on its published sections and masses with appendages. Nothing is fitted to a speed but c_s = 0.65, to Mamba's
undulation, in another code; the eel-like gait is then predicted. That the added mass falls with s^2 was chosen with
both gaits of Mamba in view. AmphiBot's ends have textbook numbers, which its own coasting confirms. The areas of the
tendon fish's appendages are textbook coefficients times published sizes (docs/data/README.md); its band goes with the
lowest and the highest of these coefficients.
"""

import argparse
import sys
from typing import Any

import numpy as np
from eel_common.command.command import command
from eel_dynamics.commands.options import add_options
from eel_gaits.sources.joint_log import law_of_links, read_joint_log
from eel_studies.outputs import Table, checked_outs, write_files
from studied.band import replay
from studied.leave_out import computed
from studied.seen import Seen
from studied.tendon_fish import DATA, FILMS, beat, tendon_fish

from eel_dynamics import Body, Scene

PLANAR = Scene(planar=True, friction="blended")
FITTED, ALONE = 0.65, 0.87  # c_s: fitted to Mamba's undulation; each link a blunt cylinder alone
MAMBA = {"undulation": 0.1288, "eel_like": 0.0894}  # m/s, measured
CLOCK = 1.078  # AmphiBot's true time by that of its log: its lights have 0.738 s a beat, the log 0.687
LOWEST, HIGHEST = 127.0 / 172.0, 261.0 / 172.0  # of its drag areas: lowest and highest textbook coefficients
NEUTRAL = {"lateral_drag": 1.98, "vertical_drag": 1.0, "round_added_mass": 1.0, "joint_drag": 0.0}
SMOOTH_ENDS = {"nose_drag": 0.036, "base_drag": 0.0}


@command("robot_swims.py", "Blunt and jointed robots beside what was measured on them.",
         add_options=lambda parser: add_options(parser, "--out"))  # fmt: skip
def main(options: argparse.Namespace) -> None:
    outs = checked_outs("robot_swims.py", options)
    table = Table(
        ("swimmer", "model", "speed [m/s]", "measured", "by measured", "greatest torque [N m]", "power [W]"),
        [*mamba(), *amphibot(), *tendon_swims()],
    )
    print(table.text())
    write_files(outs, table.write_csv, lambda figure: None, (6.8, 4.0))


def mamba() -> list[tuple[str, ...]]:
    """Its two gaits, term by term."""
    rows = []
    for name, measured in MAMBA.items():
        log = read_joint_log(DATA / f"mamba_{name}.csv", columns="", unit="", tail_first=False)
        body = Body.of_links(1.62, 9, 0.05, 0.055, joints=FITTED, mass=7.2)
        role = "fitted to this gait" if name == "undulation" else "predicted"
        models = {
            "without the new terms": NEUTRAL | SMOOTH_ENDS,
            "blunt ends": NEUTRAL,
            "and cross flow and added mass by shape: c_s 0": {"joint_drag": 0.0},
            f"c_s {ALONE}: each link alone": {"joint_drag": ALONE},
            f"c_s {FITTED}: {role}": {},
        }
        joints = np.arange(1, 9) * 0.18
        for model, numbers in models.items():
            swim = swum(log, joints, body.changed(**numbers))
            rows.append(row(f"Mamba, {name.replace('_', '-')}", model, measured, *swim))
    return rows


def amphibot() -> list[tuple[str, ...]]:
    """Its log, by the camera's clock."""
    log = read_joint_log(DATA / "amphibot_joints.csv", columns="", unit="", tail_first=False)
    log = log._replace(time=CLOCK * log.time)
    measured = Seen.of_file(DATA / "amphibot_leds.csv").speed
    body = Body.of_links(0.658, 7, 0.0165, 0.0275, joints="flush")
    joints = np.arange(1, 7) * 0.094
    models = {"without the new terms": NEUTRAL | SMOOTH_ENDS, "blunt ends": NEUTRAL, "c_s 0, as its coasting says": {}}
    return [
        row("AmphiBot III", model, measured, *swum(log, joints, body.changed(**numbers)))
        for model, numbers in models.items()
    ]


def swum(log: Any, joints: np.ndarray, body: Body) -> tuple[float, str, str]:
    """Mean speed [m/s], greatest torque of a joint [N m] and mean power [W] of a log's swim."""
    first, _, _ = replay(law_of_links(log, joints, body.length), body, joints, PLANAR, uncertain={}, accuracy=1e-2)
    later = first.run.time >= 0.5 * first.run.time[-1]
    assert first.run.energy is not None  # the scene has it on
    work = first.run.energy.actuator_work
    power = (work[-1] - work[later][0]) / (first.run.time[-1] - first.run.time[later][0])
    return first.speed, f"{np.max(np.abs(first.torque[later])):.3g}", f"{power:.3g}"


def tendon_swims() -> list[tuple[str, ...]]:
    """The films of the tendon fish, by its hinges."""
    beats = [beat(frequency) for frequency in FILMS]
    models = {
        "published sections alone": tendon_fish(hung=False, finite=False),
        "and appendages": tendon_fish(finite=False),
        "appendages and a tail of finite height": tendon_fish(),
        "the same, lowest coefficients": tendon_fish(appendage_factor=LOWEST),
        "the same, highest coefficients": tendon_fish(appendage_factor=HIGHEST),
    }
    rows = []
    for model, body in models.items():
        for frequency, filmed, ours in zip(FILMS, beats, computed(beats, body), strict=True):
            rows.append(row(f"tendon fish, {frequency} Hz", model, filmed.measured.speed, float(ours), "", ""))
    return rows


def row(swimmer: str, model: str, measured: float, speed: float, torque: str, power: str) -> tuple[str, ...]:
    """A row of the table."""
    return swimmer, model, f"{speed:.4g}", f"{measured:.4g}", f"{speed / measured:.2f}", torque, power


if __name__ == "__main__":
    sys.exit(main())
