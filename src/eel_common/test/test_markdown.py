# SPDX-License-Identifier: Apache-2.0
"""Pages: tables, and parts that a command writes between marker lines."""

import pytest
from eel_common.files.markdown import table, with_part

PAGE = (
    "a\n<!-- one: written by `x` -->\nold\n<!-- end of one -->\nb\n<!-- two: written by `x` -->\n<!-- end of two -->\n"
)


def test_a_part_is_replaced_and_the_rest_stays():
    page = with_part(PAGE, "one", "new\n| 1 |")
    assert page == PAGE.replace("old", "new\n| 1 |")
    assert with_part(with_part(page, "two", r"\1"), "two", "") == with_part(page, "two", "")


def test_a_page_without_the_marker_lines_is_refused():
    for page in ("", PAGE.partition("<!-- end")[0], PAGE.replace("one: written", "one written")):
        with pytest.raises(ValueError, match="the page must have the lines '<!-- one: written by"):
            with_part(page, "one", "new")


def test_a_value_is_replaced_wherever_it_stands():
    page = "It grows by <!--growth-->4<!--/--> = <!--growth--><!--/-->, by <!--other-->5<!--/-->.\n"
    bare = page.replace("-->4<", "--><")
    assert with_part(page, "growth", r"\1 m") == bare.replace("growth--><", r"growth-->\1 m<")


def test_a_table_has_a_line_for_its_head_and_each_row():
    assert table(("a", "b"), [("1", "2")]) == "| a | b |\n|---|---|\n| 1 | 2 |"
