# SPDX-License-Identifier: Apache-2.0
"""Runs commands whose options, texts and files were mutated, in a process of its own, and tells what became of each.

    python fuzzed_texts.py FOLDER SEED FIRST LAST LIMIT SECONDS

Case number N of a SEED is the same in every process: a command line that is good but for one or two words, or for a
file that it names. Prints one line of JSON per case: its number, words, file, exit status, what was raised, standard
error, wall time [s]. LIMIT [MB] bounds the memory above that at the start; after SECONDS of a case the process ends.
"""

import contextlib
import copy
import importlib
import io
import json
import math
import os
import random
import re
import resource
import shutil
import signal
import sys
import time
import traceback
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from eel_common.command.command_line import print_to_stderr
from eel_common.files.yaml_tree import read_yaml
from eel_common.quantity import checked_instance
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.ros.simulation_from_parameters import simulation_from_parameters
from eel_gaits.gaits.settings import Settings
from eel_gaits.pilot.settings import PilotSettings

from eel_dynamics import Scene

MEGABYTE = 2**20
COMMANDS = {
    "simulate": "eel_dynamics.commands.simulate",
    "ballast": "eel_dynamics.commands.ballast",
    "sweep": "eel_studies.sweeps.command",
    "optimise": "eel_studies.optimisation.command",
    "identify": "eel_studies.identification.command",
    "roll-hold": "eel_studies.roll_hold.command",
    "motors": "eel_studies.motors.command",
    "terms": "eel_studies.scene_terms.command",
    "tradeoff": "eel_studies.tradeoff.command",
    "stability": "eel_studies.stability.command",
    "compare": "eel_studies.comparison.command",
    "replay": "eel_viz.bags.replay",
    "render": "eel_viz.pictures.render",
}

SHORT = ["--duration", "0.02", "--accuracy", "draft", "--bare"]
FLOWS = (
    "uniform velocity=0.1,0,0",
    "uniform time=0,1 velocity=0,0,0;0.1,0,0",
    "gust velocity=0,0.1,0 start=3 rise=1 hold=1 fall=1",
    "shear velocity=0.1,0,0 width=0.5 across=0,1,0 profile=tanh",
    "vortex circulation=0.1 core=0.3 centre=0,0.2,0 drift=0.1,0,0",
    "vortex_street core=0.3 spacing=1 width=0.28 count=5 downstream=1,0 + gust velocity=0,0.1,0 start=3",
    "wave amplitude=0.05 wavelength=4 surface=0.5 direction=1,0 phase=0.3",
)
FINS = (
    "pair station=0.5 area=0.0015 aspect_ratio=2.5 k_p=4 k_d=0.5 time_constant=0.05",
    "left station=0.5 area=0.0005 aspect_ratio=3 angle=commanded time_constant=0.1 + right station=0.3 area=0.001 "
    "aspect_ratio=2 dihedral=0.3 angle=0.2 lift_slope=3 name=rear",
)
BODIES = (
    "boyer2010 density=900 roll_drag=1.2 vertical_drag=by shape",
    "links length=1.62 number=9 half_width=0.05 half_height=0.055 joints=0.65 mass=7.2 nose=0.05 tail=0.1",
    "kern2006",
    "fish.csv base_drag=0.2 appendages=arms.csv",
)
GAITS = ("straight", "falling", "turning", "helix", "rolling", "cpg", "kern_fast")
SCENES = (
    "planar=on",
    "friction=laminar",
    "current=0.1,0,0",
    "density=900",
    "viscosity=1e-5",
    "metacentric_height=0.01",
)
NUMBERS = ("period=0.8", "wavelength=0.9", "left_bend=0.5", "wavelength=1", "transition=1", "amplitude=1", "waves=2")

