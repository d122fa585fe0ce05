# SPDX-License-Identifier: Apache-2.0
"""`eel stability`: map where a scene is accurate, sensitive or stops, or drive the simulator to its extremes.

eel stability scene.yaml --over step=1e-3:0.1 --over density_ratio=1e-3:1e6
eel stability                   # studies at the extremes; pictures into out
eel stability --study drift     # one of them: maps, condition, drift, plane
eel stability --page docs/appendix/stability.txt --out docs/images
"""

import argparse
from pathlib import Path

from eel_common.command.command import command
from eel_common.command.command_line import Parser
from eel_common.command.progress import Progress
from eel_common.wording import shown
from eel_dynamics.commands.options import add_repeated

from eel_studies.options import add_scene_options, check_least, chosen, ranges_of
from eel_studies.outputs import Outputs, add_output_options
from eel_studies.stability.maps import OUTCOMES, Axis, Map, measure
from eel_studies.stability.report import STUDIES, counts, report
from eel_studies.varied import NAMES, labelled, varied

NAME = "eel stability"


def _add_options(parser: Parser) -> None:
    add_scene_options(parser)
    add_repeated(parser, "--over", "NAME=LOW:HIGH", f"a number of the map: {NAMES}; twice")
    names = ", ".join(STUDIES)
    parser.add_argument("--study", action="append", choices=STUDIES, metavar="NAME", help=f"one of {names} (all)")
    parser.add_argument("--points", type=int, default=9, metavar="N", help="swims along each side of a map (9)")
    add_output_options(parser)


@command(
    NAME,
    "Map a scene over two of its numbers: each cell is swum, and checked against a run "
    "of a tenth of its target. Without a scene, drive the simulator to its extremes: such maps, the condition of "
    "the inertia, drift over 100,000 periods, growth out of a plane.",
    add_options=_add_options,
)
def main(options: argparse.Namespace) -> None:
    check_least(options, points=2)
    if options.swim is not None or options.over:
        _map(options)
        return
    studies, progress = options.study or list(STUDIES), Progress(NAME, "")
    outputs = Outputs(NAME, options, studies)
    for name in studies:
        progress.say(f"study {name}")
        text = STUDIES[name](options.points, outputs)
        print(f"{text}\n")
        outputs.write({name: text})


def _map(options: argparse.Namespace) -> None:
    axes = axes_from(options.over)
    if len(axes) != 2:
        raise ValueError(f"--over must be given for two numbers of the scene, got {len(axes)}")
    if options.study:
        raise ValueError(f"--study goes without a scene, got {shown(options.study[0])}")
    swim = chosen(options.swim, options)
    for axis in axes:
        varied(swim, {axis.name: axis.low})  # an unknown name is refused before the map
    scene = Path(options.swim or "falling").stem
    item = Map(scene, f"{scene}: {axes[0].name} and {axes[1].name}", axes[0], axes[1], options.points, swim)
    outputs = Outputs(NAME, options, [scene] if options.page else [])
    Progress(NAME, "").say(f"{options.points**2} swims, each twice")
    found = measure(item)
    print(counts([found]).text())
    for outcome in OUTCOMES[1:]:
        for text in filter(None, found.texts(outcome)):
            print(f"{outcome}: {text}")
    outputs.write({scene: report([found], outputs)})


def axes_from(texts: list[str]) -> list[Axis]:
    """The axes from --over, with numbers above 0: the map is logarithmic."""
    found = ranges_of("--over", texts, ", 0 < LOW < HIGH")
    for name, (low, high) in found.items():
        if not 0.0 < low < high < float("inf"):
            raise ValueError(f"--over must be NAME=LOW:HIGH, 0 < LOW < HIGH, got {shown(f'{name}={low:g}:{high:g}')}")
    return [Axis(labelled(name), name, *ends) for name, ends in found.items()]
