# SPDX-License-Identifier: Apache-2.0
"""The entry for untrusted files. Every reader of the suite opens its file here.

`reading` turns every error of a parser into one `ValueError`. `opened` gives a file that stops a parser from reading
past the end. `from_json` reads JSON. `archive`, `tables` and `yaml_tree` build on these.
"""

import contextlib
import io
import json
import os
from collections.abc import Iterator
from typing import Any

from eel_common.quantity import checked_path
from eel_common.wording import one_line

MOST_READS = 10_000  # of one file: a parser needs about 10 for each variable or member
MOST_VALUES = 2_000_000  # in a JSON text: each takes up to 90 bytes of memory
HINTS = {MemoryError: "it needs more memory than there is", RecursionError: "it is nested too deeply"}


class Misplaced(ValueError):
    """An error in a file, with its place in words, such as "line 3"."""

    def __init__(self, place: str, text: str) -> None:
        super().__init__(f"{place}: {text}")


@contextlib.contextmanager
def reading(what: str) -> Iterator[None]:
    """Turn every error within into a one-line `ValueError` that begins with `what`: a file or value in words, or "".

    Code that builds an object from a file, a text or plain values runs within it.
    """
    try:
        yield
    except BaseException as error:  # parsers raise nearly anything for a damaged file; those in Rust panic
        if not isinstance(error, Exception) and type(error).__module__ != "pyo3_runtime":
            raise
        if isinstance(error, Misplaced) and not what:
            raise
        reason = _reason(error)
        if not reason.startswith(what):
            reason = f"{what}{', ' if isinstance(error, Misplaced) else ': '}{reason}"
        raise ValueError(one_line(reason)) from None


class InputFile(io.BufferedReader):
    """The regular file at `path`, opened for reading. `ValueError` or `OSError` where there is none.

    A read past the end, more than `MOST_READS` reads, or more than twice the file's content raise `ValueError`. So a
    parser that trusts a wrong length in the file allocates nothing, and stops.
    """

    def __init__(self, path: str | os.PathLike[str], most: int | None = None) -> None:
        path = checked_path("path", path)
        if not path.is_file():
            kind = "a folder" if path.is_dir() else "no regular file"
            raise ValueError(f"it is {kind}" if path.exists() else "there is no such file")
        super().__init__(io.FileIO(path))
        self.size = os.fstat(self.fileno()).st_size
        self._left, self._reads = 2 * self.size, 0
        if most is not None and self.size > most:
            self.close()
            raise ValueError(f"it must have at most {most} bytes, got {self.size}")

    def read(self, size: int | None = -1) -> bytes:
        """The next `size` bytes; all the rest without a size."""
        rest = self.size - self.tell()
        size = rest if size is None or size < 0 else size
        if size > rest:
            raise ValueError(f"it is truncated or damaged: {size} bytes at {self.tell()} of {self.size}")
        self._left, self._reads = self._left - size, self._reads + 1
        if self._left < 0 or self._reads > MOST_READS:
            raise ValueError("it is damaged: its parts are more than the whole")
        return super().read(size)


def from_json(text: str | bytes, **options: Any) -> Any:
    """The value of a JSON `text`. `ValueError` beyond `MOST_VALUES` values; `RecursionError` if nested too deeply."""
    counts = map(text.count, ",[{") if isinstance(text, str) else map(text.count, b",[{")
    if (count := sum(counts)) > MOST_VALUES:
        raise ValueError(f"its text must hold at most {MOST_VALUES} values, got {count}")
    return json.loads(text, **options)


def number_of(text: str) -> float:
    """The number in a `text`. `ValueError` if it is none; 1_0 is none, though Python accepts it."""
    if "_" in text:
        raise ValueError(f"it must be a number, got {text!r}")
    return float(text)


def is_number(text: str) -> bool:
    """Whether a `text` is a number."""
    try:
        number_of(text)
    except ValueError:
        return False
    return True


def _reason(error: BaseException) -> str:
    hint = next((words for kind, words in HINTS.items() if isinstance(error, kind)), None)
    if hint is not None:
        return hint
    if isinstance(error, UnicodeDecodeError):
        return f"it is no text in {error.encoding}: {error.reason} at byte {error.start}"
    if isinstance(error, (OSError, ValueError)):
        return one_line(error) or type(error).__name__
    what = "does not fit" if isinstance(error, (TypeError, ArithmeticError)) else "is damaged or foreign"
    return f"it {what} ({type(error).__name__}: {one_line(error)})"
