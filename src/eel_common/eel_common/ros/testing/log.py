# SPDX-License-Identifier: Apache-2.0
"""A logger that keeps its lines."""


class Log:
    """Attribute lines: (level, text) of each line, in order."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, str]] = []

    def info(self, message: str) -> None:
        self.lines.append(("info", message))

    def warning(self, message: str) -> None:
        self.lines.append(("warning", message))

    def error(self, message: str) -> None:
        self.lines.append(("error", message))
