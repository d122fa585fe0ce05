# SPDX-License-Identifier: Apache-2.0
"""Reads an XML file into elements that know their lines. Size, levels and elements are bounded.

A document type, and with it every entity definition, is refused.
"""

import os
from typing import Any
from xml.parsers import expat

from eel_common.files.input_file import InputFile, Misplaced

MOST_BYTES, MOST_ELEMENTS, DEEPEST = 2_000_000, 20_000, 64


class Element:
    """An element of the file: `tag`, `attributes`, `children`, `text`, and the `line` where it begins."""

    def __init__(self, tag: str, attributes: dict[str, str], line: int) -> None:
        self.tag, self.attributes, self.line = tag, attributes, line
        self.children: list[Element] = []
        self.text = ""

    def all(self, tag: str) -> list["Element"]:
        """The children of this `tag`."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> "Element | None":
        """The first child of this `tag`, if there is one."""
        return next(iter(self.all(tag)), None)


def read_xml(path: str | os.PathLike[str]) -> Element:
    """The root of an XML file. `Misplaced` for invalid XML, or beyond the bounds; otherwise `ValueError`, `OSError`."""
    with InputFile(path, MOST_BYTES) as file:
        return from_xml(file.read())


def from_xml(text: bytes | str) -> Element:
    """The root of an XML `text`. Errors as in `read_xml`."""
    parser = expat.ParserCreate()
    top = Element("", {}, 0)
    above, count = [top], 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if count > MOST_ELEMENTS or len(above) > DEEPEST:
            rule = "too many levels" if len(above) > DEEPEST else f"more than {MOST_ELEMENTS} elements"
            raise Misplaced(f"line {parser.CurrentLineNumber}", rule)
        element = Element(tag, attributes, parser.CurrentLineNumber)
        above[-1].children.append(element)
        above.append(element)

    def characters(text: str) -> None:
        above[-1].text += text

    def refuse(*_: Any) -> None:
        raise Misplaced(f"line {parser.CurrentLineNumber}", "a document type is not read")

    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = start, lambda tag: above.pop()
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = characters, refuse
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise Misplaced(f"line {error.lineno}", expat.errors.messages[error.code]) from None
    return top.children[0]
