# SPDX-License-Identifier: Apache-2.0
"""A table of texts: aligned for a terminal, in Markdown, or as a .csv file."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from eel_base.files import markdown
from eel_base.files.output_file import replacing


@dataclass(frozen=True)
class Table:
    """Rows of cells below a head. left: the columns that are aligned to the left, in `text`."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: Sequence[int] = (0,)

    def text(self) -> str:
        """The table as lines of aligned text."""
        lines = (self.head, *self.rows)
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        return "\n".join("  ".join(self._aligned(line, widths)).rstrip() for line in lines)

    def markdown(self) -> str:
        """The table in Markdown."""
        return markdown.table(self.head, self.rows)

    def write_csv(self, path: Path) -> None:
        """Write the table to `path`. `NotWritten` where it cannot be completed."""
        with replacing(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows((self.head, *self.rows))

    def _aligned(self, line: Sequence[str], widths: list[int]) -> list[str]:
        pairs = enumerate(zip(line, widths, strict=True))
        return [cell.ljust(width) if place in self.left else cell.rjust(width) for place, (cell, width) in pairs]
