# SPDX-License-Identifier: Apache-2.0
"""The trade-off as a Rerun recording: the runs on the fronts in time, the settings as points, the tables as text."""

import contextlib
import warnings
from pathlib import Path

import numpy as np
from eel_base.files.output_file import replacing
from eel_dynamics.accuracy.accuracy import PRESETS

from eel_studies.tradeoff.models import Model
from eel_studies.tradeoff.table import marks_of, model_table, trade_table

GREY, BLACK = (136, 136, 136), (0, 0, 0)
COLOURS = {"adams": (0, 114, 178), "dormand_prince": (0, 158, 115), "classical": (213, 94, 0)}


def stream(path: Path, found: list[tuple]):
    """Write `found`, pairs of a trade and its models, to `path` (.rrd). The timeline `time` is that of the runs [s].

    `OSError` where the file is not complete.
    """
    import rerun

    with replacing(path) as draft:
        _write(rerun, draft, found)


def _write(rerun, path: Path, found: list[tuple]):
    recording = rerun.RecordingStream("eel_tradeoff")
    recording.save(path)
    for trade, models in found:
        name = trade.law.name
        _log_points(rerun, recording, name, trade)
        text = f"{trade_table(trade, markdown=True)}\n\n{model_table(models, trade, markdown=True)}\n"
        recording.log([name, "table"], rerun.TextDocument(text, media_type="text/markdown"), static=True)
        _log_run(rerun, recording, [name, "runs", "converged"], trade.reference, BLACK)
        marks = marks_of(trade)
        for row in trade.rows:
            if marks[id(row)] or row.accuracy.name in PRESETS:
                colour = COLOURS[row.accuracy.method]
                _log_run(rerun, recording, [name, "runs", row.accuracy.name], row.run, colour)
                _log_error(rerun, recording, [name, "error", row.accuracy.name], row.run, trade.reference)
        for model in models:
            if model.run is not None:
                _log_run(rerun, recording, [name, "models", model.name], model.run, GREY)
                _log_error(rerun, recording, [name, "error", model.name], model.run, trade.reference)
    with contextlib.suppress(RuntimeError):  # `_check_complete` reports it
        recording.flush()
    recording.disconnect()
    _check_complete(path)


def _check_complete(path: Path):
    """`OSError` for an incomplete file, which rerun only logs."""
    from rerun.chunk import RrdReader

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            RrdReader(str(path))
        except (Warning, ValueError) as error:
            raise OSError("the disk is full, or the file as large as it may be") from error


def _log_points(rerun, recording, name: str, trade):
    """Log points of decadic logarithms: times real time to the right, the greater error downwards."""
    for method, colour in COLOURS.items():
        rows = [row for row in trade.rows if row.accuracy.method == method]
        places = [(np.log10(row.times_real_time), -np.log10(max(row.error, 1e-16))) for row in rows]
        points = rerun.Points2D(places, radii=0.02, colors=colour, labels=[row.accuracy.name for row in rows])
        recording.log([name, "trade", method], points, static=True)


def _log_run(rerun, recording, entity: list[str], run, colour):
    count = len(run.time)
    recording.log(entity, rerun.LineStrips3D.from_fields(colors=colour, radii=0.004), static=True)
    recording.send_columns(
        rerun.new_entity_path(entity),
        indexes=[rerun.TimeColumn("time", duration=run.time)],
        columns=rerun.LineStrips3D.columns(strips=list(run.backbone.astype(np.float32))).partition(
            np.ones(count, dtype=int)
        ),
    )


def _log_error(rerun, recording, entity: list[str], run, reference):
    """Log the distance [m] of the head from that of the `reference` run, over time."""
    distance = np.linalg.norm(run.position - reference.position, axis=1)
    recording.send_columns(
        rerun.new_entity_path(entity),
        indexes=[rerun.TimeColumn("time", duration=run.time)],
        columns=rerun.Scalars.columns(scalars=distance),
    )


__all__ = ["Model", "stream"]
