# SPDX-License-Identifier: Apache-2.0
"""docs/appendix/validation.csv is what the tests measure: `make validation` writes it anew."""

import re

from validation import ROOT, kept

STALE = "docs/appendix/validation.csv is stale: make validation"


def test_every_check_of_this_session_is_in_the_file(checks):
    written = {(row["identity"], row["compared"], row["tolerance"], row["test"]) for row in kept()}
    for check in checks.by_name.values():
        assert (check.identity, check.what, check.allowed, check.test) in written, STALE


def test_every_line_of_the_file_is_a_test_that_measures_it(checks, request):
    """Of the tests that ran in this session, and wrote something; of the others, that they exist."""
    measured = {(check.identity, check.what) for check in checks.by_name.values()}
    ran = {check.test for check in checks.by_name.values()}
    alone = {item.name for item in request.session.items}
    assert len(kept()) > 40
    for row in kept():
        test = row["test"]
        file, name = test.split("::")
        source = (ROOT / "src/eel_dynamics/test" / file).read_text()
        assert re.search(rf"^def {name}\(", source, re.MULTILINE), (test, STALE)
        if test in ran and not any(item.startswith(f"{name}[") for item in alone):  # a parametrised one may run in part
            assert (row["identity"], row["compared"]) in measured, (row["compared"], STALE)
