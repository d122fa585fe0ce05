# SPDX-License-Identifier: Apache-2.0
"""The output of a study's command: pictures, tables, and the parts of a page that it rewrites."""

import argparse
import csv
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from eel_common.command.command import checked_out
from eel_common.command.command_line import Parser
from eel_common.files import markdown
from eel_common.files.output_file import check_output, replacing, written_as
from eel_dynamics.runs.storage.tables import needed

from eel_studies.pictures import PICTURES, Draw, write_picture

NEW = "<!-- {name}: written by `{command}` -->\n<!-- end of {name} -->\n\n"  # a missing part of a page


def add_output_options(parser: Parser) -> None:
    """Add the options of `Outputs` to the `parser` of a command."""
    parser.add_argument("-o", "--out", default="out", metavar="FOLDER", help="where pictures go (out)")
    parser.add_argument("--page", metavar="FILE.md", help="page whose parts are written anew, or a new one")


class Table(NamedTuple):
    """Rows of texts below a head. left: the columns that `text` aligns to the left."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: Sequence[int] = (0,)

    def text(self) -> str:
        """The table as lines of aligned text."""
        aligned = []
        for place, column in enumerate(zip(self.head, *self.rows, strict=True)):
            width = max(map(len, column))
            aligned.append([cell.ljust(width) if place in self.left else cell.rjust(width) for cell in column])
        return "\n".join("  ".join(line).rstrip() for line in zip(*aligned, strict=True))

    def markdown(self) -> str:
        """The table in Markdown."""
        return markdown.table(self.head, self.rows)

    def write_csv(self, path: Path) -> None:
        """Write the table to `path`. `NotWritten` if it cannot be completed."""
        with replacing(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows((self.head, *self.rows))


def checked_outs(command: str, options: argparse.Namespace) -> list[Path]:
    """The files of --out of a `command`: tables (.csv) and `PICTURES`. `ValueError` for other suffixes."""
    return [checked_out(command, out, (*PICTURES, ".csv")) for out in options.out]


def write_files(paths: list[Path], table: Callable[[Path], object], draw: Draw, size: tuple[float, float]) -> None:
    """Write each of the `paths` and report it: a .csv by table(path), a picture of `size` [inches] by draw(figure)."""
    for path in paths:
        table(path) if path.suffix == ".csv" else write_picture(draw, size, path)
        print(f"written to {written_as(path)}")


class Outputs:
    """The pictures and the page of a `command`, from its `options`. It reports each file that it writes.

    parts: names of the parts that an existing page must have. Errors are raised before any work: `ValueError` if a page
    cannot be written or lacks a part; `OSError` if it cannot be read, or the folder not made; `ImportError` without
    matplotlib.
    """

    def __init__(self, command: str, options: argparse.Namespace, parts: Iterable[str] = ()):
        needed("matplotlib", command)
        self._command, self._parts, self.folder = command, tuple(parts), Path(options.out)
        self.page = Path(options.page) if options.page else None
        if self.page:
            check_output("--page", self.page)
            if self.page.exists():
                text = self.page.read_text(encoding="utf-8")
                for name in self._parts:
                    markdown.with_part(text, name, "")
        self.folder.mkdir(exist_ok=True)

    def draw(
        self,
        name: str,
        title: str,
        draw: Draw,
        size: tuple[float, float],
        suffixes: tuple[str, ...] = ("png", "svg"),
        settings: dict[str, Any] | None = None,
    ) -> str:
        """Draw with `draw(figure)` of `size` [inches] into the folder. Returns the picture's link in the page.

        name: of the file. A file is written for each of the `suffixes`; the page links the last. settings:
        matplotlib's.
        """
        paths = [self.folder / f"{name}.{suffix}" for suffix in suffixes]
        write_picture(draw, size, *paths, settings=settings)
        for path in paths:
            print(f"written to {written_as(path)}")
        return f"![{title}]({os.path.relpath(paths[-1], self.page.parent if self.page else '.')})"

    def write_table(self, name: str, table: Table) -> None:
        """Write the `table` that the page summarises to `name`.csv beside the page. Without a page, do nothing."""
        if self.page:
            path = self.page.with_name(f"{name}.csv")
            table.write_csv(path)
            print(f"written to {written_as(path)}")

    def write(self, parts: dict[str, str], values: dict[str, str] | None = None) -> None:
        """Write the `parts` of the page, and the `values` inside its sentences, by name.

        A new page has only the parts. Without a page, nothing is written. `NotWritten` if it cannot be completed.
        """
        page = self.page
        if page is None:
            return
        names = list(dict.fromkeys([*self._parts, *parts]))
        if page.exists():
            text = page.read_text(encoding="utf-8")
        else:
            text, values = "".join(NEW.format(name=name, command=self._command) for name in names), None
        for name, value in (parts | (values or {})).items():
            text = markdown.with_part(text, name, value)
        markdown.write_page(page, text)
        print(f"written to {written_as(page)}")
