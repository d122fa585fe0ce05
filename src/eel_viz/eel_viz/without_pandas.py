# SPDX-License-Identifier: Apache-2.0
"""Keeps pyarrow from importing pandas, in a command that writes recordings.

pyarrow, through which Rerun takes its data, looks for pandas once, at its first array, and does without where it is not
installed. The import takes more than half of the start of the visualiser, which has no pandas objects.
"""

import sys

import pyarrow as pa


def keep_pandas_out() -> None:
    """Let pyarrow find no pandas. For a command's `main`: a library must leave pyarrow as its user wants it."""
    sys.meta_path.insert(0, NotFound)
    pa.array([0])
    sys.meta_path.remove(NotFound)


class NotFound:
    """A finder of modules, to which pandas is not installed."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> None:
        """Leave all other modules to the next finder."""
        if name == "pandas":
            raise ModuleNotFoundError("pandas is left out")
