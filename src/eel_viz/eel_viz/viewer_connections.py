# SPDX-License-Identifier: Apache-2.0
"""The viewers connected to the server in this process, and which of them is the furthest behind.

Rerun's server keeps 1024 messages for its slowest viewer. Then it waits for that viewer and accepts nothing more: the
others get no data, and new viewers no answer. It neither drops a slow viewer nor names it. But the server's sockets
belong to this process, and Linux counts the bytes through each: a viewer that takes less than comes in falls behind.
"""

import math
import os
import socket
import stat
import struct
import time
from collections.abc import Iterator

COUNTERS = struct.Struct("120xQQ")  # linux/tcp.h, tcp_info: bytes acknowledged by and received from the peer
IDLE = 30_000  # bytes: a connection with less traffic is not judged
BEHIND = 500_000  # bytes: the server waits only for viewers further behind


class ViewerConnections:
    """The connections to the server on `port`. Call `look` regularly."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._counted: dict[tuple[str, int], int] = {}  # peer: bytes received from it at the last look
        self._received = 0  # bytes from all peers, including those that have gone
        self._least: dict[tuple[str, int], int] = {}  # viewer: the least difference of bytes received and given to it
        self._disconnected = -math.inf  # s, steady clock: last disconnection of a viewer

    def look(self) -> dict[tuple[str, int], int]:
        """The bytes by which each viewer is further behind than at best, by its address."""
        given_to, counted = {}, {}
        for peer, connection in self._connections():
            given, received = COUNTERS.unpack_from(connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 256))
            self._received += received - self._counted.get(peer, 0)
            counted[peer] = received
            if given > max(received, IDLE):  # otherwise it is a source
                given_to[peer] = given
        self._counted = counted
        waiting = {peer: self._received - given for peer, given in given_to.items()}
        self._least = {peer: min(count, self._least.get(peer, count)) for peer, count in waiting.items()}
        return {peer: count - self._least[peer] for peer, count in waiting.items()}

    def in_grace(self, seconds: float) -> bool:
        """Whether a viewer was disconnected less than so many `seconds` ago: the server may not have resumed yet."""
        return time.monotonic() - self._disconnected < seconds

    def disconnect_last(self) -> str:
        """Disconnect the viewer furthest behind. Returns its address, or "" if none holds up the server."""
        behind = self.look()
        last = max(behind, key=lambda peer: behind[peer], default=None)
        if last is None or behind[last] < BEHIND:
            return ""
        for peer, connection in self._connections():
            if peer == last:
                connection.shutdown(socket.SHUT_RDWR)
        self._disconnected = time.monotonic()
        return f"{last[0]}:{last[1]}"

    def _connections(self) -> Iterator[tuple[tuple[str, int], socket.socket]]:
        """For each peer connected to the port, its address and this side's socket, open until the next one."""
        for name in os.listdir("/proc/self/fd"):
            try:
                if not stat.S_ISSOCK(os.fstat(int(name)).st_mode):
                    continue
                with socket.socket(fileno=os.dup(int(name))) as connection:
                    if connection.family == socket.AF_INET and connection.getsockname()[1] == self._port:
                        yield connection.getpeername(), connection
            except OSError:  # just closed, or only listening
                continue
