# SPDX-License-Identifier: Apache-2.0
"""Distributes tasks over threads, or with Dask over processes of this machine or of others.

Threads are enough on one machine: the mechanics run without the GIL. The tasks of a process that dies are reassigned to
the others.
"""

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures import as_completed as completed
from contextlib import contextmanager

from eel_base.wording import shown
from eel_dynamics.runs.storage.tables import needed

PROCESSES = "processes"  # as a scheduler: of this machine


class Threads:
    """So many threads of this process."""

    def __init__(self, count: int):
        self.count = count

    def spread(self, task: Callable, chunks: list, *settings) -> Iterator[tuple]:
        """As `Cluster.spread`. What has not begun when the caller ends is not begun any more."""
        with ThreadPoolExecutor(self.count, thread_name_prefix="sweep") as pool:
            futures = {pool.submit(task, chunk, *settings): chunk for chunk in chunks}
            try:
                for future in completed(futures):
                    error = future.exception()
                    yield futures[future], None if error else future.result(), error
            finally:
                pool.shutdown(wait=False, cancel_futures=True)


class Cluster:
    """The workers of a Dask `client`."""

    def __init__(self, client):
        self._client = client

    @property
    def count(self) -> int:
        """Their number of threads."""
        return sum(self._client.nthreads().values())

    def spread(self, task: Callable, chunks: list, *settings) -> Iterator[tuple]:
        """Run `task(chunk, *settings)` for every chunk.

        Yields (chunk, result, None) in order of completion, or (chunk, None, error) for a failed chunk. The error is
        that of the task, or reports that the chunk killed several workers.
        """
        from distributed import as_completed

        futures = {self._client.submit(task, chunk, *settings, pure=False): chunk for chunk in chunks}
        try:
            for future in as_completed(list(futures)):
                error = future.exception()
                yield futures[future], None if error else future.result(), error
                future.release()
        finally:
            self._client.cancel(list(futures))


@contextmanager
def workers_of(scheduler, count: int) -> Iterator[Threads | Cluster]:
    """The workers that a `scheduler` gives: None for `count` threads of this process, else a Dask cluster."""
    if scheduler is None:
        yield Threads(count)
        return
    needed("distributed", "a sweep with a scheduler", "eel_studies[cluster]")
    with connected(scheduler, count) as client:
        yield Cluster(client)


@contextmanager
def connected(scheduler, workers: int):
    """A Dask client of the `scheduler`: an address ("tcp://host:8786"), a client or a cluster.

    "processes": a cluster of so many `workers` of this machine, which ends with the context. `ValueError` where the
    scheduler cannot be reached. `OSError` where processes of this machine have no semaphores: a container without
    /dev/shm.
    """
    from distributed import Client, LocalCluster

    if isinstance(scheduler, Client):
        yield scheduler
        return
    if isinstance(scheduler, str) and scheduler == PROCESSES:
        _check_semaphores()
        with (
            LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster,
            Client(cluster) as client,
        ):
            yield client
        return
    try:
        client = Client(scheduler, timeout=10)
    except (OSError, TimeoutError, ValueError) as error:
        raise ValueError(f"scheduler cannot be reached at {shown(scheduler)}: {error}") from None
    with client:
        yield client


def _check_semaphores():
    try:
        multiprocessing.Lock()
    except OSError as error:
        raise OSError(
            f"the processes of a sweep need semaphores in /dev/shm ({error}); mount it, or name a scheduler"
        ) from None
