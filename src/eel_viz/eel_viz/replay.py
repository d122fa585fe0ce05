"""A bag into a Rerun recording, without ROS running: what the visualiser would have made of the same messages.

    replay BAG -o run.rrd

Messages take the very way that the visualiser's take (`intake`), in the order in which they were recorded, as fast as
it goes. A reset in the bag begins a second file, as it does live.
"""

import argparse
import os
import sys
import time
from dataclasses import fields

from eel_viz.bag import Bag
from eel_viz.intake import SAMPLES, Intake
from eel_viz.runs import Runs
from eel_viz.settings import Settings, limits
from eel_viz.sinks import Say, destinations
from eel_viz.topics import GLOBAL, OWN
from eel_viz.viewer import display, open_window

NAME = "replay"
DIAGNOSTICS = "/diagnostics"
OPTIONS = ("blueprint", "rate", "skin_rate", "colour_limit", "torque_limit", "force_limit", "curvature_limit")
OPTIONS += ("load_scale", "end_force_scale", "viewer")


class Replay:
    """Hands the messages of one swimmer in `bag` to an intake. `namespace`: which; None: the one that is there."""

    def __init__(self, bag: Bag, namespace: str | None, warn: Say) -> None:
        self._bag, self._warn = bag, warn
        self._told: set[str] = set()
        self.namespace = self._found(namespace)
        self._topics = {f"{self.namespace}/{name}": name for name in (*SAMPLES, "body", "curvature_law")}
        self._topics[DIAGNOSTICS] = "diagnostics"
        for topic, name in list(self._topics.items()):
            there, kind = bag.topics.get(topic), OWN.get(name) or GLOBAL.get(topic)
            if there is None or there.type != kind:
                del self._topics[topic]
            if there is not None and there.type != kind:
                warn(f"{topic} is left out: it is {there.type}, not {kind}")

    def crowded(self, name: str) -> bool:
        """Whether several publishers sent on a topic."""
        return any(
            self._bag.topics[topic].publishers > 1 for topic, relative in self._topics.items() if relative == name
        )

    def feed(self, intake: Intake) -> None:
        """All messages, in order; the body first, which is valid at all times."""
        body = f"{self.namespace}/body"
        first = next((message for _, _, message in self._bag.messages(body)), None) if body in self._topics else None
        if first is not None:
            self._take(intake, "body", first)
        for topic, _, message in self._bag.messages(*self._topics, unreadable=self._leave_out):
            if topic == body and first is not None:
                first = None
                continue
            self._take(intake, self._topics[topic], message)

    def _take(self, intake: Intake, name: str, message) -> None:
        try:
            intake.take(name, message)
        except AttributeError as error:
            self._leave_out(name, f"it comes from another version of its message: {error}")

    def _leave_out(self, topic: str, why: str) -> None:
        if topic not in self._told:
            self._told.add(topic)
            self._warn(f"{topic}: {why}: left out, and those like it")

    def _found(self, namespace: str | None) -> str:
        spaces = sorted(
            {
                topic[: -len(name) - 1]
                for topic, about in self._bag.topics.items()
                for name, kind in OWN.items()
                if topic.endswith(f"/{name}") and about.type == kind and name in SAMPLES
            }
        )
        named = ", ".join(space or "/" for space in spaces)
        if namespace is not None:
            wanted = "/" + namespace.strip("/") if namespace.strip("/") else ""
            if wanted not in spaces:
                raise ValueError(f"no swimmer in namespace {namespace!r} of the bag; there is: {named or 'none'}")
            return wanted
        if len(spaces) > 1:
            raise ValueError(f"the bag has swimmers in several namespaces, choose one with --namespace: {named}")
        if not spaces:
            topics = ", ".join(sorted(self._bag.topics)) or "none at all"
            raise ValueError(f"the bag has no topic of a swimmer; its topics: {topics}")
        return spaces[0]


def replay(
    path: str | os.PathLike[str],
    settings: Settings,
    *,
    namespace: str | None = None,
    say: Say = lambda text: None,
    warn: Say = lambda text: None,
) -> str:
    """The bag at `path` to where `settings.sink` says; returns in words what it held. `ValueError` in one line."""
    with Bag(path) as bag:
        source = Replay(bag, namespace, warn)
        if bag.damage:
            warn(f"{path} is unfinished or damaged ({bag.damage}): shown as far as it goes")
        runs = Runs(
            destinations(settings, say, warn),
            name=source.namespace.strip("/") or "eel",
            warn=warn,
            crowded=source.crowded,
        )
        intake = Intake(runs, namespace=source.namespace, warn=warn)
        try:
            source.feed(intake)
        finally:
            told = intake.close()
        return told


def parser() -> argparse.ArgumentParser:
    """What the command line takes."""
    made = argparse.ArgumentParser(
        prog=NAME,
        description="Turn a rosbag2 folder (or one of its .mcap or .db3 files) into a Rerun recording, without ROS "
        "running: the same that the visualiser shows of these messages. Split bags and those compressed with zstd are "
        "read; a bag that was not finished is shown as far as it goes.",
        epilog="A reset in the bag begins another file, with a number before the suffix. Exit status: 0; 2 if the bag "
        "cannot be read or the recording not be written, with one line that says why.",
    )
    made.add_argument("bag", help="folder of the bag, or a file of one")
    made.add_argument("-o", "--output", metavar="RRD", help="recording to write (default: BAG.rrd, in this folder)")
    made.add_argument("--namespace", metavar="NS", help="of the swimmer, where the bag has more than one")
    made.add_argument("--spawn", action="store_true", help="open a viewer on the recording when it is done")
    made.add_argument("--connect", action="store_true", help="send it to a viewer that runs (see --viewer), too")
    for item in fields(Settings):
        if item.name in OPTIONS:
            about, kind = item.metadata, type(item.default)
            unit = f" [{about['unit']}]" if about["unit"] else ""
            bounds = "" if kind is str else f"; {limits(about)}"
            text = f"{about['description']}{unit} (default {item.default}{bounds})".replace("%", "%%")
            made.add_argument(
                "--" + item.name.replace("_", "-"), type=kind, default=item.default, help=text, metavar=kind.__name__
            )
    return made


def main(arguments: list[str] | None = None) -> int:
    """Command line; status 0, 2 with one line on stderr if it cannot be done, 130 after Ctrl-C."""
    chosen = parser().parse_args(arguments)
    output = chosen.output or f"{os.path.basename(os.path.abspath(chosen.bag)).removesuffix('.mcap')}.rrd"

    def warn(text: str) -> None:
        sys.stderr.write(f"{NAME}: {text}\n")

    began = time.monotonic()
    try:
        if chosen.spawn and not display():
            raise ValueError("--spawn needs a display, and there is none")
        values = {name: getattr(chosen, name) for name in OPTIONS}
        sink = ("save", "connect") if chosen.connect else ("save",)
        settings = Settings.from_values({**values, "sink": sink, "recording": output})
        told = replay(chosen.bag, settings, namespace=chosen.namespace, say=print, warn=warn)
    except (ValueError, OSError) as error:
        warn(" ".join(str(error).split()))
        return 2
    except KeyboardInterrupt:
        warn("interrupted: the recording ends there")
        return 130
    print(f"replayed in {time.monotonic() - began:.1f} s: {told}")
    if chosen.spawn:
        open_window(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
