# SPDX-License-Identifier: Apache-2.0
"""out/robustness.md lists what the tests show, docs/appendix/robustness.md has a row for each kind of fault."""

import fault_table
import pytest


def test_the_page_has_a_row_for_each_group_that_tests_show():
    page, shown = fault_table.PAGE.read_text(), {row.group for row in fault_table.faults()}
    assert shown == set(fault_table.GROUPS)
    assert [heading for heading in fault_table.GROUPS.values() if f"- **{heading}**" not in page] == []


def test_every_fault_is_told_once():
    told = [row.fault for row in fault_table.faults()]
    assert len(told) == len(set(told)) and len(told) > 40


def test_a_decorator_that_does_not_fit_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(fault_table, "ROOT", tmp_path)
    path = tmp_path / "test_it.py"
    path.write_text('@pytest.mark.fault("weather", "rain", "wet")\ndef test_rain():\n    pass\n')
    with pytest.raises(ValueError, match=r"test_it.py::test_rain: fault must have a group of laws"):
        fault_table.faults_of(path)
