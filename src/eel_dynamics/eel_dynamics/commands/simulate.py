# SPDX-License-Identifier: Apache-2.0
"""`eel simulate`: swim a gait, a scene of a file, a sequence or a measured motion; print its figures.

eel simulate falling
eel simulate scene.yaml --out run.nc
eel simulate falling --duration 20 --periods 4 --actuators 8
eel simulate --sequence patrol.yaml --duration 20
eel simulate --file midlines.csv
eel simulate --midlines lamprey.csv --units mm
eel simulate --joints log.csv --links 0.18x9 --section 0.055,0.05 --joint-drag 0.65 --mass 7.2
eel simulate straight --set wavelength=0.8 --scene friction=laminar --accuracy 1e-6 --out run.npz
"""

import argparse
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser, print_to_stderr
from eel_common.command.progress import Progress
from eel_common.files.output_file import replacing, written_as
from eel_common.quantity import described_fields
from eel_common.wording import bring_viz, one_line, shown
from eel_gaits.film.beat import Beat
from eel_gaits.gaits.registry import gait
from eel_gaits.gaits.sequence import sequence_from_file
from eel_gaits.laws.law import Law
from eel_gaits.sources.motion_file import read_motion
from eel_gaits.sources.sampled_law import SampledLaw

from eel_dynamics.accuracy.accuracy import STANDARD
from eel_dynamics.accuracy.step_bounds import MOST_EVALUATIONS
from eel_dynamics.analysis.joint_demand import MOST_JOINTS
from eel_dynamics.commands.filmed import EEL, add_film_options, beat_from, body_for, effect_of_fit
from eel_dynamics.commands.logged import LoggedRobot, add_joint_options, logged_robot
from eel_dynamics.commands.options import add_options, set_numbers, swim_from
from eel_dynamics.model.body.body import Body
from eel_dynamics.model.scene import Scene
from eel_dynamics.runs.run import Run
from eel_dynamics.runs.scene_file import SUFFIXES as SCENES
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED, until_settled
from eel_dynamics.runs.storage.run_contents import contents_of_run
from eel_dynamics.runs.storage.tables import columns_of, write_columns
from eel_dynamics.runs.swim import Swim
from eel_dynamics.simulation.stopping import SimulationStopped

NAME = "eel simulate"
DURATION, STATIONS = 10.0, 51  # defaults: s, points along the body
SUFFIXES = (".nc", ".npz", ".csv", ".rrd")


def _add_options(parser: Parser) -> None:
    add_options(parser, "gait", "--set", gait=(None, "falling; or the .yaml file of a scene"))
    parser.add_argument(
        "--sequence",
        metavar="FILE",
        help="a YAML file of gaits that follow one another, in place of a gait: docs/reference/manoeuvres.md",
    )
    parser.add_argument(
        "--file",
        metavar="FILE",
        help="a measured motion in place of a gait: a table or .npz with columns time and x, y (midlines), yaw_1, "
        "yaw_2 ... (joint angles), or arc_length, yaw (curvature); yaw > 0 bends the tail to the right, and x, y are "
        "seen from above: docs/howto/motions.md",
    )
    parser.add_argument(
        "--midlines",
        metavar="FILE",
        help="a filmed swimmer in place of a gait: tracked points as published, or of DeepLabCut or SLEAP; it swims by "
        "the mean beat: docs/howto/motions.md",
    )
    add_film_options(parser)
    parser.add_argument(
        "--joints",
        metavar="LOG",
        help="the angles that a robot logged in place of a gait: .csv, or a bag with sensor_msgs/JointState; with "
        "--links, and --section or --body: docs/howto/motions.md",
    )
    add_joint_options(parser)
    parser.add_argument("--unsmoothed", action="store_true", help="do not smooth what was measured")
    duration = None, f"{DURATION:g}; of a file: all of it; of midlines: {UNTIL_SETTLED}"
    add_options(
        parser, "--scale", "--duration", "--accuracy", "--bare", "--body", "--scene", "--flow", "--robot", "--fins",
        "--wrenches", "--sample-period",
        duration=duration, accuracy=(None, STANDARD),
        body=(None, f"boyer2010; with --midlines {EEL}, as long as the swimmer in the film"),
    )  # fmt: skip
    parser.add_argument("--stations", type=int, help=f"points along the body ({STATIONS})")
    parser.add_argument(
        "--most-evaluations",
        type=float,
        default=MOST_EVALUATIONS,
        metavar="N",
        help=f"of the head's dynamics per simulated second; a swim that takes more ends ({MOST_EVALUATIONS:g})",
    )
    parser.add_argument("--load", action="store_true", help="keep the water's load along the body too")
    parser.add_argument(
        "--periods", type=int, metavar="N", help="figures of the gait over the last N whole periods (later half)"
    )
    parser.add_argument(
        "--actuators", type=int, metavar="N", help="print the demand on a robot of N motors in pitch and N in yaw"
    )
    parser.add_argument(
        "-o",
        "--out",
        metavar="FILE",
        help=".nc: the whole run, for Run.load; .npz: its arrays; .csv: head, energies, one line "
        "per sample; .rrd: for Rerun's viewer, as the visualiser shows it (needs eel_viz)",
    )


