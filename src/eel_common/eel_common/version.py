# SPDX-License-Identifier: Apache-2.0
"""Version and commit of the simulator: the one source for `eel --version`, saved runs, bags and recordings.

package.xml of each package and CITATION.cff repeat the version, as their tools ask; a test compares them.
"""

import subprocess
from functools import cache
from pathlib import Path

VERSION = "0.1.0"
ARCHIVED = "$Format:%h$"  # `git archive` writes the commit here, also for wheels
UNKNOWN = "unknown commit"


def software() -> str:
    """Name, version and commit, as files have them: "eel-swimmer 0.1.0 (28d30b1c)"."""
    return f"eel-swimmer {VERSION} ({commit()})"


@cache
def commit() -> str:
    """The commit that is running: that of the archive, or of the checkout, "-dirty" where its files have changed.
    `UNKNOWN` in a copy of the sources without either.
    """
    if not ARCHIVED.startswith("$"):
        return ARCHIVED
    root = Path(__file__).resolve().parents[3]
    if not (root / ".git").exists():  # or git would tell of a repository in which an environment happens to lie
        return UNKNOWN
    describe = ["git", "-C", str(root), "describe", "--always", "--dirty", "--exclude=*"]
    try:
        return subprocess.run(describe, capture_output=True, text=True, check=True, timeout=10).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return UNKNOWN