SWIM = """
gait: straight
period: 0.8
body: kern2006
scene: {planar: true, fluid_density: 900, current: [-0.1, 0, 0], friction: laminar}
accuracy: 1e-2
duration: 0.02
sample_period: 0.01
initial_linear_velocity: [0.2, 0.1, 0]
initial_position: [1, 2, 3]
stations: 11
robot: eight_servos
flow: gust velocity=0.1,0,0 start=0.5 + shear velocity=0.2,0,0 width=2
"""
PARAMETERS = """
accuracy: 1e-2
rate: 100.0
stations: 11
body: links length=1 number=8 half_width=0.03 half_height=0.04 joints=flush
flow: vortex core=0.2
fins: pair station=0.5 area=1e-3 aspect_ratio=2 angle=commanded time_constant=0.1
robot: eight_servos
command_interfaces: [position]
initial_position: [0.0, 0.0, 0.0]
initial_orientation: [0.0, 0.0, 0.0, 1.0]
gait: straight
period: 0.8
reach: 0.3
scene: {weight: false, current: [0.1, 0.0, 0.0], friction: laminar}
"""
SEQUENCE = """
name: patrol
blend: 0.5
steps:
  - {gait: straight, set: {period: 0.8}, duration: 2.0}
  - {gait: turning, set: {left_bend: 0.5}, duration: 1.0, blend: 0.3, scale: 0.8, mirror: yaw, delay: 0.5}
  - {together: [{gait: straight}, {gait: rolling, scale: 0.2}], duration: 1.0}
  - {repeat: 2, steps: [{gait: straight, duration: 2.0}, {gait: still, duration: 1.0}]}
"""
ROBOTS = (
    """
name: mine
body: fish.csv
joints:
  - position: [0.20, 0.32, 0.44]
    servo: {kp: 13.8, kd: 0.37, torque_limit: 3.0, speed_limit: 8.06, gear: 10, rotor_inertia: 1.0e-6}
  - {position: 0.5, stiffness: 2.0, damping: 0.01, limits: [-0.8, 0.8], name: last, initial_angle: 0.1}
tails:
  - {start: 0.6, bending_stiffness: 0.6, damping: 0.01, modes: 4}
""",
    """
muscles:
  - start: 0.2
    end: 0.5
    bending_stiffness: {x: [0.2, 0.5], values: [1.0, 0.5]}
    damping: 0.1
    moment: [{amplitude: [0.5], wavelength: 1.0, period: 1.0, envelope: [{start: 0, end: 1, delta: 1}]}]
""",
    """
joints:
  - {position: 0.4, axis: yaw, width: 0.02, torque: {time: [0, 1, 2], torque: [0, 0.1, 0]}}
  - {position: 0.6, axis: pitch, stiffness: 1.0, armature: 1.0e-4}
  - {position: 0.7, servo: xm430_w210}
""",
)
URDF = """<robot name="chain">
  <link name="a"><inertial><origin xyz="0.05 0 0"/><mass value="0.3"/><inertia ixx="1e-4" iyy="3e-4" izz="3e-4"/>
    </inertial><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.05 0.06"/></geometry></collision></link>
  <link name="b"><inertial><origin xyz="0.05 0 0"/><mass value="0.3"/><inertia ixx="1e-4" iyy="3e-4" izz="3e-4"/>
    </inertial><collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.05 0.06"/></geometry></collision></link>
  <link name="c"><inertial><origin xyz="0.05 0 0" rpy="0 0 0"/><mass value="0.3"/><inertia ixx="1e-4" iyy="3e-4"
    izz="3e-4"/></inertial><visual><origin xyz="0.05 0 0" rpy="0 1.5708 0"/><geometry><cylinder radius="0.03"
    length="0.1"/></geometry></visual></link>
  <joint name="ab" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="1.5" effort="3" velocity="3"/><dynamics damping="0.01" friction="0"/></joint>
  <joint name="bc" type="continuous"><parent link="b"/><child link="c"/><origin xyz="0.1 0 0"/><axis xyz="0 0 -1"/>
    </joint>
</robot>
"""
BODY_TABLE = "x,half_width,half_height\n" + "".join(
    f"{0.1 * n:.1f},{0.03 * (n / 10 * (1.3 - n / 10)) ** 0.5:.5f},{0.04 * (n / 10 * (1.3 - n / 10)) ** 0.5:.5f}\n"
    for n in range(11)
)
WAVES = [[math.sin(20.0 * 0.02 * n - 1.2 * k) for k in range(6)] for n in range(60)]
ANGLES = "time,yaw_1,yaw_2,yaw_3\n" + "".join(
    f"{0.02 * n:.2f},{a:.4f},{b:.4f},{c:.4f}\n" for n, (a, b, c, *_) in enumerate(WAVES)
)
FILM = (
    "time_s,"
    + ",".join(f"x{k},y{k}" for k in range(6))
    + "\n"
    + "".join(
        ",".join([f"{0.02 * n:.2f}", *(f"{100 * k},{6.0 * k * y:.2f}" for k, y in enumerate(row))]) + "\n"
        for n, row in enumerate(WAVES)
    )
)
SEEN = "time,x,y\n" + "".join(f"{0.1 * n},{0.01 * n},0\n" for n in range(5))
ARMS = "x,y,z,drag1,drag2,drag3,law\n0.2,0.05,0,1e-4,2e-4,3e-4,axis\n0.6,,,0.001,,,speed\n"