@command(
    NAME,
    "Simulate a gait, a sequence of gaits or a measured motion without ROS, and print a summary.",
    epilog=f"fields of the scene, with default, meaning, unit, and bounds or choices:\n{described_fields(Scene)}",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> int:
    """Simulate, print the summary and write the run. Returns the exit status: 0, or 3 for a run that stopped."""
    out = _checked_out(options.out)
    beat = None if options.midlines is None else beat_from(options.midlines, options)
    robot = None if options.joints is None else logged_robot(options.joints, options)
    swim = _scene_of_file(options) if (options.gait or "").endswith(SCENES) else _swim_of(options, beat, robot)
    if options.actuators is not None:
        _check_actuators(options, swim.scene)
    start, progress = time.perf_counter(), Progress(NAME, "simulated s")
    end = None if until_settled(swim.duration) else float(swim.duration)
    try:
        run = swim.run(
            load=options.load or Path(options.out or "").suffix == ".rrd",
            estimate=not options.bare,
            most_evaluations=options.most_evaluations,
            progress=lambda reached, left: progress(float(f"{reached:.5g}"), end),
        )
    except SimulationStopped as stopped:
        print_to_stderr(NAME, stopped)
        if out is not None and len(stopped.run.time):
            _write(stopped.run, out)
        return 3
    seconds = time.perf_counter() - start
    if beat is not None:
        _print_lines(beat.about())
    _print_lines([("robot", note) for note in (swim.robot.notes if swim.robot else ())])
    if robot is not None:
        print(*robot.about(), sep="\n")
    print(run.summary(options.periods))
    if robot is not None and run.torque is not None:
        later = robot.torque(run)[run.time >= 0.5 * run.time[-1]]
        sizes = f"greatest {np.max(np.abs(later)):.4g} N m, RMS {np.sqrt(np.mean(later**2)):.4g} N m"
        print(f"torque of a joint   {sizes}, later half")
    if beat is not None:
        _print_lines(effect_of_fit(beat, swim.body, swim.scene))
    if options.file is not None:
        _print_smoothing(run)
    print(f"wall time           {seconds:.3f} s, set-up included")
    if options.actuators is not None:
        print(run.actuators(options.actuators).table())
    if out is not None:
        _write(run, out)
        print(f"written to          {written_as(out)}")
    return 0


def _swim_of(options: argparse.Namespace, beat: Beat | None, robot: LoggedRobot | None) -> Swim:
    """The swim of the options: of a gait, a file of a motion, the `beat` of a film, or the log of a `robot`."""
    duration, body = options.duration, Body.boyer2010()
    if robot is not None:
        body = robot.body
    if beat is not None:
        body = body_for(options.body, beat.film)
    words = options if robot is None and beat is None else argparse.Namespace(**vars(options) | {"body": None})
    swim = swim_from(Swim(body=body), words)
    if robot is not None or (beat is not None and options.body):
        swim = swim.unchecked(body=body)  # in place of that of a robot file
    law = _law(options, swim.body, beat, robot)
    if duration is None and beat is not None:
        duration = UNTIL_SETTLED
    elif duration is None:
        duration = law.duration if isinstance(law, SampledLaw) else DURATION
    return swim.changed(law=law, duration=duration, gait=None)


def _scene_of_file(options: argparse.Namespace) -> Swim:
    """The swim of a scene's file, changed by the options."""
    for given in filter(None, (options.file, options.midlines, options.joints, options.sequence)):
        raise ValueError(f"{options.gait} has a gait of its own, got {shown(given)} too")
    return swim_from(options.gait, options, **set_numbers(options.set))


def _law(options: argparse.Namespace, body: Body, beat: Beat | None, robot: LoggedRobot | None) -> Law | SampledLaw:
    """The law of the gait, the sequence, the motion in a file, the `beat` of a film, or a `robot`'s log."""
    if options.file is None and (options.unsmoothed or (options.scale != 1.0 and beat is None)):
        raise ValueError("--unsmoothed and --scale belong to --file, which is not given")
    of_film = options.rate, options.animal, options.points, options.rigid, options.harmonics, options.likely is not None
    if beat is None and (any(of_film) or (options.units and robot is None)):
        rule = "--units, --rate, --animal, --points, --likely, --rigid and --harmonics belong to --midlines"
        raise ValueError(f"{rule}, which is not given")
    of_log = options.columns, options.topic, options.tail_first, options.links, options.section, options.mass
    if robot is None and (any(of_log) or options.joint_drag is not None or options.clock != 1.0):
        raise ValueError(
            "--columns, --topic, --tail-first, --links, --section, --joint-drag, --clock and --mass belong to "
            "--joints, which is not given"
        )
    given = [name for name in ("midlines", "joints", "file", "sequence") if getattr(options, name) is not None]
    if options.time and not set(given) & {"midlines", "joints", "file"}:
        raise ValueError("--time belongs to --midlines, --joints or --file, none of which is given")
    if not given:
        return gait(options.gait or "falling", **set_numbers(options.set))
    others = [options.gait, *(f"--set {text}" for text in options.set[:1]), *(f"--{name}" for name in given[1:])]
    if any(others):
        raise ValueError(f"--{given[0]} takes the place of a gait, got {shown(next(filter(None, others)))} too")
    if beat is not None:
        return beat.law(body.length)
    if robot is not None:
        return robot.law
    if options.file is None:
        return sequence_from_file(options.sequence)
    return read_motion(
        options.file, length=body.length, scale=options.scale, smooth=not options.unsmoothed, time=options.time
    )


def _print_lines(lines: list[tuple[str, str]]) -> None:
    for name, text in lines:
        print(f"{name:<20}{text}")


def _print_smoothing(run: Run) -> None:
    """Print the difference that smoothing of its motion makes to the run."""
    try:
        effect: object = run.smoothing
    except (ValueError, SimulationStopped) as error:
        effect = f"without it the motion cannot be swum: {one_line(error)}"
    if effect is not None:
        print(f"smoothing           {effect}")


def _check_actuators(options: argparse.Namespace, scene: Scene) -> None:
    """`ValueError` before the swim for anything that `Run.actuators` would refuse."""
    if not 1 <= options.actuators <= MOST_JOINTS:
        raise ValueError(f"--actuators must be 1 to {MOST_JOINTS}, got {shown(options.actuators)}")
    if not scene.internal_wrench:
        raise ValueError("--actuators needs --scene internal_wrench=on, got off")
    if (options.stations or STATIONS) < 4:
        raise ValueError(f"--actuators needs 4 --stations or more, got {options.stations}")


def _checked_out(out: str | None) -> Path | None:
    if out is None:
        return None
    if Path(out).suffix == ".rrd" and None in map(find_spec, ("eel_viz", "rerun")):
        raise ValueError(f"--out .rrd needs eel_viz and rerun-sdk: {bring_viz()}")
    return checked_out(NAME, out, SUFFIXES)


def _write(run: Run, path: Path) -> None:
    if path.suffix == ".rrd":
        run.to_rerun(path)
        return
    if path.suffix == ".nc":
        run.save(path)
        return
    error = run.error_estimate
    errors = {} if error is None else {f"error_{name}": value for name, value in error.errors.items()}
    errors |= {} if error is None else {"error_growth_rate": error.growth_rate}
    if path.suffix == ".npz":
        with replacing(path) as draft:
            arrays: dict[str, Any] = contents_of_run(run).arrays | errors | {"axes": run.axes}
            np.savez_compressed(draft, **arrays)
        return
    columns = columns_of(run) | {name: np.full(len(run.time), value) for name, value in errors.items()}
    write_columns(columns, path)
