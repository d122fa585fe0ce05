# SPDX-License-Identifier: Apache-2.0
"""`eel ballast`: the ballast with which a body floats level, and the trim before and after.

eel ballast --body fish.csv
eel ballast --scene density=850 --offset 0.02 --out level.csv
"""

import argparse

import numpy as np
from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser
from eel_common.files.output_file import written_as

from eel_dynamics.analysis.trim import ballast_for, trim_of
from eel_dynamics.commands.options import add_options, scene_of
from eel_dynamics.model.body.body import COLUMNS, MASSES, Body
from eel_dynamics.model.body.text import body_of
from eel_dynamics.runs.storage.tables import write_columns

NAME = "eel ballast"
POINTS = 401  # of a body file


def _add_options(parser: Parser) -> None:
    add_options(parser, "--body", "--scene")
    parser.add_argument("--length", type=float, metavar="M", help="m that the ballast takes (a tenth of the body)")
    parser.add_argument("--offset", type=float, default=0.0, metavar="M", help="m below the axis (0)")
    parser.add_argument("--out", metavar="FILE", help=".csv: the body with its ballast, for --body of other commands")


@command(
    NAME,
    "Find the ballast with which a straight body floats level: its mass and its place along the body.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    body, scene = body_of(options.body), scene_of(options.scene)
    out = None if options.out is None else checked_out(NAME, options.out, (".csv",))
    print(f"without ballast     {trim_of(body, scene).about()}")
    found = ballast_for(body, scene, length=options.length, offset=options.offset)
    print(
        f"ballast             {found.mass:.5g} kg around X = {found.station:.5g} m, {found.length:.3g} m long, "
        f"{1e3 * found.offset:.3g} mm below the axis"
    )
    print(f"with ballast        {found.trim.about()}")
    if out is not None:
        write_columns(table_of(found.body), out)
        print(f"written to          {written_as(out)}")


def table_of(body: Body) -> dict[str, np.ndarray]:
    """The columns (n,) of a file of `body`, at points that are dense at the nose, and at its kinks."""
    x = np.union1d(body.length * np.linspace(0.0, 1.0, POINTS) ** 2, body.kinks)
    return {"x": x} | {name: getattr(body, name)(x) for name in (*COLUMNS[1:], *MASSES)}
