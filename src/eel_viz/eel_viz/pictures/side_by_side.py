# SPDX-License-Identifier: Apache-2.0
"""Draws two recordings at the same simulation times, one picture beside the other."""

import contextlib
import io
import os
from collections.abc import Iterator

from PIL import Image

from eel_viz.pictures.drawing import Drawing, drawn


class SideBySide:
    """Two drawings as one; `start` and `end` [s] bound the simulation times that both have.

    `ValueError` where they have none in common.
    """

    def __init__(self, left: Drawing, right: Drawing) -> None:
        self._both = left, right
        self.start, self.end = max(left.start, right.start), min(left.end, right.end)
        if self.start > self.end:
            raise ValueError(
                "recordings beside one another must have times in common, got "
                f"{left.start:g} to {left.end:g} s and {right.start:g} to {right.end:g} s"
            )

    def png(self, at: float) -> bytes:
        """Both pictures at simulation time `at` [s] as one PNG, twice as wide as either."""
        left, right = (Image.open(io.BytesIO(each.png(at))).convert("RGB") for each in self._both)
        joined, file = Image.new("RGB", (left.width + right.width, left.height)), io.BytesIO()
        joined.paste(left, (0, 0))
        joined.paste(right, (left.width, 0))
        joined.save(file, format="PNG")
        return file.getvalue()


@contextlib.contextmanager
def drawn_beside(
    recording: str | os.PathLike[str], beside: str | os.PathLike[str] | None, **settings
) -> Iterator[Drawing | SideBySide]:
    """Open a `Drawing` of `recording`, with that of `beside` to its right; None: alone. settings: those of `drawn`."""
    with contextlib.ExitStack() as stack:
        drawing = stack.enter_context(drawn(recording, **settings))
        yield drawing if beside is None else SideBySide(drawing, stack.enter_context(drawn(beside, **settings)))
