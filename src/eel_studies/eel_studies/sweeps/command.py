# SPDX-License-Identifier: Apache-2.0
"""`eel sweep`: swim a grid of parameters, on all cores, into one file.

eel sweep straight --vary period=0.5:2:16 --vary scene.friction=printed,laminar --out periods.nc
eel sweep straight --vary period=0.5:2:8 --vary wavelength=0.6:1.4:9 --out map.nc --plot map.png
eel sweep scene.yaml --vary robot.kp=5,10,20 --out gains.nc
eel sweep straight --robot passive_tail --vary robot.bending_stiffness=0.1,0.2,0.4,0.8 --out tails.nc
eel sweep straight --vary body=boyer2010,kern2006 --vary wavelength=0.6:1.2:7 --scheduler tcp://host:8786 --out waves.nc
"""

import argparse
import time
from functools import partial

import numpy as np
from eel_common.command.command import checked_out, command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.files.output_file import written_as
from eel_dynamics.analysis.measures import MEASURES
from eel_dynamics.commands.options import (
    add_changes,
    add_options,
    add_repeated,
    check_names,
    named_texts,
    set_numbers,
    swim_from,
    varied_values,
)
from eel_dynamics.runs.scene_file import SUFFIXES
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED
from eel_dynamics.runs.storage.tables import needed

from eel_studies.pictures import PICTURES, write_picture
from eel_studies.sweeps.sweep import check_points, sweep
from eel_studies.sweeps.sweep_picture import draw_sweep, drawn_axes, drawn_measures, extremes_of, size_of

NAME = "eel sweep"


def _add_options(parser: Parser) -> None:
    about = "a number of the gait, a FIELD of scene., body., flow., fins. or robot., body, accuracy; a,b,c or "
    about += "start:end:count"
    add_options(parser, "gait", gait="straight")
    add_repeated(parser, "--vary", "NAME=VALUES", about, required=True)
    add_options(parser, "--set", "--bare")
    add_changes(parser, duration=(None, f"the scene's; of a gait: {UNTIL_SETTLED}"))
    parser.add_argument("--measures", metavar="NAMES", help=f"what to keep, with commas: {', '.join(MEASURES)} (all)")
    parser.add_argument("-o", "--out", required=True, metavar="FILE.nc", help="NetCDF file; parts lie in FILE.nc.parts")
    about = "picture (.png, .svg, .pdf): curves over one parameter, maps over two, with the place of the extremes"
    parser.add_argument("--plot", metavar="FILE", help=about)
    parser.add_argument("--overwrite", action="store_true", help="replace what the output holds of another sweep")
    parser.add_argument("--recordings", metavar="FOLDER", help="a Rerun recording of each point, to ask and to look at")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, or processes; without: threads")
    parser.add_argument("--workers", type=int, metavar="N", help="threads, or processes (one per core)")


@command(
    NAME,
    "Simulate every combination of parameters of a gait, or of the scene in a file, and keep the "
    "measures of each run in a NetCDF file. After an interruption the same command resumes.",
    add_options=_add_options,
    interrupted="; the same command goes on from here",
)
def main(options: argparse.Namespace) -> None:
    """Exit status as in `command`; 4 if points could not be computed, 130 after an interrupt."""
    start = time.perf_counter()
    numbers = set_numbers(options.set)
    vary = named_texts("--vary", options.vary)
    check_names([*numbers, *(name for name, _ in vary)])
    grid = {name: varied_values(text, partial(check_points, name)) for name, text in vary}
    axes = drawn_axes(grid) if options.plot else []
    picture = checked_out(NAME, options.plot, PICTURES, "--plot") if options.plot else None
    if picture:
        needed("matplotlib", NAME)
    measures = options.measures and options.measures.split(",")
    until = {} if options.gait.endswith(SUFFIXES) else {"duration": UNTIL_SETTLED}
    swim = swim_from(options.gait, options, **until)
    data = sweep(
        grid,
        gait=swim,
        numbers=numbers,
        out=options.out,
        scheduler=options.scheduler,
        workers=options.workers,
        estimate=not options.bare,
        measure=measures,
        progress=Progress(NAME, "points"),
        overwrite=options.overwrite,
        recordings=options.recordings,
    )
    points = int(np.prod([len(values) for values in grid.values()]))
    print(f"points                      {points}, of which {int(data.stopped.sum())} stopped")
    for name, array in data.items():
        if name not in ("stopped", "error") and bool(array.notnull().any()):
            unit = array.attrs.get("units", "")
            unit = "" if unit == "1" else f" {unit}"
            print(f"{name:<28s}{extremes_of(array)}{unit}")
    print(f"wall time                   {time.perf_counter() - start:.1f} s")
    if options.recordings:
        print(f"recordings in               {options.recordings}")
    print(f"written to                  {written_as(options.out)}")
    if picture:
        shown = drawn_measures(data, measures)
        if not shown:
            raise ValueError("--plot has nothing to draw: no measure is defined at any point")
        write_picture(lambda figure: draw_sweep(figure, data, axes, shown), size_of(len(shown)), picture)
        print(f"written to                  {written_as(picture)}")
