# SPDX-License-Identifier: Apache-2.0
"""`eel replay`: turn a bag into a Rerun recording like the visualiser's.

    eel replay BAG -o run.rrd

Messages pass through the visualiser's `dispatcher`, in the recorded order, as fast as possible. A
reset in the bag begins a second file, as in the visualiser.
"""

import argparse
import contextlib
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from itertools import count
from pathlib import Path
from typing import Any

from eel_common.command.command import command
from eel_common.command.command_line import Parser, print_to_stderr
from eel_common.command.progress import Progress
from eel_common.files.output_file import beside
from eel_common.quantity import limits

from eel_viz.bags.bag import Bag
from eel_viz.bags.swimmer_messages import SwimmerMessages
from eel_viz.recording.destination import LogFunction
from eel_viz.recording.merged_messages import record_messages
from eel_viz.recording.sinks import destinations
from eel_viz.settings import Settings
from eel_viz.viewer import display, open_window

NAME = "eel replay"
OPTIONS: tuple[str, ...] = ("blueprint", "rate", "skin_rate", "colour_limit", "torque_limit", "force_limit")
OPTIONS += ("curvature_limit", "load_scale", "end_force_scale", "reach", "viewer")


def replay(
    path: str | os.PathLike[str],
    settings: Settings,
    *,
    other: str | os.PathLike[str] | None = None,
    namespace: str | None = None,
    log_info: LogFunction = lambda text: None,
    log_warning: LogFunction = lambda text: None,
    progress: Callable[[int, None], object] = lambda done, count: None,
) -> str:
    """Record the bag at `path` to `settings.sink`. Returns its topics with their numbers of messages as text.

    other: a bag for comparison, called `settings.compare`. Without it `settings.compare` is the namespace of another
    swimmer in the same bag. `ValueError` in one line if a bag cannot be read.
    """
    with contextlib.ExitStack() as stack:
        paths = [path, *([other] if other else [path] if settings.compare else [])]
        spaces = [namespace, *([None] if other else [settings.compare])]
        sources: list[SwimmerMessages] = []
        names: list[str] = []
        for where, space in zip(paths, spaces, strict=False):
            bag = stack.enter_context(Bag(where))
            sources.append(SwimmerMessages(bag, space, log_warning))
            names.append(name_of(where, other, path) if other else sources[-1].namespace.strip("/") or "eel")
        numbers = count(1)

        def counted(source: SwimmerMessages) -> Iterator[tuple[str, Any]]:
            for message in source:
                progress(next(numbers), None)
                yield message

        return record_messages(
            [counted(source) for source in sources],
            destinations(settings, log_info, log_warning),
            names=names,
            namespaces=[source.namespace for source in sources],
            log_warning=log_warning,
            has_several_publishers=sources[0].has_several_publishers,
        )


def name_of(bag: str | os.PathLike[str], *besides: str | os.PathLike[str]) -> str:
    """A bag's name: its folder's or file's, or its whole path if one of `besides` has the same name."""
    name = os.path.basename(os.path.abspath(bag)).removesuffix(".mcap").removesuffix(".db3")
    same = [each for each in besides if os.fspath(each) != os.fspath(bag) and name_of(each) == name]
    return os.fspath(bag).strip("/") if same else name


def _add_options(parser: Parser) -> None:
    parser.add_argument("bag", help="folder of the bag, or a file of one")
    parser.add_argument("-o", "--out", metavar="RRD", help="recording to write (default: BAG.rrd, in this folder)")
    parser.add_argument("--namespace", metavar="NS", help="of the swimmer, where the bag has more than one")
    parser.add_argument(
        "--compare",
        default="",
        metavar="OTHER",
        help="another bag, or with /NS another namespace of this one: its swimmer is laid over this one's, their "
        "difference drawn, in the arrangement compare",
    )
    parser.add_argument("--spawn", action="store_true", help="open a viewer on the recording when it is done")
    parser.add_argument("--connect", action="store_true", help="send it to a viewer that runs (see --viewer), too")
    for item in fields(Settings):
        if item.name in OPTIONS:
            about, kind = item.metadata, type(item.default)
            unit = f" [{about['unit']}]" if about["unit"] else ""
            bounds = "" if kind is str else f"; {limits(about)}"
            text = f"{about['description']}{unit} (default {item.default}{bounds})".replace("%", "%%")
            option, letter = "--" + item.name.replace("_", "-"), "TEXT" if kind is str else "X"
            parser.add_argument(option, type=kind, default=item.default, help=text, metavar=letter)


@command(
    NAME,
    "Turn a rosbag2 folder (or one of its .mcap or .db3 files) into a Rerun recording without ROS: "
    "what the visualiser would show of these messages. Split bags, and bags compressed with zstd, are "
    "read; an unfinished bag is shown up to its end.",
    epilog="A reset in the bag begins another file, with a number before the suffix. Exit status: 0; 1 if the "
    "recording cannot be written to its end; 2 if the bag cannot be read or the recording not be begun; one line "
    "says why.",
    add_options=_add_options,
    interrupted=": the recording ends there",
)
def main(chosen: argparse.Namespace) -> None:
    output = chosen.out or str(beside(Path(f"{name_of(chosen.bag)}.rrd"), ""))
    other = chosen.compare if chosen.compare.strip("/") and os.path.exists(chosen.compare) else None
    began = time.monotonic()
    if chosen.spawn and not display():
        raise ValueError("--spawn needs a display, and there is none")
    values = {name: getattr(chosen, name) for name in OPTIONS}
    values["compare"] = name_of(other, chosen.bag) if other else chosen.compare
    sink = ("save", "connect") if chosen.connect else ("save",)
    counts = replay(
        chosen.bag,
        Settings.among({**values, "sink": sink, "recording": output}),
        other=other,
        namespace=chosen.namespace,
        log_info=print,
        log_warning=lambda text: print_to_stderr(NAME, text),
        progress=Progress(NAME, "messages"),
    )
    print(f"replayed in {time.monotonic() - began:.1f} s: {counts}")
    if chosen.spawn:
        open_window(output)
