"""For the tests of the dynamics node: a client that hears it."""

import pytest


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
