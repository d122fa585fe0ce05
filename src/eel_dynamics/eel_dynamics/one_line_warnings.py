"""Warnings of a command: one line each on stderr, without the place in the sources."""

import contextlib
import sys
import warnings
from collections.abc import Iterator


@contextlib.contextmanager
def one_line_warnings(name: str) -> Iterator[None]:
    """Print each warning as "NAME: warning: ..."."""

    def show(message, category, *place):
        print(f"{name}: warning: {' '.join(str(message).split())}", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield
