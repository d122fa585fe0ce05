# SPDX-License-Identifier: Apache-2.0
"""The error of a work that cannot go on."""


class WorkStopped(RuntimeError):
    """A work that cannot go on, though its input was good. `exit_status`: of a command that ends by it."""

    exit_status = 3
