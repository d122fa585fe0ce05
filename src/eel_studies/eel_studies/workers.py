# SPDX-License-Identifier: Apache-2.0
"""Distributes tasks over threads, or with Dask over processes of this machine or of others.

Threads suffice on one machine, as the mechanics run without the GIL. If a process dies, its tasks go to the others.
"""

import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from typing import Any, NamedTuple, TypeVar

from eel_common.wording import shown
from eel_dynamics.runs.storage.tables import needed

PROCESSES = "processes"  # as a scheduler: processes of this machine
Item = TypeVar("Item")
Result = TypeVar("Result")


class Workers(NamedTuple):
    """An executor, and the number of tasks that it runs at a time."""

    pool: Executor
    parallel: int

    def results(
        self, task: Callable[[Item], Result], items: Iterable[Item]
    ) -> Iterator[tuple[Item, Result | None, BaseException | None]]:
        """Run `task(item)` for each of the `items`.

        Yields (item, result, None) in order of completion, or (item, None, error) for a failure. The error is the
        task's, or reports that the item killed several workers. When the caller ends, tasks that have not begun are
        cancelled.
        """
        futures = {self.pool.submit(task, item): item for item in items}
        try:
            for future in as_completed(list(futures)):
                error = future.exception()
                yield futures.pop(future), None if error else future.result(), error
        finally:
            for future in futures:
                future.cancel()


@contextmanager
def workers_of(scheduler: Any, count: int) -> Iterator[Workers]:
    """The workers of a `scheduler`.

    None: `count` threads of this process. Otherwise Dask's: an address ("tcp://host:8786"), a client or a cluster.
    "processes": a cluster of `count` processes on this machine, which ends with the context. `ValueError` if the
    scheduler cannot be reached. `OSError` if processes have no semaphores here: a container without /dev/shm.
    `ImportError` without Dask.
    """
    if scheduler is None:
        with ThreadPoolExecutor(count, thread_name_prefix="sweep") as pool:
            yield Workers(pool, count)
        return
    needed("distributed", "a sweep with a scheduler")
    with _client_of(scheduler, count) as client:
        yield Workers(client.get_executor(pure=False), sum(client.nthreads().values()))


@contextmanager
def _client_of(scheduler: Any, workers: int) -> Iterator[Any]:
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
    except (OSError, TimeoutError, TypeError, ValueError) as error:
        raise ValueError(f"scheduler cannot be reached at {shown(scheduler)}: {error}") from None
    with client:
        yield client


def _check_semaphores() -> None:
    try:
        multiprocessing.Lock()
    except OSError as error:
        raise OSError(
            f"the processes of a sweep need semaphores in /dev/shm ({error}); mount it, or name a scheduler"
        ) from None