EXTREMES = ("0", "-0.0", "5e-324", "1e-300", "1e-40", "1e-9", "-1", "1e9", "1e19", "1e40", "1e300", "-1e300", "1e999")
EXTREMES += ("nan", "inf", "-inf", "2**63", "9" * 400, "0x10", "1_0", "1e", "--1", "٣", "½", "1j")
ODD = ("", " ", "+", " + ", "=", "=1", ",", ";", ":", "1,2", "1;2,3", "1,2,3,4", "0,0,0", "true", "none", "None", "[1]")
ODD += (
    "{a: 1}",
    "&a [*a]",
    "!!binary x",
    "é",
    "\ud800",
    "\0",
    "\n",
    "a b",
    "-",
    "--",
    "commanded",
    "flush",
    "by_shape",
)
ODD += ("/", ".", "/dev/zero", "/proc/self/mem", "missing.yaml", "missing.nc", "missing.csv", "x" * 300, "%s", "{}")
VALUES: tuple[Any, ...] = (
    0, -1, 1, 2**63, 2**2000, 0.0, -0.0, 5e-324, 1e-300, 1e-40, 1e-9, 1e9, 1e19, 1e40, 1e300, -1e300, float("nan"),
    float("inf"), True, False, None, "", " ", "a", "é", "1", "1e300", "nan", [], [1], [1, 2], ["a"], [[1, 2], [3]], {},
    {"a": 1}, {"x": [0, 1], "values": [1, 2]}, [None], [{}], "x" * 2000, "missing.csv", "/dev/zero", "\x01",
)  # fmt: skip
NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?")


class Case(NamedTuple):
    """A command line, and files by name with their content, which it may name."""

    words: list[str]
    files: dict[str, bytes]


def node_of(words: list[str]) -> int:
    """What the nodes dynamics, gait_generator and pilot make of the parameters in a file, without ROS."""
    try:
        given = checked_instance("parameters", read_yaml(words[0] if words else ""), dict)
        scene = Scene().changed(checked_instance("scene", given.pop("scene", {}), dict))
        simulation_from_parameters(DynamicsParameters.among(given), scene)
        Settings.start(given).law()
        PilotSettings.among(given)
    except (ValueError, OSError) as error:  # as they do
        print_to_stderr("node", error)
        return 2
    return 0


