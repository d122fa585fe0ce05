"""Distributes tasks over processes, on this machine or on others, with Dask.

The tasks of a worker that dies are reassigned to the others.
"""

import multiprocessing
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from eel_gaits.wording import shown

EXTRA = "dask", "distributed", "xarray"


def needed() -> dict:
    """Import the modules that a sweep needs; returns them by name. `ImportError` names the command to install them."""
    from importlib import import_module

    try:
        return {name: import_module(name) for name in EXTRA}
    except ImportError as error:
        raise ImportError(
            f"a sweep needs {', '.join(EXTRA)} ({error}); install them with: pip install 'eel_dynamics[cluster]'"
        ) from None


@contextmanager
def connected(scheduler=None, workers: int | None = None):
    """A Dask client of the `scheduler`: an address ("tcp://host:8786"), a client or a cluster.

    scheduler None: a cluster of `workers` processes on this machine (None: one per core), which ends with the context.
    `ValueError` where the scheduler cannot be reached. `OSError` where processes of this machine have no semaphores: a
    container without /dev/shm.
    """
    from distributed import Client, LocalCluster

    if isinstance(scheduler, Client):
        yield scheduler
        return
    if scheduler is None:
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


def spread(client, task: Callable, chunks: list, *settings) -> Iterator[tuple]:
    """Run `task(chunk, *settings)` for every chunk on the workers of `client`.

    Yields (chunk, result, None) in order of completion, or (chunk, None, error) for a failed chunk. The
    error is that of the task, or reports that the chunk killed several workers.
    """
    from distributed import as_completed

    futures = {client.submit(task, chunk, *settings, pure=False): chunk for chunk in chunks}
    try:
        for future in as_completed(list(futures)):
            error = future.exception()
            yield futures[future], None if error else future.result(), error
            future.release()
    finally:
        client.cancel(list(futures))
