"""A ROS domain that no other program on this machine uses, so that runs side by side do not hear each other."""

import os
import random
import socket
from dataclasses import dataclass

DOMAINS = range(60, 100)  # above 101 the ports meet Linux's own range for outgoing connections
PORT_BASE, PORTS_PER_DOMAIN = 7400, 250  # of the RTPS standard: discovery listens on UDP 7400 + 250 * domain


@dataclass(frozen=True)
class Domain:
    """A domain id [-], kept from other callers of `reserve_domain` for as long as this object lives."""

    number: int
    claim: socket.socket

    def environment(self) -> dict[str, str]:
        """This process's environment variables, with the domain and nothing heard from other machines."""
        kept = {name: value for name, value in os.environ.items() if name != "ROS_LOCALHOST_ONLY"}
        return kept | {"ROS_DOMAIN_ID": str(self.number), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def reserve_domain() -> Domain:
    """Find a domain whose discovery port nobody listens on, and claim it by the TCP port of the same number."""
    for number in random.sample(DOMAINS, len(DOMAINS)):
        port = PORT_BASE + PORTS_PER_DOMAIN * number
        claim = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            claim.bind(("127.0.0.1", port))
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.bind(("0.0.0.0", port))
        except OSError:
            claim.close()
            continue
        return Domain(number, claim)
    raise RuntimeError(f"every ROS domain from {DOMAINS.start} to {DOMAINS.stop - 1} is in use on this machine")
