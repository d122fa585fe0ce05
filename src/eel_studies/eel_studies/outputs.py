# SPDX-License-Identifier: Apache-2.0
"""What the command of a study leaves behind: pictures, tables, and the parts of a page that it writes anew."""

import argparse
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from eel_base.command.command_line import Parser
from eel_base.files.markdown import with_part, write_page
from eel_base.files.output_file import check_output, written_as
from eel_dynamics.runs.storage.tables import needed

from eel_studies.pictures import write_picture
from eel_studies.table import Table

NEW = "<!-- {name}: written by `{command}` -->\n<!-- end of {name} -->\n\n"  # a part of a page that there is not yet


def add_output_options(parser: Parser, folder: str = "out") -> None:
    """Add the options of `Outputs` to the `parser` of a command. folder: where pictures go by default."""
    parser.add_argument("-o", "--out", default=folder, metavar="FOLDER", help=f"where pictures go ({folder})")
    parser.add_argument("--page", metavar="FILE.md", help="page whose parts are written anew, or a new one")


def write_files(paths: list[Path], csv: Callable[[Path], object], draw: Callable[[Path], object]) -> None:
    """Write each of the `paths` by csv(path) or draw(path), as its suffix says, and tell so."""
    for path in paths:
        (csv if path.suffix == ".csv" else draw)(path)
        print(f"written to {written_as(path)}")


class Outputs:
    """The pictures and the page of a `command`, by its `options`; each is told when it is written.

    parts: names of the parts that the page must have, unless it is new. Before all work, `ValueError`: a page cannot be
    written, or lacks a part; `OSError`: it cannot be read, or the folder not be made; `ImportError`: no matplotlib.
    """

    def __init__(self, command: str, options: argparse.Namespace, parts: Iterable[str] = ()):
        needed("matplotlib", command, "eel_studies[pictures]")
        self._command, self._parts, self.folder = command, tuple(parts), Path(options.out)
        self.page = Path(options.page) if options.page else None
        if self.page:
            check_output("--page", self.page)
            if self.page.exists():
                text = self.page.read_text(encoding="utf-8")
                for name in self._parts:
                    with_part(text, name, "")
        self.folder.mkdir(exist_ok=True)

    def draw(
        self,
        name: str,
        title: str,
        draw: Callable[[Any], object],
        size: tuple[float, float],
        suffixes: tuple[str, ...] = ("png", "svg"),
        settings: dict[str, Any] | None = None,
    ) -> str:
        """Draw with `draw(figure)` of `size` [inches] into the folder; returns the picture as the page links it.

        name: of the file, which ends in each of the `suffixes`; the page links the last one. settings: of matplotlib.
        """
        paths = [self.folder / f"{name}.{suffix}" for suffix in suffixes]
        write_picture(draw, size, *paths, settings=settings)
        for path in paths:
            print(f"written to {written_as(path)}")
        return f"![{title}]({os.path.relpath(paths[-1], self.page.parent if self.page else '.')})"

    def write_table(self, name: str, table: Table) -> None:
        """Write the `table` that the page summarises beside it, as `name`.csv. Without a page, nothing is written."""
        if self.page:
            path = self.page.with_name(f"{name}.csv")
            table.write_csv(path)
            print(f"written to {written_as(path)}")

    def write(self, parts: dict[str, str], values: dict[str, str] | None = None) -> None:
        """Write the `parts` of the page, and the `values` within its sentences, by name.

        A new page has the parts alone. Without a page, nothing is written. `NotWritten`: it cannot be completed.
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
            text = with_part(text, name, value)
        write_page(page, text)
        print(f"written to {written_as(page)}")