def good_cases() -> list[Case]:
    """Command lines that are good."""
    found = [Case(["simulate", "straight", *SHORT, "--flow", flow], {}) for flow in FLOWS]
    found += [Case(["simulate", "straight", *SHORT, "--fins", fins], {}) for fins in FINS]
    found += [Case(["simulate", "straight", *SHORT, "--body", body], {}) for body in BODIES]
    found += [Case(["simulate", name, *SHORT, "--set", NUMBERS[n]], {}) for n, name in enumerate(GAITS)]
    found += [Case(["simulate", "straight", *SHORT, "--scene", scene], {}) for scene in SCENES]
    found += [Case(["simulate", "swim.yaml"], {"swim.yaml": SWIM.encode()})] * 6
    found += [Case(["simulate", "--sequence", "steps.yaml", *SHORT], {"steps.yaml": SEQUENCE.encode()})] * 4
    found += [
        Case(["simulate", "straight", *SHORT, "--robot", "r.yaml"], {"r.yaml": each.encode()}) for each in ROBOTS
    ] * 3
    found += [
        Case(["simulate", "straight", *SHORT, "--robot", "chain.urdf joints=flush"], {"chain.urdf": URDF.encode()})
    ] * 3
    found += [Case(["simulate", "straight", *SHORT, "--body", "fish.csv"], {"fish.csv": BODY_TABLE.encode()})]
    found += [Case(["simulate", "straight", *SHORT, "--body", BODIES[3]], {"arms.csv": ARMS.encode()})]
    found += [Case(["node", "parameters.yaml"], {"parameters.yaml": PARAMETERS.encode()})] * 5
    found += [Case(["simulate", "--file", "angles.csv", *SHORT], {"angles.csv": ANGLES.encode()})]
    of_log = ["--links", "0.1x3,0.1", "--section", "0.03,0.02", "--joint-drag", "0.5", "--mass", "1", "--clock", "1"]
    found += [Case(["simulate", "--joints", "angles.csv", *of_log, *SHORT], {"angles.csv": ANGLES.encode()})] * 2
    of_film = ["--units", "px", "--scale", "0.001"]
    found += [Case(["simulate", "--midlines", "film.csv", *of_film, *SHORT], {"film.csv": FILM.encode()})] * 2
    simulate = ["simulate", "straight", "--duration", "0.02", "--accuracy", "0.05"]
    for more in (
        ["--sample-period", "0.01"], ["--stations", "7"], ["--most-evaluations", "1e5"],
        ["--periods", "1", "--set", "period=0.01"],
        ["--actuators", "4"], ["--load"], ["--out", "run.nc"], ["--out", "run.csv"], ["--robot", "eight_servos"],
    ):  # fmt: skip
        found.append(Case([*simulate, *more], {}))
    swim = ["straight", "--duration", "0.02", "--accuracy", "draft"]
    found += [
        Case(["sweep", "straight", "--vary", "period=0.8,1", "--duration", "0.02", "--accuracy", "draft", "--bare",
              "--measures", "mean_speed", "--out", "s.nc", "--overwrite", "--workers", "1"], {}),
        Case(["optimise", "straight", "--bound", "period=0.5:2", "--speeds", "0.1,0.2", "--cost", "nothing"], {}),
        Case(["identify", "seen.csv", "--first", "body.nose_drag=0.4", "--noise", "0.1", "--accuracy", "draft",
              "--gait", "straight"], {"seen.csv": SEEN.encode()}),
        Case(["terms", *swim, "--tolerance", "0.1", "--out", "t.yaml"], {}),
        Case(["stability", *swim, "--over", "period=0.5:1", "--points", "0"], {}),
        Case(["motors", "eight_servos", *swim, "--vary", "kp=1,0"], {}),
        Case(["motors", "chain.urdf joints=flush", *swim, "--servo", "kp=20", "--servo", "kd=0.5"],
             {"chain.urdf": URDF.encode()}),
        Case(["roll-hold", *swim, "--over", "k_p=0:1", "--points", "1"], {}),
        Case(["tradeoff", *swim, "--within", "0 ms"], {}),
        Case(["compare", "straight", "turning", "--duration", "0.02", "--set", "period=1"], {}),
        Case(["ballast", "--body", "kern2006", "--length", "0.1", "--offset", "0.01", "--out", "ballast.csv"], {}),
        Case(["replay", "bag.mcap", "--out", "x.rrd"], {"bag.mcap": b"\x89MCAP0\r\n"}),
        Case(["render", "missing.rrd", "--out", "x.mp4"], {}),
    ]  # fmt: skip
    return found


def mutated(case: Case, rng: random.Random) -> Case:
    """The case with a mutated word or file."""
    words, files = list(case.words), dict(case.files)
    for _ in range(rng.choice((1, 1, 1, 1, 2))):
        if files and rng.random() < 0.85:
            name = rng.choice(sorted(files))
            files[name] = mutated_file(files[name], rng, name.endswith(".yaml") and files[name] == case.files[name])
            continue
        plain = {"0.02", "draft", "straight"}
        common = [word in plain or word.startswith("--") for word in words]
        places = [n for n in range(1, len(words)) if not common[n] or rng.random() < 0.05] or [len(words) - 1]
        place, kind = rng.choice(places), rng.random()
        if kind < 0.05:
            del words[place]
        elif kind < 0.1:
            words.insert(place, words[place])
        else:
            words[place] = mutated_text(words[place], rng)
    return Case(words, files)


