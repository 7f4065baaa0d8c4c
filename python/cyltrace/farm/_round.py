"""A round: a task for each of some parts, until all have ended or the connection is lost."""

from __future__ import annotations

import queue
import time
import uuid
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import CancelledError
from contextlib import suppress
from dataclasses import dataclass, field

from dask.typing import Key
from distributed import Client, Future, KilledWorker

from ._bundle import Bundle
from ._cluster import Shipped, await_workers, threads
from ._display import Display
from ._error import ConnectionLost, FarmError
from ._folder import Folder
from ._part import Answer, Job, make_part

#: How often the program of a part may die.
MOST_DEATHS = 3

#: How often Dask may give up a part that several workers died with. Workers also die when their
#: machines are taken away, so this is generous.
MOST_ABANDONED = 5

#: How often a round looks after its connection, in seconds.
PAUSE = 1.0

#: How long the result of a part may take from its worker to here, in seconds.
TRANSFER = 600.0

#: How long a shared file system may take to show a new file, in seconds.
DELAY = 30.0


@dataclass
class Run:
    """What all rounds have in common."""

    job: Job
    folder: Folder
    #: The files that workers need; None if they share the folder.
    bundle: Bundle | None
    patience: float
    display: Display
    #: The parts that are there.
    done: set[int] = field(default_factory=set)
    #: How often the program of each part died, and how often Dask gave it up.
    deaths: Counter[int] = field(default_factory=Counter)
    abandoned: Counter[int] = field(default_factory=Counter)
    #: Whether the next part is compared with those of an earlier run.
    compares: bool = False
    #: Whether a part of this run was seen in the folder.
    was_seen: bool = False


class Round:
    """The tasks of a connection."""

    def __init__(self, run: Run, client: Client) -> None:
        self._run = run
        self._client = client
        self._code = Shipped(make_part)
        self._contents: Future[dict[str, bytes]] | None = None
        #: Tasks that have not ended, with the number of their part, by their key.
        self._tasks: dict[Key, tuple[int, Future[Answer]]] = {}
        self._ended: queue.SimpleQueue[Future[Answer]] = queue.SimpleQueue()
        self._last_worker = time.monotonic()

    def make(self, numbers: Iterable[int]) -> None:
        """Makes the parts with these numbers.

        Raises
        ------
        ConnectionLost
            If another round is needed.
        FarmError
            If a part cannot be made.
        """
        await_workers(self._client, self._run.patience, self._run.display.note)
        try:
            self._send_files()
            self._submit(list(numbers))
            while self._tasks:
                try:
                    ended = self._ended.get(timeout=PAUSE)
                except queue.Empty:
                    self._look_after()
                else:
                    number, future = self._tasks.pop(ended.key)
                    self._handle(number, future)
        finally:
            # Ends the programs of tasks that run. A lost connection has ended them already.
            with suppress(Exception):
                self._client.cancel([future for _, future in self._tasks.values()], force=True)

    def _send_files(self) -> None:
        bundle = self._run.bundle
        if bundle is not None:
            # One object, so that Dask sees many equal tasks and spreads them evenly.
            key = f"cyltrace-files-{bundle.key}"
            try:
                self._contents = self._client.scatter({key: bundle.contents})[key]
            except (OSError, TimeoutError) as error:
                raise ConnectionLost(f"the scene's files did not arrive ({error})") from error

    def _submit(self, numbers: list[int]) -> None:
        keys = [f"cyltrace-part-{number}-{uuid.uuid4().hex}" for number in numbers]
        job, contents = self._run.job, self._contents
        try:
            futures = self._client.map(
                self._code, numbers, key=keys, pure=False, job=job, contents=contents
            )
        except Exception as error:
            if self._client.status == "running":
                raise
            raise ConnectionLost("the scheduler was lost") from error
        for number, future in zip(numbers, futures, strict=True):
            self._tasks[future.key] = number, future
            future.add_done_callback(self._ended.put)

    def _look_after(self) -> None:
        """Looks whether tasks can still end."""
        run = self._run
        run.display.refresh()
        if threads(self._client):
            self._last_worker = time.monotonic()
        elif time.monotonic() - self._last_worker > run.patience:
            raise FarmError(f"the scheduler has had no worker for {run.patience:g} s")

    def _handle(self, number: int, future: Future[Answer]) -> None:
        """Handles a task that has ended."""
        run, name = self._run, f"part {number}/{self._run.job['of']}"
        try:
            answer, detail = self._answer(future)
        except KilledWorker as killed:
            run.abandoned[number] += 1
            if run.abandoned[number] == MOST_ABANDONED:
                raise FarmError(
                    f"{name}: too many workers died with it, the last {killed}"
                ) from killed
            run.display.note(f"{name}: workers died with it; it is made again")
            self._submit([number])
            return
        if answer == "refused":
            raise FarmError(f"{name} {detail}")
        if answer == "died":
            run.deaths[number] += 1
            if run.deaths[number] == MOST_DEATHS:
                raise FarmError(f"{name}: the program died {MOST_DEATHS} times, the last {detail}")
            run.display.note(f"{name}: the program died {detail}; it is made again")
            self._submit([number])
            return
        self._keep(number, detail)

    def _answer(self, future: Future[Answer]) -> Answer:
        try:
            return future.result(timeout=TRANSFER)
        except CancelledError as error:
            # Dask cancels tasks when a worker dies that alone has the files of the scene.
            lost = "the scheduler" + (", or a worker's files," if self._run.bundle else "")
            raise ConnectionLost(f"{lost} was lost") from error
        except KilledWorker:
            raise
        except (OSError, TimeoutError) as error:
            raise ConnectionLost(f"a part did not arrive ({error})") from error
        except Exception as error:
            raise FarmError(f"a task failed with {type(error).__name__}: {error}") from error

    def _keep(self, number: int, content: bytes | None) -> None:
        """Keeps a part that was made."""
        run, of = self._run, self._run.job["of"]
        if content is not None:
            run.folder.write(number, of, content)
        if not run.was_seen:
            self._see(number)
        if run.compares:
            self._compare(number)
        run.done.add(number)
        run.display.set(len(run.done))

    def _see(self, number: int) -> None:
        """Looks for the first part of this run in the folder, which may be shared in name only."""
        run = self._run
        end = time.monotonic() + DELAY
        while not run.folder.has(number, run.job["of"]):
            if time.monotonic() > end:
                raise FarmError(
                    f"a worker wrote part {number} to {str(run.folder.path)!r} on its machine, and "
                    "the folder here does not have it: use --no-shared"
                )
            time.sleep(PAUSE)
        run.was_seen = True

    def _compare(self, number: int) -> None:
        """Compares a part of this run with those of an earlier one, and removes it if it does
        not belong to them."""
        run = self._run
        try:
            run.folder.present()
        except FarmError:
            run.folder.remove_part(number, run.job["of"])
            raise
        run.compares = False
