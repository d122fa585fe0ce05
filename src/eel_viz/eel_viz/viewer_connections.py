# SPDX-License-Identifier: Apache-2.0
"""The viewers that are connected to the server in this process, and which of them is the furthest behind.

Rerun's server keeps 1024 messages for its slowest viewer. Then it waits for that one, and takes nothing in: the others
get nothing, and new viewers no answer. It neither leaves a slow viewer out nor says which one it is. But the server's
sockets are this process's own, and Linux counts what has passed through each: a viewer that takes less than comes in
falls behind.
"""

import math
import os
import socket
import stat
import struct
import time
from collections.abc import Iterator

COUNTERS = struct.Struct("120xQQ")  # linux/tcp.h, tcp_info: bytes acknowledged by the peer, bytes received from it
IDLE = 30_000  # bytes: a connection that was given less shows nothing
BEHIND = 500_000  # bytes: the server waits only for a viewer that is further behind


class ViewerConnections:
    """The connections to the server on `port`. Call `look` regularly."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._counted: dict[tuple[str, int], int] = {}  # peer: bytes received from it at the last look
        self._received = 0  # bytes from all peers, also from those that have gone
        self._least: dict[tuple[str, int], int] = {}  # viewer: the least bytes received, less those given to it
        self._disconnected = -math.inf  # s, steady clock: when a viewer was disconnected last

    def look(self) -> dict[tuple[str, int], int]:
        """By how many bytes each viewer is further behind than it ever was, by its address."""
        given_to, counted = {}, {}
        for peer, connection in self._connections():
            given, received = COUNTERS.unpack_from(connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, 256))
            self._received += received - self._counted.get(peer, 0)
            counted[peer] = received
            if given > max(received, IDLE):  # else it is a sink
                given_to[peer] = given
        self._counted = counted
        waiting = {peer: self._received - given for peer, given in given_to.items()}
        self._least = {peer: min(count, self._least.get(peer, count)) for peer, count in waiting.items()}
        return {peer: count - self._least[peer] for peer, count in waiting.items()}

    def in_grace(self, seconds: float) -> bool:
        """Whether a viewer was disconnected less than so many `seconds` ago: the server may not have gone on yet."""
        return time.monotonic() - self._disconnected < seconds

    def disconnect_last(self) -> str:
        """Disconnect the viewer that is furthest behind; its address, or "" if none holds up the server."""
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
        """The address of each peer that is connected to the port, and this side's socket, open until the next one."""
        for name in os.listdir("/proc/self/fd"):
            try:
                if not stat.S_ISSOCK(os.fstat(int(name)).st_mode):
                    continue
                with socket.socket(fileno=os.dup(int(name))) as connection:
                    if connection.family == socket.AF_INET and connection.getsockname()[1] == self._port:
                        yield connection.getpeername(), connection
            except OSError:  # it has just been closed, or only listens
                continue
