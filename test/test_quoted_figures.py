# SPDX-License-Identifier: Apache-2.0
"""Figures that README.md and docs quote are the newest report's: `make quotes` writes them, `make lint` checks them."""

import pytest
import quoted_figures

REPORT = """# A day
```
falling: 10 s of the falling gait.
  motion alone, target 0.01      {speed} times real time, error 1.7e-03, {count} evaluations
other: Something else.
  a thing                        1.5 us
```
"""


@pytest.fixture
def reports(tmp_path, monkeypatch):
    """A folder of two reports, of which the newer lacks one of the figures."""
    monkeypatch.setattr(quoted_figures, "ROOT", tmp_path)
    monkeypatch.setattr(quoted_figures, "REPORTS", tmp_path)
    (tmp_path / "2026-01-01.txt").write_text(REPORT.format(speed="2e+04", count=350))
    (tmp_path / "2026-02-01.txt").write_text(REPORT.format(speed="3e+04", count=340).partition("other")[0])
    return tmp_path


def test_a_figure_comes_from_the_newest_report_that_has_it(reports):
    assert quoted_figures.Report("falling").value("motion alone, target 0.01") == 3e4
    assert quoted_figures.Report("other").value("a thing") == 1.5


def test_a_figure_that_no_report_has_is_named_with_the_command_that_measures_it(reports):
    with pytest.raises(ValueError, match="figure wrench: make bench ARGS=wrench"):
        quoted_figures.Report("wrench")
    with pytest.raises(ValueError, match=r"2026-02-01.txt has no line 'motion alone, target 0.1' under falling"):
        quoted_figures.Report("falling").value("motion alone, target 0.1")


def test_a_stale_figure_is_found_and_written_anew(reports, monkeypatch):
    page = reports / "README.md"
    page.write_text("# A\n<!-- speed: written by `make quotes` -->\n350 evaluations\n<!-- end of speed -->\nrest\n")
    monkeypatch.setattr(quoted_figures, "BLOCKS", {"README.md": {"speed": lambda: "340 evaluations"}})
    assert quoted_figures.complaints() == ["README.md: a figure is stale, `make quotes` writes it"]
    quoted_figures.main([])
    assert "\n340 evaluations\n" in page.read_text() and "rest" in page.read_text()
    assert quoted_figures.complaints() == []


@pytest.mark.parametrize(
    "line",
    [
        "It takes 1.4 us.",
        "some 552 evaluations",
        "4500 times real time",
        "50 to 190 times more",
        "off by 2.7e-7",
        "13 % of a core",
    ],
)
def test_a_figure_written_by_hand_is_found(line):
    assert quoted_figures.quoted_by_hand(f"# A\n{line}\n") == [f"2: {line}"]
    assert quoted_figures.quoted_by_hand(f"<!-- a: written by `b` -->\n{line}\n<!-- end of a -->\n") == []


def test_a_target_is_no_measured_figure():
    assert quoted_figures.quoted_by_hand("a target of 1e-4, `accuracy=1e-6`, 10 s at 100 Hz\n") == []


def test_the_pages_are_as_the_reports_are():
    assert quoted_figures.complaints() == []