def mutated_text(text: str, rng: random.Random) -> str:
    """A text that differs by a number, a token or a character."""
    numbers, kind = list(NUMBER.finditer(text)), rng.random()
    if numbers and kind < 0.6:
        found = rng.choice(numbers)
        return text[: found.start()] + rng.choice(EXTREMES if rng.random() < 0.7 else ODD) + text[found.end() :]
    tokens = text.split(" ")
    place = rng.randrange(len(tokens))
    if kind < 0.7 and len(tokens) > 1:
        del tokens[place]
    elif kind < 0.74:
        tokens.insert(place, tokens[place])
    elif kind < 0.84:
        name, sign, value = tokens[place].partition("=")
        tokens[place] = f"{name}={rng.choice((*EXTREMES, *ODD))}" if rng.random() < 0.7 else f"{name}x{sign}{value}"
    elif kind < 0.92:
        at = rng.randrange(len(text) + 1)
        return text[:at] + rng.choice(ODD) + text[at + rng.choice((0, 1)) :]
    elif kind < 0.96:
        return text[: rng.randrange(len(text) + 1)]
    else:
        return rng.choice((*ODD, text * 50, text.upper(), text[::-1]))
    return " ".join(tokens)


def mutated_file(content: bytes, rng: random.Random, is_tree: bool) -> bytes:
    """A file that differs by a value, a text or some bytes. is_tree: whether it is a mapping of YAML."""
    if rng.random() < 0.12:
        at = rng.randrange(len(content) + 1)
        noise = rng.choice(
            (b"\0", b"\xff\xfe", b"\xe4", b"\t", b":", b"{", b"&a ", b"- ", b"'", b"<", b"]]>", b"\r", b"")
        )
        return content[:at] + noise + content[at + rng.randrange(4) :]
    if not is_tree or rng.random() < 0.1:
        return mutated_text(content.decode("utf-8", "replace"), rng).encode("utf-8", "surrogatepass")
    tree = yaml.safe_load(content)
    change_tree(tree, rng)
    return yaml.safe_dump(tree, allow_unicode=True).encode("utf-8", "surrogatepass")


def change_tree(tree: Any, rng: random.Random) -> None:
    """Change one value, key or entry in a `tree` of mappings and lists."""
    places = [(above, key) for above, key in _places(tree)]
    above, key = rng.choice(places)
    kind = rng.random()
    if kind < 0.7:
        value = above[key]
        if isinstance(value, str) and rng.random() < 0.5:
            above[key] = mutated_text(value, rng)
        else:
            above[key] = copy.deepcopy(rng.choice(VALUES))
    elif kind < 0.8:
        del above[key]
    elif kind < 0.9 and isinstance(above, dict):
        above[rng.choice((f"{key}x", 1, None, True, "", "name", "steps"))] = above.pop(key)
    else:
        above[key] = [above[key]] if rng.random() < 0.5 else {"a": above[key]}


def _places(tree: Any) -> Any:
    for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        yield tree, key
        if isinstance(value, (dict, list)):
            yield from _places(value)


def case_of(seed: int, number: int) -> Case:
    """The case of this `number`."""
    rng = random.Random(f"{seed} {number}")
    good = good_cases()
    return mutated(good[number % len(good)], rng)


def run(case: Case) -> tuple[int | None, str, str, float]:
    """Exit status, what was raised ("" for nothing), standard error, and wall time [s]."""
    for path in Path().iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    for name, content in {"fish.csv": BODY_TABLE.encode(), "arms.csv": ARMS.encode(), **case.files}.items():
        Path(name).write_bytes(content)
    output, errors, raised, status, start = io.StringIO(), io.StringIO(), "", None, time.monotonic()
    command, *words = case.words
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            status = node_of(words) if command == "node" else importlib.import_module(COMMANDS[command]).main(words)
        except SystemExit as end:  # of argparse
            status = int(end.code or 0)
        except BaseException as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            raised = f"{type(error).__name__}: {str(error)[:200]} in {Path(place.filename).name}:{place.lineno}"
    return status, raised, errors.getvalue(), time.monotonic() - start


def main(folder: str, seed: int, first: int, last: int, limit: int, seconds: int) -> None:
    """Run the cases from `first` to before `last` in `folder`, which loses what it holds."""
    os.chdir(folder)
    run(Case([*good_cases()[0].words], {}))
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + limit * MEGABYTE
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    for number in range(first, last):
        case = case_of(seed, number)
        signal.alarm(seconds)  # ends the process
        status, raised, errors, took = run(case)
        signal.alarm(0)
        files = {name: content.decode("latin-1") for name, content in case.files.items()}
        print(json.dumps([number, case.words, files, status, raised, errors, round(took, 3)]), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
