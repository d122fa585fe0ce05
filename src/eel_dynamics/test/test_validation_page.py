# SPDX-License-Identifier: Apache-2.0
"""docs/appendix/validation.md is what the tests measure: `make validation` writes it anew."""

import re

from validation import PAGE, ROOT

STALE = "docs/appendix/validation.md is stale: make validation"


def rows():
    """(identity, what, tolerance, test) of each line of the page."""
    identity, found = None, []
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            identity = line[3:]
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 5 and cells[4].startswith("`test_"):
            found.append((identity, cells[0], cells[2], cells[4].strip("`")))
    return found


def test_every_check_of_this_session_is_on_the_page(checks):
    written = set(rows())
    for check in checks.by_name.values():
        assert (check.identity, check.what, check.allowed, check.test) in written, STALE


def test_every_line_of_the_page_is_a_test_that_measures_it(checks, request):
    """Of the tests that ran in this session, and wrote something; of the others, that they exist."""
    measured = {(check.identity, check.what) for check in checks.by_name.values()}
    ran = {check.test for check in checks.by_name.values()}
    alone = {item.name for item in request.session.items}
    found = rows()
    assert len(found) > 40
    for identity, what, _, test in found:
        file, name = test.split("::")
        source = (ROOT / "src/eel_dynamics/test" / file).read_text()
        assert re.search(rf"^def {name}\(", source, re.MULTILINE), (test, STALE)
        if test in ran and not any(item.startswith(f"{name}[") for item in alone):  # a parametrised one may run in part
            assert (identity, what) in measured, (what, STALE)
