# SPDX-License-Identifier: Apache-2.0
"""Speed and accuracy, measured: `python benchmarks/run.py [NAME ...]`, one line per figure with its unit.

Each figure is the median of repeats in one process; ratios come from repeats taken in turn. Timings mean something on
an otherwise idle machine only.
"""

import platform
import subprocess
import sys
from collections.abc import Callable, Mapping

from commands import commands
from eel_common.wording import did_you_mean
from evaluations import evaluation, flows, wrench
from integrators import integrators
from lockstep import lockstep
from measuring import REPEATS, Lines
from nodes import nodes, visualiser
from overhead import overhead
from robots import robots
from sensors import sensors
from swims import batch, falling_gait, gym, start, ticks

OF_SWIMS = evaluation, flows, falling_gait, wrench, start, ticks, integrators, batch
FIGURES = {
    each.__name__.removesuffix("_gait"): each
    for each in (*OF_SWIMS, visualiser, nodes, lockstep, commands, gym, overhead, robots, sensors)
}


def main(names: list[str], known: Mapping[str, Callable[[], Lines]] = FIGURES) -> int:
    """Run the named figures of the `known`, or all. Exit status 2 for an unknown name."""
    for name in names:
        if name not in known:
            meant = did_you_mean(name, known)
            print(f"run.py: no figure {name!r}{meant}; there are {', '.join(known)}", file=sys.stderr)
            return 2
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    machine = f"{platform.processor() or platform.machine()}, Python {platform.python_version()}"
    print(f"{machine}, commit {commit or 'unknown'}, medians of {REPEATS}")
    for name in names or known:
        print(f"{name}: {' '.join((known[name].__doc__ or '').split())}")
        for label, value, unit in known[name]():
            print(f"  {label:42s} {value:10.4g} {unit}" if value is not None else f"  {label}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
