# SPDX-License-Identifier: Apache-2.0
"""The package's own files, as a release needs them."""

from pathlib import Path

from eel_common.ros.testing.release import check_manifest, sources_without_licence

PACKAGE = Path(__file__).resolve().parents[1]


def test_every_source_file_names_its_licence():
    assert sources_without_licence(PACKAGE) == []


def test_the_manifest_follows_its_schema():
    check_manifest(PACKAGE)
