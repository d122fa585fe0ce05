# SPDX-License-Identifier: Apache-2.0
"""A ROS domain that no other program on this machine uses, so that parallel test runs do not discover each other."""

import os
import random
import re
import socket
from dataclasses import dataclass
from pathlib import Path

DOMAINS = range(60, 100)  # above 101 the ports overlap Linux's range for outgoing connections
PORT_BASE, PORTS_PER_DOMAIN = 7400, 250  # of the RTPS standard: discovery listens on UDP 7400 + 250 * domain
SHARED_MEMORY = Path("/dev/shm")


@dataclass(frozen=True)
class Domain:
    """A domain id [-], reserved against other callers of `reserve_domain` while this object lives."""

    number: int
    claim: socket.socket

    def environment(self) -> dict[str, str]:
        """This process's environment variables, with the domain and no discovery of other machines."""
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
        forget_the_killed(number)
        return Domain(number, claim)
    raise RuntimeError(f"every ROS domain from {DOMAINS.start} to {DOMAINS.stop - 1} is in use on this machine")


def forget_the_killed(number: int, folder: Path = SHARED_MEMORY) -> None:
    """Remove what ended processes of a domain have left of their ports in shared memory, if none runs any more.

    A killed process leaves them, sometimes locked. Fast DDS then finds the next node in the domain, but sends nothing
    (eProsima/Fast-DDS issues 1144, 5053).
    """
    ports = range(PORT_BASE + PORTS_PER_DOMAIN * number, PORT_BASE + PORTS_PER_DOMAIN * (number + 1))
    for path in folder.glob("*fastrtps_port*"):
        match = re.fullmatch(r"(?:sem\.)?fastrtps_port(\d+)(?:_el|_mutex)?", path.name)
        if match and int(match[1]) in ports:
            try:
                path.unlink(missing_ok=True)
            except PermissionError:  # another user's: left alone
                continue
