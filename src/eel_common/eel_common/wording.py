# SPDX-License-Identifier: Apache-2.0
"""How messages show a value or an error: short, in one line, safe on every terminal."""

import re
import reprlib
from collections.abc import Iterable
from difflib import get_close_matches
from importlib.metadata import PackageNotFoundError, version
from typing import Any

LONGEST = 80  # characters of a shown value
LONGEST_LINE = 300  # of a whole message
_LONG_WORD = re.compile(rf"\S{{{LONGEST + 3},}}")  # longer than any `shown` value with its comma or colon
_brief = reprlib.Repr()
_brief.maxstring = _brief.maxother = LONGEST
_brief.maxlevel = 3
_brief.maxlist = _brief.maxtuple = 8


class WorkStopped(RuntimeError):
    """Work that cannot go on, though its input was valid. `exit_status`: that of a command ended by it."""

    exit_status = 3


def bring_viz() -> str:
    """What brings the packages that eel_viz needs. Of an installed eel-swimmer pip fetches those of the extra alone."""
    try:
        version("eel-swimmer")
    except PackageNotFoundError:
        return "pip install -r requirements.txt (of this project) brings it"
    return "pip install 'eel-swimmer[viz]' brings it"


def shown(value: Any) -> str:
    """`value` as Python writes it, in one line of at most `LONGEST` characters.

    A longer text loses its middle.
    """
    if hasattr(value, "typecode"):  # an array of a ROS message
        value = list(value[:LONGEST])
    try:
        text = _brief.repr(value)
    except ValueError:  # an int of thousands of digits, which Python does not write
        text = f"an int of {value.bit_length()} bits" if isinstance(value, int) else type(value).__name__
    return _shortened(" ".join(text.split()))


def one_line(error: object) -> str:
    """The text of `error` in one line of at most `LONGEST_LINE` characters. Non-printing ones are escaped.

    Long words, and a long line, lose their middle.
    """
    if isinstance(error, OSError) and error.strerror:
        error = error.strerror if error.filename is None else f"{error.strerror}: {shown(error.filename)}"
    line = _LONG_WORD.sub(lambda word: _shortened(word[0]), " ".join(str(error).split()))
    if not line.isprintable():
        line = "".join(each if each.isprintable() else ascii(each)[1:-1] for each in line)
    return _shortened(line, LONGEST_LINE)


def did_you_mean(name: str, known: Iterable[str], alike: float = 0.6) -> str:
    """The `known` name most like `name`, as a question in brackets. Empty if none is `alike`, from 0 to 1."""
    found = get_close_matches(str(name), known, n=1, cutoff=alike)
    return f" (did you mean {found[0]!r}?)" if found else ""


def not_one_of(name: str, value: Any, known: Iterable[str]) -> str:
    """The text of an error: the `value` of `name` is not among those `known`."""
    names = list(known)
    hint = did_you_mean(value, names) if isinstance(value, str) else ""
    return f"{name} must be one of {', '.join(names)}, got {shown(value)}{hint}"


def _shortened(text: str, longest: int = LONGEST) -> str:
    if len(text) <= longest:
        return text
    half = (longest - 3) // 2
    return f"{text[:half]}...{text[-half:]}"
