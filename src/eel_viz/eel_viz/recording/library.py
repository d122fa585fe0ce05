# SPDX-License-Identifier: Apache-2.0
"""Records a run of the library to Rerun, without ROS. `Run.to_rerun` calls it.

Here a run is a sequence of messages: pairs of a topic and a plain object with the message's fields.
"""

import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import rerun as rr
from eel_common.files.output_file import appeared, written_as
from eel_common.quantity import checked_path

from eel_viz.batched_stream import Rates
from eel_viz.recording.destination import Delivery, Destination, LogFunction
from eel_viz.recording.merged_messages import Messages, record_messages
from eel_viz.recording.recording_file import FileDestination
from eel_viz.settings import Settings

NAMESPACE = ""  # namespace of a run of the library


class CallerStream(Destination):
    """A stream that the caller owns; it stays open."""

    def __init__(self, stream: rr.RecordingStream, settings: Settings, log_warning: LogFunction) -> None:
        rates = Rates(numbers=0.0, drawings=settings.skin_rate, tick=float("inf"))
        super().__init__(settings, rates, lambda text: None, log_warning, live=False)
        self._stream = stream

    def open(self, number: int, name: str) -> Delivery:
        self._stream.send_blueprint(self.blueprint())
        self.describe(self._stream, name)
        return Delivery(self, self._stream)


def to_rerun(
    target: str | os.PathLike[str] | rr.RecordingStream,
    runs: Sequence[Messages],
    names: Sequence[str],
    properties: dict[str, dict[str, Any]] | None = None,
    **settings: Any,
) -> None:
    """Record one run, or two for comparison, to `target`: a stream, or a file, which is replaced if it exists.

    properties: of the recording, numbers and texts by group and name. settings: those of the visualiser, such as
    blueprint or skin_rate. Data that cannot be shown cause a warning.
    `ValueError` for a bad setting; `OSError` if the file cannot be completed, and an older file then stays.
    """

    def log_warning(text: str) -> None:
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
        destination: Destination = CallerStream(target, Settings.among(settings), log_warning)
    else:
        chosen = Settings.among({**settings, "recording": str(checked_path("target", target))})
        destination = FileDestination(
            chosen, lambda text: None, lambda text: None
        )  # no warning that the file is replaced
    destination.properties = properties or {}
    record_messages(runs, [destination], names=names, namespaces=[NAMESPACE] * len(runs), log_warning=log_warning)
    if not isinstance(target, rr.RecordingStream) and written_as(target) != Path(target):
        log_warning(appeared(Path(target), written_as(target)))
