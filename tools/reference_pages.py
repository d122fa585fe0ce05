# SPDX-License-Identifier: Apache-2.0
"""The reference pages that follow from the code, for `make docs`: messages, parameters, commands, formulas of gaits.

The messages are their files. Parameters come from the dataclasses that the nodes declare them from; commands and nodes
tell their own `--help`. The pages are not kept in the repository.
"""

import csv
import inspect
import subprocess
import sys
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from eel_common.command.suite import commands as known_commands
from eel_common.files.markdown import table
from eel_common.quantity import limits
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.sensors.suite import KINDS
from eel_gaits.gaits.registry import GAITS, Transition
from eel_gaits.gaits.settings import FILE_GAITS, numbers_of
from eel_gaits.pilot.settings import GROUPS
from eel_gaits.ros.heading_controller import HeadingParameters
from eel_gaits.ros.node import FILE
from eel_viz.settings import MarkerSettings, Settings

from eel_dynamics import Scene

ROOT = Path(__file__).resolve().parents[1]
REFERENCE = ROOT / "docs" / "reference"


@dataclass
class Gait:
    """The gait generator's own parameters; its node declares them from the list of gaits."""

    gait: str = field(
        default="falling",
        metadata={"unit": "", "description": "name of the gait", "choices": sorted((*GAITS, *FILE_GAITS))},
    )
    file: str = field(default="", metadata={"unit": "", "description": FILE})


HEAD = "parameter", "default", "unit", "must be", "meaning"
NODES: dict[str, list[tuple[str, str, type[Any]]]] = {  # node: heading, prefix and dataclass of its parameters
    "gait_generator": [
        ("", "", Gait),
        ("", "", Transition),
        *((f"gait {name}", "", numbers_of(name)) for name in sorted((*GAITS, *FILE_GAITS))),
    ],
    "dynamics": [
        ("", "", DynamicsParameters),
        ("scene", "scene.", Scene),
        *((name, f"{name}.", kind) for name, kind in KINDS.items()),
    ],
    "heading_controller": [("", "", HeadingParameters)],
    "pilot": [("", "", kind) for kind in GROUPS],
    "visualiser": [("", "", Settings)],
    "markers": [("", "", MarkerSettings)],
}
COMMANDS = tuple(f"eel {name}" for name in known_commands())


def parameter_names(node: str) -> set[str]:
    """The names of all parameters of a node."""
    return {prefix + item.name for _, prefix, kind in NODES[node] for item in fields(kind)}


def messages() -> str:
    """Every message and service, as its file tells it."""
    parts = ["# Messages and services", "", "All units are SI, angles radians. `eel_msgs` holds:"]
    for kind in ("msg", "srv"):
        for path in sorted((ROOT / "src" / "eel_msgs" / kind).glob(f"*.{kind}")):
            parts += ["", f"## {path.stem}", "", "```text", path.read_text(encoding="utf-8").rstrip(), "```"]
    return "\n".join(parts) + "\n"


def parameters() -> str:
    """A table for each node; of the gait generator one for each gait."""
    parts = ["# Parameters of the nodes", "", "`ros2 param describe NODE NAME` tells the same."]
    for node, tables in NODES.items():
        parts += ["", f"## {node}"]
        for heading, prefix, kind in tables:
            if fields(kind):
                parts += ["", f"### {heading}"] if heading else []
                parts += ["", table(HEAD, (_row(prefix, item) for item in fields(kind)))]
    return "\n".join(parts) + "\n"


def _row(prefix: str, item) -> list[str]:
    about = item.metadata
    must = f"one of {', '.join(about['choices'])}" if "choices" in about else limits(about)
    default = "" if item.default is None else f"`{item.default!r}`"
    cells = f"`{prefix}{item.name}`", default, about["unit"], must, about["description"]
    return [cell.replace("|", "&#124;") for cell in cells]


def commands() -> str:
    """What `--help` of every command and node says."""
    parts = ["# Commands", ""]
    for name in ("eel", *COMMANDS, *NODES):
        shown = subprocess.run([*name.split(), "--help"], capture_output=True, text=True, check=True, timeout=60)
        parts += [f"## {name}", "", "```text", shown.stdout.rstrip(), "```", ""]
    return "\n".join(parts)


def formulas() -> str:
    """The docstring of each file of gaits: formulas and sources; below it their swims, by manoeuvres.csv."""
    with (REFERENCE / "manoeuvres.csv").open(encoding="utf-8", newline="") as file:
        notes = {row["gait"]: row["note"] for row in csv.DictReader(file)}
    parts = [
        "# Formulas of the gaits",
        "",
        "Each block is the docstring of a file of gaits; its gaits swim for 20 s.",
        "",
    ]
    module = None
    for name, gait in GAITS.items():
        if (of_gait := inspect.getmodule(inspect.unwrap(gait))) is not module:
            module = of_gait
            parts += [f"```text\n{(inspect.getdoc(module) or '').strip()}\n```\n"]
        parts += [f"**{name}**. {notes[name]}".strip() + "\n", f"![{name}](../images/manoeuvres/{name}.png)\n"]
    return "\n".join(parts)


def main() -> int:
    for page in (messages, parameters, commands, formulas):
        path = REFERENCE / f"{page.__name__}.md"
        path.write_text(page(), encoding="utf-8")
        print(path.relative_to(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
