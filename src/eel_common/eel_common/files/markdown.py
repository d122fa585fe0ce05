# SPDX-License-Identifier: Apache-2.0
"""Pages in Markdown: tables, and parts between marker lines that a command writes.

A part stands between the lines `<!-- NAME: written by ... -->` and `<!-- end of NAME -->`. A value inside a sentence
stands between `<!--NAME-->` and `<!--/-->`, and may occur several times.
"""

import os
import re
from collections.abc import Iterable, Sequence

from eel_common.files.output_file import replacing


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table of these cells."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def with_part(page: str, name: str, text: str) -> str:
    """The `page` with its part or value `name` replaced by `text`. `ValueError` where the marks are missing."""
    mark = re.escape(name)
    first, last = rf"<!-- {mark}: written by [^\n]* -->\n", f"<!-- end of {name} -->"
    found = re.search(f"({first}).*?(?={re.escape(last)})", page, re.DOTALL)
    if found:
        return f"{page[: found.start()]}{found[1]}{text}\n{page[found.end() :]}"
    written, count = re.subn(rf"(<!--{mark}-->)[^\n]*?(?=<!--/-->)", lambda value: value[1] + text, page)
    if not count:
        raise ValueError(f"the page must have the lines '<!-- {name}: written by ... -->' and {last!r}")
    return written


def write_page(path: str | os.PathLike[str], text: str) -> None:
    """Write the page `text` to `path`. An older page stays until the new one is complete (`NotWritten`)."""
    with replacing(path) as draft:
        draft.write_text(text, encoding="utf-8")
