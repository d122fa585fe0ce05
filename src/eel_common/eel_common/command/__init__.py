# SPDX-License-Identifier: Apache-2.0
"""The command line: its parser, one line per error, exit status, progress, and the command `eel`."""
