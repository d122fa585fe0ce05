# SPDX-License-Identifier: Apache-2.0
"""Writes pictures to files (.png, .svg, .pdf). The same picture gives the same file each time: it holds no date."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from eel_base.files.output_file import replacing

from eel_studies.pictures.style import SETTINGS, Figure

METADATA = {".png": {"Software": None}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}  # None: left out


def write_picture(
    draw: Callable[[Figure], object], size: tuple[float, float], *paths: Path, settings: dict[str, Any] | None = None
) -> None:
    """Draw with `draw(figure)` into an empty matplotlib figure, and write it to each of the `paths`.

    size: width and height [inches]. The suffix of a path gives the format. settings: of matplotlib, in place of those
    in `SETTINGS`. `ImportError` without matplotlib; `NotWritten` where a file cannot be completed.
    """
    import matplotlib  # here: it takes longer to import than all the rest
    from matplotlib.figure import Figure as NewFigure

    chosen: Any = SETTINGS | (settings or {})
    with matplotlib.rc_context(chosen):
        figure = NewFigure(figsize=size, layout="constrained")
        draw(figure)
        for path in paths:
            with replacing(path) as draft:
                figure.savefig(draft, format=path.suffix[1:], metadata=METADATA[path.suffix])
