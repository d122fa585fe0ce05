# SPDX-License-Identifier: Apache-2.0
"""docs/appendix/robustness.md tells what the tests show, and nothing else."""

import fault_table
import pytest


def test_the_page_is_what_the_tests_say():
    page = fault_table.PAGE.read_text()
    assert page == fault_table.with_table(page), "docs/appendix/robustness.md is stale: `make robustness` writes it"


def test_every_fault_is_told_once():
    told = [row.fault for row in fault_table.faults()]
    assert len(told) == len(set(told)) and len(told) > 40


def test_a_decorator_that_does_not_fit_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(fault_table, "ROOT", tmp_path)
    path = tmp_path / "test_it.py"
    path.write_text('@pytest.mark.fault("weather", "rain", "wet")\ndef test_rain():\n    pass\n')
    with pytest.raises(ValueError, match=r"test_it.py::test_rain: fault must have a group of laws"):
        fault_table.faults_of(path)
