# SPDX-License-Identifier: Apache-2.0
"""For the tests of the mechanics, `measured`; for those of the dynamics node, a client that subscribes to it."""

import pytest
from validation import KEPT, Checks

CHECKS = Checks()
collect_ignore = [] if KEPT.is_file() else ["test_validation_file.py"]  # a package alone has no file


@pytest.fixture(scope="session")
def measured():
    """measured(what, value, tolerance, wanted=None, unit=""): asserts, and records for docs/appendix/validation.csv."""
    return CHECKS.measure


@pytest.fixture(scope="session")
def checks():
    """What has been measured in this session so far."""
    return CHECKS


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: item.path.name == "test_validation_file.py")  # after all that it looks at


def pytest_runtest_setup(item):
    CHECKS.begin(item)


def pytest_sessionfinish(session):
    if CHECKS.by_name:
        CHECKS.save()


def pytest_terminal_summary(terminalreporter):
    if CHECKS.by_name:
        terminalreporter.section("identities: worst measured value (tolerance)")
        for line in CHECKS.lines():
            terminalreporter.write_line(line)


@pytest.fixture
def client(fresh_domain):
    """client(...) -> SwimClient in the test's own domain; closed when the test ends."""
    from swim_client import SwimClient

    opened = []

    def open_client(**options):
        opened.append(SwimClient(domain=fresh_domain, **options))
        return opened[-1]

    yield open_client
    for each in opened:
        each.close()
