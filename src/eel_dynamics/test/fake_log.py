# SPDX-License-Identifier: Apache-2.0
"""A logger that keeps its lines."""


class Log:
    """Attribute lines: (level, text) of each line, in order."""

    def __init__(self):
        self.lines = []

    def info(self, text):
        self.lines.append(("info", text))

    def warning(self, text):
        self.lines.append(("warning", text))

    def error(self, text):
        self.lines.append(("error", text))
