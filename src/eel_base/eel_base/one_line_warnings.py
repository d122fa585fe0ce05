# SPDX-License-Identifier: Apache-2.0
"""Prints the warnings of a command: one line each on stderr, without the place in the sources."""

import contextlib
import warnings
from collections.abc import Iterator
from typing import Any

from eel_base.command_line import complain


@contextlib.contextmanager
def one_line_warnings(name: str) -> Iterator[None]:
    """Print each warning as "NAME: warning: ..."."""

    def show(message: Warning | str, category: type[Warning], *place: Any, **written: Any) -> None:
        complain(name, f"warning: {message}")

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield
