# SPDX-License-Identifier: Apache-2.0
"""Checks of a package's own files: a licence line in every source, and a manifest that follows its schema.

`ament_copyright` does not know SPDX lines. `sources_without_licence` replaces it.
"""

from pathlib import Path

import pytest

LICENCE = "SPDX-License-Identifier: Apache-2.0"
SOURCES = (".py", ".pyi", ".hpp", ".cpp", ".cmake")


def sources_without_licence(package: Path) -> list[Path]:
    """The source files of a `package` without a licence in their first two lines."""
    sources = [path for path in package.rglob("*") if path.suffix in SOURCES]
    assert sources, f"no sources in {package}"
    return [path for path in sources if LICENCE not in "".join(path.read_text().splitlines()[:2])]


def check_manifest(package: Path) -> None:
    """Compare package.xml in the folder of a `package` with its schema; skipped where there is no `ament_xmllint`."""
    xmllint = pytest.importorskip("ament_xmllint.main", reason="no ament_xmllint: it comes with ROS from apt alone")
    assert xmllint.main([str(package / "package.xml")]) == 0
