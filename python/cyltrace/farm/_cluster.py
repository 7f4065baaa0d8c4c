"""Connections to Dask."""

from __future__ import annotations

import logging
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import Any

import cloudpickle
from distributed import Client, LocalCluster

from . import _part
from ._error import ConnectionLost, FarmError

#: How long one attempt to connect may take, in seconds.
ATTEMPT = 5.0

#: The pause between attempts, in seconds.
PAUSE = 1.0


class Shipped:
    """A function of :mod:`._part` that is pickled with its code.

    Dask pickles functions by their names, and workers need not have this package.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        cloudpickle.register_pickle_by_value(_part)
        self._code = cloudpickle.dumps(function)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        return cloudpickle.loads(self._code)(*arguments, **named)

    def __reduce__(self) -> tuple[Callable[[bytes], Any], tuple[bytes]]:
        return cloudpickle.loads, (self._code,)


def hush() -> None:
    """Silences Dask's reports of lost connections and workers, which the rounds handle."""
    for name in ("distributed", "tornado", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)


@contextmanager
def local_cluster(workers: int) -> Iterator[str]:
    """Starts workers on this machine, one part each at a time. Gives the scheduler's address."""
    # Ctrl-C in a terminal reaches all processes. Those that this thread and its threads start
    # from here on have the signal blocked. The tracker, once it is started, would unblock it.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        cluster = LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address=None,
            # The memory of the program is not that of its worker.
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    with cluster:
        yield str(cluster.scheduler_address)


@contextmanager
def connected(address: str, patience: float, note: Callable[[str], None]) -> Iterator[Client]:
    """A connection to a scheduler, which may be starting.

    Raises
    ------
    FarmError
        If it cannot be reached in time.
    """
    end = time.monotonic() + patience
    waits = False
    while (client := _attempt(address)) is None:
        if time.monotonic() >= end:
            raise FarmError(
                f"there is no scheduler at {address} after {patience:g} s: start it by `dask "
                "scheduler`, or wait longer by --patience SECONDS"
            )
        if not waits:
            note(f"waiting for the scheduler at {address}")
            waits = True
        time.sleep(PAUSE)
    try:
        yield client
    finally:
        # A scheduler that is gone cannot be taken leave of.
        client.close(timeout=ATTEMPT)


def _attempt(address: str) -> Client | None:
    try:
        return Client(address, timeout=ATTEMPT, set_as_default=False)
    except (OSError, TimeoutError):
        return None
    except ValueError as error:
        raise FarmError(f"--scheduler {address}: {error}") from error


def threads(client: Client) -> int:
    """How many parts the workers make at a time, 0 if there is no worker."""
    if client.status != "running":
        raise ConnectionLost("the connection to the scheduler is lost")
    try:
        return sum(client.nthreads().values())
    except (OSError, TimeoutError) as error:
        raise ConnectionLost("the scheduler does not answer") from error


def await_workers(client: Client, patience: float, note: Callable[[str], None]) -> int:
    """Waits for the first worker. Returns how many parts the workers make at a time.

    Raises
    ------
    FarmError
        If there is none in time.
    """
    end = time.monotonic() + patience
    waits = False
    while (count := threads(client)) == 0:
        if time.monotonic() >= end:
            raise FarmError(
                f"the scheduler has no worker after {patience:g} s: start some by `dask worker "
                "ADDRESS --nthreads 1`, or wait longer by --patience SECONDS"
            )
        if not waits:
            note("waiting for a worker")
            waits = True
        time.sleep(PAUSE)
    return count
