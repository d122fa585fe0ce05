# SPDX-License-Identifier: Apache-2.0
"""`sweep`: simulate a grid of parameters on all cores or a Dask cluster; writes labelled arrays to a NetCDF file.

sweep straight --vary period=0.5:2:16 --vary scene.friction=printed,laminar --out periods.nc
sweep straight --vary body=boyer2010,kern2006 --vary wavelength=0.6:1.2:7 --scheduler tcp://host:8786 --out waves.nc
"""

import sys
import time
from functools import partial

import numpy as np
from eel_base.command_line import Parser, complain, interruptible
from eel_base.one_line_warnings import one_line_warnings
from eel_base.output_file import NotWritten, command_begins, written_as
from eel_dynamics.accuracy.accuracy import PRESETS
from eel_dynamics.analysis.measures import MEASURES
from eel_dynamics.model.body import NAMED
from eel_dynamics.runs.command_options import (
    add_repeated,
    body_of,
    check_names,
    duration_option,
    named_texts,
    set_numbers,
    varied_values,
)
from eel_dynamics.runs.settled_duration import UNTIL_SETTLED
from eel_gaits.gaits.registry import GAITS

from eel_studies.sweeps.sweep import check_points, sweep


def main(arguments: list[str] | None = None) -> int:
    """Exit status 0; 1 where the output cannot be written to its end; 2 for bad input or a missing package; 4 where
    points could not be computed; 130 when interrupted. An error prints one line with its reason.
    """
    options = _parser().parse_args(arguments)
    with one_line_warnings("sweep"), command_begins():
        return _sweep(options)


def _sweep(options) -> int:
    start = time.perf_counter()
    try:
        numbers, vary = set_numbers(options.set), named_texts("--vary", options.vary)
        check_names([*numbers, *(name for name, _ in vary)])
        grid = {name: varied_values(text, partial(check_points, name)) for name, text in vary}
        with interruptible():
            data = sweep(
                grid,
                gait=options.gait,
                numbers=numbers,
                duration=options.duration,
                body=body_of(options.body),
                accuracy=options.accuracy,
                sample_period=options.sample_period,
                out=options.out,
                scheduler=options.scheduler,
                workers=options.workers,
                estimate=not options.bare,
                measure=options.measures and options.measures.split(","),
                overwrite=options.overwrite,
            )
    except NotWritten as error:
        complain("sweep", error)
        return 1
    except (ValueError, ImportError, OSError) as error:
        complain("sweep", error)
        return 2
    except MemoryError as error:
        complain("sweep", f"it does not fit into memory: {error}")
        return 2
    except RuntimeError as error:
        complain("sweep", error)
        return 4
    except KeyboardInterrupt:
        complain("sweep", "interrupted; the same command goes on from here")
        return 130
    points = int(np.prod([len(values) for values in grid.values()]))
    print(f"points                      {points}, of which {int(data.stopped.sum())} stopped")
    for name, array in data.items():
        if name not in ("stopped", "error") and bool(array.notnull().any()):
            unit = array.attrs.get("units", "")
            unit = "" if unit == "1" else f" {unit}"
            print(f"{name:<28s}{float(array.min()):.4g} to {float(array.max()):.4g}{unit}")
    print(f"wall time                   {time.perf_counter() - start:.1f} s")
    print(f"written to                  {written_as(options.out)}")
    return 0


def _parser() -> Parser:
    parser = Parser(
        prog="sweep",
        description="Simulate every combination of parameters, and keep the measures of each run in a NetCDF file. "
        "After an interruption the same command resumes.",
    )
    parser.add_argument("gait", nargs="?", default="straight", help=f"one of {', '.join(sorted(GAITS))} (straight)")
    about = "a number of the gait, scene.FIELD, body or accuracy; values a,b,c or start:end:count"
    add_repeated(parser, "--vary", "NAME=VALUES", about, required=True)
    add_repeated(parser, "--set", "NAME=VALUE", "a number of the gait")
    parser.add_argument(
        "--duration", type=duration_option, default=UNTIL_SETTLED, help="s, or settled: until each gait has (settled)"
    )
    parser.add_argument("--accuracy", default="standard", help=f"{', '.join(PRESETS)}, or a target (standard)")
    parser.add_argument("--body", default="boyer2010", help=f"{', '.join(NAMED)}, or a file as for simulate")
    parser.add_argument(
        "--bare", action="store_true", help="do not measure the runs' own errors; --accuracy is not kept"
    )
    parser.add_argument("--measures", metavar="NAMES", help=f"what to keep, with commas: {', '.join(MEASURES)} (all)")
    parser.add_argument(
        "--sample-period",
        type=float,
        help="s (0.05, or a 20th of a point's period where that is less); the last sample is "
        "at its last whole multiple within the duration",
    )
    parser.add_argument("--out", required=True, metavar="FILE.nc", help="NetCDF file; parts lie in FILE.nc.parts")
    parser.add_argument("--overwrite", action="store_true", help="replace what the output holds of another sweep")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, or processes; without: threads")
    parser.add_argument("--workers", type=int, metavar="N", help="threads, or processes (one per core)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
