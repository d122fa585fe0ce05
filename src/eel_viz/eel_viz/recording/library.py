"""A run of the library to Rerun, without ROS: what `Run.to_rerun` calls.

It knows no run, only messages: pairs of a topic and a plain object with the fields of its message.
"""

import os
import warnings
from collections.abc import Sequence

import rerun as rr

from eel_viz.recording.destination import Destination, Say
from eel_viz.recording.loggers import Rates
from eel_viz.recording.merged_messages import Messages, show
from eel_viz.recording.recording_file import File
from eel_viz.settings import Settings

SPACE = ""  # what a library's run has in place of a namespace


class Given(Destination):
    """A stream that the caller has made, and that stays open."""

    def __init__(self, stream: rr.RecordingStream, settings: Settings, warn: Say) -> None:
        rates = Rates(numbers=0.0, drawings=settings.skin_rate, tick=float("inf"))
        super().__init__(settings, rates, lambda text: None, warn, live=False)
        self._stream = stream

    def open(self, run: int, name: str) -> rr.RecordingStream:
        """The stream, with the arrangement and the recording's name sent."""
        self._stream.send_blueprint(self._blueprint())
        self._stream.send_recording_name(name)
        return self._stream

    def end(self, stream: rr.RecordingStream) -> None:
        """Bring out what is on its way."""
        stream.flush()


def to_rerun(
    target: str | os.PathLike[str] | rr.RecordingStream,
    runs: Sequence[Messages],
    names: Sequence[str],
    **settings,
) -> None:
    """Show one run, or two that are compared, in `target`: a file to write (one that is there is replaced), or a
    stream.

    `settings` are those of the visualiser, such as blueprint or skin_rate. What cannot be shown is warned of. `OSError`
    where a file cannot be written to its end; an older one stays.
    """

    def warn(text: str) -> None:
        warnings.warn(text, stacklevel=4)

    fixed = {"sink", "recording", "compare"} & settings.keys()
    if fixed:
        raise ValueError(f"{', '.join(sorted(fixed))} cannot be set: target and compare say it")
    unknown = settings.keys() - Settings.__dataclass_fields__.keys()
    if unknown:
        raise ValueError(f"there is no setting {', '.join(sorted(unknown))}; see eel_viz.settings.Settings")
    if len(runs) > 1:
        settings["compare"] = names[1]
    if isinstance(target, rr.RecordingStream):
        destination = Given(target, Settings.from_values(settings), warn)
    else:
        chosen = Settings.from_values({**settings, "recording": os.fspath(target)})
        destination = File(chosen, lambda text: None, lambda text: None)  # a file that is there is replaced
    show(runs, [destination], names=names, namespaces=[SPACE] * len(runs), warn=warn)
